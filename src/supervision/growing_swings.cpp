#include "supervision/growing_swings.hpp"

#include <algorithm>
#include <cmath>

namespace fpc {

GrowingSwings::GrowingSwings(int half_swings, Eigen::Index n_y)
    : turns_(half_swings > 0 ? static_cast<std::size_t>(half_swings) + 1 : 0,
             Turn{0, 0.0, Vector::Zero(n_y)}) {}

void GrowingSwings::reset() {
  known_ = 0;
  way_ = 0;
  step_ = 0;
}

/// The farthest value was a turn.
void GrowingSwings::turn(VectorRef outputs) {
  std::rotate(turns_.begin(), turns_.begin() + 1, turns_.end());
  turns_.back().step = farthest_step_;
  turns_.back().value = farthest_;
  turns_.back().outputs = outputs;
  known_ = std::min(known_ + 1, turns_.size());
}

bool GrowingSwings::grow() const {
  if (known_ < turns_.size()) return false;
  const auto way = [&](std::size_t i) { return std::abs(turns_[i].value - turns_[i - 1].value); };
  const auto period = [&](std::size_t i) { return turns_[i].step - turns_[i - 2].step; };
  std::int64_t shortest = period(2), longest = shortest;
  for (std::size_t i = 2; i < turns_.size(); ++i) {
    if (!(way(i) > way(i - 1))) return false;
    shortest = std::min(shortest, period(i));
    longest = std::max(longest, period(i));
  }
  return static_cast<double>(longest) <= kRegular * static_cast<double>(shortest);
}

bool GrowingSwings::add(double value, VectorRef outputs) {
  if (turns_.empty() || !std::isfinite(value)) return false;
  const std::int64_t now = step_++;
  const double on = way_ == 0 ? std::abs(value - farthest_) : (value - farthest_) * way_;
  if (now == 0 || way_ == 0) {
    if (now > 0 && on > 0.0) {
      way_ = value > farthest_ ? 1 : -1;
      turn(outputs);
    }
    farthest_ = value;
    farthest_step_ = now;
    return false;
  }
  if (on > 0.0) {
    farthest_ = value;
    farthest_step_ = now;
  }
  if (-on <= kTurns * std::abs(farthest_ - turns_.back().value)) return false;
  turn(outputs);
  way_ = -way_;
  farthest_ = value;
  farthest_step_ = now;
  return grow();
}

void GrowingSwings::middle(double& input, Vector& outputs) const {
  const Turn &last = turns_.back(), &before = turns_[turns_.size() - 2];
  input = 0.5 * (last.value + before.value);
  outputs = 0.5 * (last.outputs + before.outputs);
}

}  // namespace fpc
