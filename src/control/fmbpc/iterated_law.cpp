#include <algorithm>

#include "control/fmbpc/input_law.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/model/domain.hpp"
#include "model/process_trust.hpp"
#include "model/undelayed.hpp"

namespace fpc {
namespace {

IlqrParams solverParams(const FmbpcParams& params) {
  return {params.horizon_steps, params.iterations,   params.weight_output,
          params.weight_move,   params.weight_input, params.input_target};
}

}  // namespace

IteratedLaw::IteratedLaw(const InternalModel& model, const FmbpcParams& params,
                         const InputLimits& limits, DisturbanceForecast& forecast)
    : solver_(model.local(), solverParams(params), limits),
      forecast_(forecast),
      lead_(params.reference_lead_steps),
      dead_time_(longestDeadTime(model.local().model())),
      aimed_(Matrix::Zero(model.outputs().size(), params.horizon_steps)),
      point_(Vector::Zero(model.outputs().size() + limits.lower.size() +
                          countOf(model.local().model().disturbances))) {}

void IteratedLaw::follow(InternalModel& model, VectorRef input, VectorRef past_disturbances) {
  model.blendAt(input, past_disturbances);
}

/// Samples ahead whose errors count: where the last plan leads under what is expected now.
Eigen::Index IteratedLaw::trustedSteps(const InternalModel& model, const Matrix& expected) {
  const Eigen::Index N = solver_.inputs().cols(), n_y = aimed_.rows(), n_d = expected.rows();
  const TsModel& known = model.local().model();
  if (trust_heeded_ == 0.0 || !solver_.warm() || !knowsDomain(known)) return N;
  for (Eigen::Index i = 1; i <= N; ++i) {
    for (Eigen::Index o = 0; o < n_y; ++o)
      point_[o] = solver_.states()(model.local().outputState(o), std::min(i + 1, N)) +
                  model.offsetOutput()[o];
    point_.tail(n_d) = expected.col(std::min(i, N - 1));
    if (processTrustOf(known, point_) < trust_heeded_)
      return std::clamp(i - 1, std::min(dead_time_ + trust_least_, N), N);
  }
  return N;
}

Proposal IteratedLaw::propose(InternalModel& model, const LawSample& sample, const Matrix& future,
                              Vector& input) {
  aimed_ = future.middleCols(lead_, aimed_.cols());
  const Vector& rest = sample.setpoint.aimedInput();
  if (rest.size() > 0) solver_.aimInputs(rest);
  const Matrix& expected = forecast_.predict();
  solver_.countErrors(trustedSteps(model, expected));
  if (!solver_.plan(model.state(), model.correction(), model.offsetOutput(), expected, aimed_,
                    sample.now.input_applied))
    return {EventCode::kLawFailed};
  input = solver_.inputs().col(0);
  model.replan(input, sample.disturbances);
  return {};
}

/// The plan is handed over as it is: K = 0.
void IteratedLaw::predict(const InternalModel& model, const Matrix& /*future*/,
                          PredictiveAction& prediction) const {
  const Matrix& plan = solver_.inputs();
  prediction.K.setZero(plan.rows(), model.state().size());
  for (Eigen::Index i = 0; i < prediction.feedforward.cols(); ++i)
    prediction.feedforward.col(i) = plan.col(std::min(i, plan.cols() - 1));
}

void IteratedLaw::planned(const InternalModel& model, Eigen::Index i,
                          Eigen::Ref<Vector> point) const {
  const Eigen::Index n_y = model.outputs().size(), n_u = solver_.inputs().rows();
  for (Eigen::Index o = 0; o < n_y; ++o)
    point[o] = solver_.states()(model.local().outputState(o), i) + model.offsetOutput()[o];
  point.segment(n_y, n_u) = solver_.inputs().col(i);
  point.tail(point.size() - n_y - n_u) = solver_.disturbances().col(i);
}

void IteratedLaw::retune(const FmbpcParams& params) {
  lead_ = params.reference_lead_steps;
  solver_.retune(params.iterations, params.weight_output, params.weight_move, params.weight_input,
                 params.input_target);
}

}  // namespace fpc
