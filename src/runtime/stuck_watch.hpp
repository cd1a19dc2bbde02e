// An input that does not follow its command.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/input_limits.hpp"
#include "supervision/plausibility_params.hpp"

namespace fpc {

/// An input is stuck when for `samples` samples in a row it is further from its command than
/// `tolerance` of its range and not where the actuator's limits would have brought it, or nobody
/// can say where it is (NaN). What is read never leads a command: an input may be held, at what it
/// was told while it is away, and once it is stuck at the last command that it followed.
class StuckWatch {
 public:
  StuckWatch(const StuckParams& params, const InputLimits& limits,
             const std::vector<SignalInfo>& inputs);
  void reset();
  /// u(k) as it was commanded, and where the inputs were before and after it.
  void look(VectorRef commanded, VectorRef before, VectorRef position);
  /// Puts what a law asks of inputs that are away where they are held, at most one move from it.
  void hold(Eigen::Ref<Vector> action, VectorRef told) const;
  bool all() const;  ///< no input is left that follows
  /// "input q_r does not follow its command", empty if all do.
  const std::string& words() const { return words_; }
  const std::string& input() const { return input_; }  ///< of words()

 private:
  StuckParams params_;
  InputLimits limits_;
  std::vector<std::string> names_;
  std::vector<int> away_;  // samples in a row
  Vector expected_, followed_;
  std::string words_, input_;
};

}  // namespace fpc
