// Random choices of a test, the same on every machine for the same seed.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seededEngine(seed, {20261121})) {}

  double between(double lower, double upper) { return lower + (upper - lower) * uniform(engine_); }
  /// Each decade as likely as the next.
  double scale(double lower, double upper) {
    return std::exp(between(std::log(lower), std::log(upper)));
  }
  int whole(int lower, int upper) {
    return lower + static_cast<int>(uniform(engine_) * (upper - lower + 1));
  }
  bool chance(double share) { return uniform(engine_) < share; }
  template <typename Item>
  const Item& pick(const std::vector<Item>& items) {
    return items[static_cast<std::size_t>(whole(0, static_cast<int>(items.size()) - 1))];
  }
  /// As a person writes it: a few digits.
  std::string number(double lower, double upper) { return rounded(between(lower, upper)); }
  static std::string rounded(double value) {
    if (value == 0.0) return "0";
    const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 3.0);
    return exactText(std::stod(shortText(std::round(value / unit) * unit)));
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace fpc
