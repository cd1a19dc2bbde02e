#include "control/fmbpc/realisations.hpp"

namespace fpc {

ParallelModel::ParallelModel(const TsModel& model, const FmbpcParams& params)
    : InternalModel(model, params) {
  if (params.delay_steps > 0) delayed_.emplace(local_, std::nullopt, params.delay_steps);
}

void ParallelModel::rest(const Measurement& now, VectorRef disturbances) {
  InternalModel::rest(now, disturbances);
  if (delayed_) delayed_->rest(now.outputs, now.input_applied, disturbances);
}

void ParallelModel::advance(const Measurement& now, VectorRef disturbances) {
  predict(now.input_applied);
  state_ = next_;
  readUndelayed(state_);
  local_.shiftState(now.outputs, now.input_applied, disturbances, measured_);
  if (delayed_) delayed_->advance(now.input_applied);
}

void ParallelModel::foresee(VectorRef input, VectorRef /*disturbances*/,
                            Eigen::Ref<Vector> outputs) {
  predict(input);
  if (delayed_)
    delayed_->foresee(outputs);
  else
    outputs.noalias() = affine().C.lazyProduct(next_);
  outputs += offset_output_;
}

bool ParallelModel::blend(VectorRef disturbances) {
  const bool fired = InternalModel::blend(disturbances);
  if (delayed_) delayed_->blend(disturbances, at_measured_ ? &measured_ : nullptr);
  return fired;
}

void ParallelModel::compare(const Measurement& now) {
  outputs_ = undelayed_;
  if (delayed_) delayed_->output(outputs_);
  offset_state_ = affine().g;
  offset_output_ = now.outputs - outputs_;
}

bool ParallelModel::inherit(const InternalModel& older) {
  if (delayed_) return false;
  const Kinship kinship = kinshipTo(older);
  if (kinship == Kinship::kNone) return false;
  const auto& other = static_cast<const ParallelModel&>(older);
  measured_ = other.measured_;
  state_ = kinship == Kinship::kSameRules ? other.state_ : measured_;
  readUndelayed(state_);
  return true;
}

LiteralModel::LiteralModel(const TsModel& model, const FmbpcParams& params)
    : ParallelModel(model, params), canonical_(local_.model()) {
  resize(canonical_.affine().g.size());
  if (params.delay_steps > 0) delayed_.emplace(local_, canonical_, params.delay_steps);
}

void LiteralModel::rest(const Measurement& now, VectorRef disturbances) {
  local_.restState(now.outputs, now.input_applied, disturbances, measured_);
  local_.blend(measured_, disturbances);
  canonical_.blend(local_.firing().front());
  canonical_.restState(now.input_applied[0], state_);
  undelayed_ = now.outputs;
  if (delayed_) delayed_->rest(now.outputs, now.input_applied, disturbances);
}

bool LiteralModel::blend(VectorRef disturbances) {
  const bool fired = ParallelModel::blend(disturbances);
  canonical_.blend(local_.firing().front());
  return fired;
}

void LiteralModel::compare(const Measurement& now) {
  undelayed_.noalias() = affine().C * state_;
  ParallelModel::compare(now);
}

}  // namespace fpc
