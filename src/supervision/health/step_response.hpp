// The answer of an output to a step of its input, from a record of the closed loop or from a model.
#pragma once

#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// value[i]: output (i + 1) samples after a step of one unit of the input.
struct StepResponse {
  double sample_time_s{};
  std::vector<double> value;
  std::vector<double> std;  ///< of each; empty: exact

  bool empty() const { return value.empty(); }
  double at(double time_s) const;     ///< linear between samples; NaN beyond the last
  double stdAt(double time_s) const;  ///< likewise, 0 without
};

/// The steepest tangent of a response: where it meets 0, and how long it takes to the last value.
/// NaN where the response is lost in its bounds. Source: ziegler1942
struct ReactionCurve {
  double dead_time_s{kNaN};  ///< with what small lags and an inverse response add to it
  double time_constant_s{kNaN};
};
ReactionCurve reactionCurve(const StepResponse& response);

/// What a record shows of a loop's dynamics.
struct LoopDynamics {
  StepResponse response;
  double delay{kNaN};  ///< samples of the record until the input first acts for certain, >= 1
};

/// One-step least squares of long order, at means of `factor` samples, whose bounds heed feedback:
/// without setpoint changes, moves by hand or a valve that sticks a linear law cannot be told from
/// its process, the bounds are wide, and there is no delay. Source: ljung1999, ch. 13
/// @param u, y  equally long, NaN where unknown; u[k] in force from sample k on
LoopDynamics loopDynamics(const std::vector<double>& u, const std::vector<double>& y,
                          Eigen::Index factor, double sample_time_s);

/// A model beside what the record shows.
struct ModelAge {
  bool judged{};  ///< the record shows enough
  bool outdated{};
  double distance{kNaN};   ///< root mean square of the difference over that of the model's response
  double certainty{kNaN};  ///< root mean square of the difference in standard deviations
  double gain_ratio{kNaN};  ///< record over model at the end of the horizon
};
ModelAge compareModel(const StepResponse& model, const StepResponse& record);

}  // namespace fpc
