#include "supervision/oscillation_detector.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace fpc {
namespace {

constexpr double kFirstSwing = 0.125;  // of the range
constexpr double kLeastSwing = 0.02;
constexpr double kAllOfIt = 0.999;  // of the move that is allowed
constexpr int kTurns = 3;
constexpr double kOpening = 1.5;  // in `release` samples; in one while wishes go one way

}  // namespace

OscillationDetector::OscillationDetector(double large, int release)
    : large_(large), opening_(std::pow(kOpening, 1.0 / std::max(1, release))) {}

void OscillationDetector::reset() {
  allowed_ = 1.0;
  last_ = at_ = one_way_ = 0;
  since_ = kWindow;
  std::fill(std::begin(turned_), std::end(turned_), 0);
}

double OscillationDetector::allow(double wish) {
  if (large_ <= 0.0 || !std::isfinite(wish)) return 1.0;
  const double large = swings() ? std::min(large_, kAllOfIt * allowed_) : large_;
  const int direction = std::abs(wish) <= large ? 0 : wish > 0.0 ? 1 : -1;
  turned_[at_] = direction * last_ < 0 && since_ < kWindow ? 1 : 0;
  const bool turned = turned_[at_] == 1;
  one_way_ = direction == 0 || direction * last_ < 0 ? 0 : one_way_ + 1;
  at_ = (at_ + 1) % kWindow;
  since_ = std::min(since_ + 1, kWindow);
  if (direction != 0) {
    last_ = direction;
    since_ = 0;
  }
  const int turns = std::accumulate(std::begin(turned_), std::end(turned_), 0);
  if (turned && turns >= kTurns)
    allowed_ = std::max(kLeastSwing, std::min(kFirstSwing, 0.5 * allowed_));
  else
    allowed_ = std::min(1.0, (one_way_ > kWindow ? kOpening : opening_) * allowed_);
  return allowed_;
}

}  // namespace fpc
