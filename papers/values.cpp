#include "papers/values.hpp"

#include <algorithm>
#include <cmath>

#include "base/statistics.hpp"

namespace fpc::papers {

bool Values::sound() const {
  return !all_.empty() &&
         std::all_of(all_.begin(), all_.end(), [](double value) { return std::isfinite(value); });
}

double Values::median() const { return sound() ? fpc::median(all_) : kNotPrinted; }

double Values::lowest() const {
  return sound() ? *std::min_element(all_.begin(), all_.end()) : kNotPrinted;
}

double Values::highest() const {
  return sound() ? *std::max_element(all_.begin(), all_.end()) : kNotPrinted;
}

}  // namespace fpc::papers
