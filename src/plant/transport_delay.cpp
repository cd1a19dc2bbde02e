#include "plant/transport_delay.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

TransportDelay::TransportDelay(double delay_samples) {
  require(delay_samples >= 0.0 && delay_samples <= 1e6, "delay_s",
          "a finite time >= 0 and at most 1e6 samples");
  const double whole = std::floor(delay_samples);
  fraction_ = delay_samples - whole;
  past_.assign(static_cast<std::size_t>(whole) + 2, 0.0);
}

void TransportDelay::reset(double initial) {
  std::fill(past_.begin(), past_.end(), initial);
  next_ = 0;
}

double TransportDelay::pass(double value) {
  past_[next_] = value;
  next_ = (next_ + 1) % past_.size();
  const double older = past_[next_];
  const double newer = past_[(next_ + 1) % past_.size()];
  return fraction_ > 0.0 ? newer + fraction_ * (older - newer) : newer;
}

}  // namespace fpc
