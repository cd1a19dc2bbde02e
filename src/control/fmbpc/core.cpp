#include "control/fmbpc/core.hpp"

#include <utility>

namespace fpc {
namespace {

constexpr Eigen::Index kGap = 32;  // columns of the reference that are worth leaving out

}  // namespace

FmbpcCore::FmbpcCore(const TsModel& model, const FmbpcParams& params, const InputLimits& limits,
                     DisturbanceForecast& forecast)
    : params_(params),
      model_(makeInternalModel(model, params)),
      law_(makeInputLaw(*model_, params, limits, forecast)),
      future_(Matrix::Zero(model_->outputs().size(), params.referenceSteps())) {}

void FmbpcCore::rest(const LawSample& sample) {
  model_->rest(sample.now, sample.disturbances);
  law_->rest();
}

void FmbpcCore::advance(const LawSample& sample) {
  law_->follow(*model_, sample.now.input_applied, sample.past_disturbances);
  model_->advance(sample.now, sample.past_disturbances);  // matrices still of sample k-1
}

void FmbpcCore::foresee(VectorRef input, VectorRef past_disturbances, Eigen::Ref<Vector> outputs) {
  law_->follow(*model_, input, past_disturbances);
  model_->foresee(input, past_disturbances, outputs);
}

bool FmbpcCore::inherit(const LawCore& older) {
  return model_->inherit(*static_cast<const FmbpcCore&>(older).model_);
}

bool FmbpcCore::look(const LawSample& sample) {
  const bool fired = model_->blend(sample.disturbances);
  model_->compare(sample.now);
  return fired;
}

/// Of the columns that nobody reads, those between the prediction and the sample aimed at, none.
void FmbpcCore::drawReference(const LawSample& sample) {
  const std::uint32_t step = sample.now.header.step;
  const Eigen::Index near = params_.reference_lead_steps + params_.prediction_steps;
  const Eigen::Index aimed = params_.aimedColumn();
  if (params_.law == FmbpcForm::kIterated || aimed <= near + kGap) {
    sample.reference.predict(sample.setpoint, step, future_);
    return;
  }
  sample.reference.predict(sample.setpoint, step, future_.leftCols(near));
  sample.reference.predict(sample.setpoint, step, future_, aimed);
}

Proposal FmbpcCore::propose(const LawSample& sample, Vector& input) {
  drawReference(sample);
  return law_->propose(*model_, sample, future_, input);
}

void FmbpcCore::prepareTuning(const FmbpcParams& params) {
  next_params_ = params;
  next_future_ = Matrix::Zero(model_->outputs().size(), params.referenceSteps());
}

void FmbpcCore::adoptTuning() {
  std::swap(params_, next_params_);
  future_.swap(next_future_);
  law_->retune(params_);
}

void FmbpcCore::predict(PredictiveAction& prediction) const {
  prediction.state = model_->state();
  prediction.A = model_->affine().A;
  prediction.B = model_->affine().B;
  prediction.C = model_->affine().C;
  prediction.offset_state = model_->offsetState();
  prediction.offset_output = model_->offsetOutput();
  prediction.feedforward.resize(prediction.B.cols(), params_.prediction_steps);
  law_->predict(*model_, future_, prediction);
  prediction.reference = future_.middleCols(params_.reference_lead_steps, params_.prediction_steps);
}

double FmbpcCore::signal(Eigen::Index output, std::size_t which) const {
  if (which == 0) return model_->outputs()[output];
  if (which == 1) return model_->correctionOf(output);
  return model_->undelayed()[output] + model_->offsetOutput()[output];
}

}  // namespace fpc
