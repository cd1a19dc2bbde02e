#include "runtime/move_origin.hpp"

#include <algorithm>
#include <cmath>

namespace fpc {

using Eigen::Index;

MoveOrigin::MoveOrigin(const InputLimits& limits)
    : limits_(limits),
      origin_(limits.lower),
      proven_(limits.lower),
      applied_(limits.lower),
      command_(limits.lower),
      command_before_(limits.lower),
      away_(static_cast<std::size_t>(limits.lower.size())),
      along_(away_),
      seen_(away_) {}

void MoveOrigin::restart() {
  active_ = displaced_ = false;
  std::fill(away_.begin(), away_.end(), false);
}

double MoveOrigin::tolerance(Index i) const {
  static constexpr double kRounding = 1e-9;  // of the range
  return kRounding * (limits_.upper[i] - limits_.lower[i]);
}

// Only a command that moved tells an offset from a valve that stands still.
void MoveOrigin::judge(Index i, double applied) {
  const auto k = static_cast<std::size_t>(i);
  const double moved = applied - applied_[i], asked = command_[i] - command_before_[i];
  const bool asked_to_move = std::abs(asked) > tolerance(i);
  seen_[k] = away_[k] && (seen_[k] || asked_to_move);
  if (!away_[k])
    along_[k] = std::abs(moved) > tolerance(i);
  else if (asked_to_move)
    along_[k] = std::abs(moved - asked) < std::abs(moved);
}

void MoveOrigin::look(VectorRef applied) {
  displaced_ = false;
  origin_ = proven_ = applied;
  for (Index i = 0; i < origin_.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const bool away = active_ && std::isfinite(limits_.move[i]) &&
                      std::abs(applied[i] - command_[i]) > tolerance(i);
    if (away) judge(i, applied[i]);
    if (away && along_[k]) origin_[i] = command_[i];
    if (away && along_[k] && seen_[k]) proven_[i] = command_[i];
    away_[k] = away;
    displaced_ = displaced_ || away;
  }
  applied_ = applied;
}

bool MoveOrigin::keepNear(Eigen::Ref<Vector> input) const {
  bool changed = false;
  for (Index i = 0; displaced_ && i < input.size(); ++i) {
    if (!away_[static_cast<std::size_t>(i)]) continue;
    const double asked = input[i], move = limits_.move[i];
    input[i] = std::clamp(asked, command_[i] - move, command_[i] + move);
    changed = changed || input[i] != asked;
  }
  return changed;
}

void MoveOrigin::sent(VectorRef command) {
  if (active_)
    command_before_ = command_;
  else
    command_before_ = command;
  command_ = command;
  active_ = true;
}

}  // namespace fpc
