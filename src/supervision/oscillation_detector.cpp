#include "supervision/oscillation_detector.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace fpc {

bool OscillationDetector::add(double wish) {
  constexpr int kTurns = 3;
  if (!std::isfinite(wish)) return found_;
  const int direction = std::abs(wish) <= large_ ? 0 : wish > 0.0 ? 1 : -1;
  turned_[at_] = direction * last_ < 0 && since_ < kWindow ? 1 : 0;
  at_ = (at_ + 1) % kWindow;
  since_ = std::min(since_ + 1, kWindow);
  if (direction != 0) {
    last_ = direction;
    since_ = 0;
  }
  found_ = found_ || std::accumulate(std::begin(turned_), std::end(turned_), 0) >= kTurns;
  return found_;
}

}  // namespace fpc
