// Where the next move of each input starts from when the plant does not show what it was told.
#pragma once

#include <vector>

#include "fmbpc/base/input_limits.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

/// An input that is where it was told moves on from there. One that is not:
/// - moves along with its command (an offset): its move limit counts from the last command, since
///   from what is read every command would take the offset up anew;
/// - stands still, or lags (stuck, an action that was lost): its move limit counts from what is
///   read, so that nothing winds up against it, and from the last command.
/// Where it has just left its command and moved, it is taken for the first; which of them it is
/// shows as soon as the command moves. Inputs without a move limit move on from what is read.
class MoveOrigin {
 public:
  explicit MoveOrigin(const InputLimits& limits);
  /// Nothing of ours is in force: the next sample moves on from what is read.
  void restart();
  /// u(k-1) as it is read, finite. No allocation.
  void look(VectorRef applied);
  /// From where the input of sample k moves on: what was read, or the last command.
  const Vector& origin() const { return origin_; }
  /// The same for what is not a law's: what is read, unless the input has been seen to move along
  /// with its command.
  const Vector& proven() const { return proven_; }
  /// Some input is further from its last command than 1e-9 of its range.
  bool displaced() const { return displaced_; }
  /// Puts what goes out within the move limit of the last command where an input is displaced.
  /// True if that changed it.
  bool keepNear(Eigen::Ref<Vector> input) const;
  /// u(k), which goes out.
  void sent(VectorRef command);

 private:
  void judge(Eigen::Index i, double applied);
  double tolerance(Eigen::Index i) const;

  InputLimits limits_;
  Vector origin_, proven_, applied_, command_, command_before_;
  std::vector<bool> away_, along_;  // at the last sample: not where it was told; moves along
  std::vector<bool> seen_;          // a command that moved has shown which
  bool active_{false}, displaced_{false};
};

}  // namespace fpc
