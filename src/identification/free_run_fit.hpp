// Consequents that are good in free run: least squares of one-step errors is biased by noise and by
// what the regressors do not see; this fit starts there and minimises what a simulation gets wrong.
#pragma once

#include <functional>

#include "identification/data_set.hpp"
#include "identification/prior_knowledge.hpp"
#include "identification/structure.hpp"

namespace fpc {

struct FreeRunFit {
  double before{}, after{};  ///< rms error of the free run of this output alone, in its unit
  int iterations{};
  bool cancelled{false};
};

/// Minimises sum (free-run error / s_f)^2 + one_step_weight sum (one-step error / s_o)^2 over the
/// coefficients of all rules, antecedents fixed, by Levenberg-Marquardt steps; s_f and s_o are what
/// `linear` reaches. In the free run the other outputs are measured. Starts from `model`, or from
/// the linear model where that runs better; the objective never rises, so that a fit that cannot
/// improve leaves the start. Uses params.free_run_iterations and .one_step_weight. Sensitivities
/// follow the recursion of the model, antecedents included. `model` must agree with what is known;
/// so does every step. `proceed` may be empty; false cancels.
/// Source: ljung1999, sec. 10.2-10.3 (output-error models).
FreeRunFit fitFreeRun(const DataSet& data, int output, const OutputModel& linear,
                      const ConsequentParams& params, OutputModel& model,
                      const std::function<bool()>& proceed = {}, const PriorKnowledge& known = {});

}  // namespace fpc
