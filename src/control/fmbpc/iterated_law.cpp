#include <algorithm>

#include "control/fmbpc/input_law.hpp"

namespace fpc {
namespace {

IlqrParams solverParams(const FmbpcParams& params) {
  return {params.horizon_steps, params.iterations, params.weight_output, params.weight_move};
}

}  // namespace

IteratedLaw::IteratedLaw(const InternalModel& model, const FmbpcParams& params,
                         const InputLimits& limits, DisturbanceForecast& forecast)
    : solver_(model.local(), solverParams(params), limits),
      forecast_(forecast),
      lead_(params.reference_lead_steps),
      aimed_(Matrix::Zero(model.outputs().size(), params.horizon_steps)) {}

void IteratedLaw::follow(InternalModel& model, const LawSample& sample) {
  model.blendAt(sample.now.input_applied, sample.past_disturbances);
}

Proposal IteratedLaw::propose(InternalModel& model, const LawSample& sample, const Matrix& future,
                              Vector& input) {
  aimed_ = future.middleCols(lead_, aimed_.cols());
  if (!solver_.plan(model.state(), model.correction(), model.offsetOutput(), forecast_.predict(),
                    aimed_, sample.now.input_applied))
    return {"the law gave no finite input"};
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
  solver_.retune(params.iterations, params.weight_output, params.weight_move);
}

}  // namespace fpc
