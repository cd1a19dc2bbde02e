// The realisations whose state follows the measurements.
#include "control/fmbpc/realisations.hpp"

namespace fpc {

RealignedModel::RealignedModel(const TsModel& model, const FmbpcParams& params)
    : InternalModel(model, params), offset_gain_(params.offset_gain), error_filtered_(outputs_) {}

void RealignedModel::rest(const Measurement& now, VectorRef disturbances) {
  InternalModel::rest(now, disturbances);
  error_filtered_.setZero();
}

void RealignedModel::advance(const Measurement& now, VectorRef disturbances) {
  predict(now.input_applied);
  readUndelayed(next_);
  local_.shiftState(now.outputs, now.input_applied, disturbances, measured_);
  error_filtered_ += offset_gain_ * (now.outputs - undelayed_ - error_filtered_);
  state_ = measured_;
}

void RealignedModel::foresee(VectorRef input, VectorRef /*disturbances*/,
                             Eigen::Ref<Vector> outputs) {
  predict(input);
  outputs.noalias() = affine().C.lazyProduct(next_);
  outputs += error_filtered_;
}

void RealignedModel::compare(const Measurement& /*now*/) {
  outputs_ = undelayed_;
  offset_state_ = affine().g;
  for (Eigen::Index i = 0; i < outputs_.size(); ++i)
    offset_state_[local_.outputState(i)] += error_filtered_[i];
}

bool RealignedModel::inherit(const InternalModel& older) {
  const Kinship kinship = kinshipTo(older);
  if (kinship == Kinship::kNone) return false;
  const auto& other = static_cast<const RealignedModel&>(older);
  state_ = measured_ = other.measured_;
  readUndelayed(state_);
  if (kinship == Kinship::kSameRules) error_filtered_ = other.error_filtered_;
  return true;
}

ObservedModel::ObservedModel(const TsModel& model, const FmbpcParams& params)
    : InternalModel(model, params), observer_(local_, params.observer, params.delay_steps) {}

void ObservedModel::rest(const Measurement& now, VectorRef disturbances) {
  InternalModel::rest(now, disturbances);
  observer_.rest(now.outputs, now.input_applied, disturbances, now.header.step > 0);
}

void ObservedModel::advance(const Measurement& now, VectorRef disturbances) {
  observer_.advance(now.outputs, now.input_applied, disturbances);
  local_.shiftState(now.outputs, now.input_applied, disturbances, measured_);
  state_ = observer_.state();
  readUndelayed(state_);
}

void ObservedModel::foresee(VectorRef input, VectorRef disturbances, Eigen::Ref<Vector> outputs) {
  observer_.foresee(input, disturbances, outputs);
}

void ObservedModel::compare(const Measurement& now) {
  outputs_ = now.outputs - observer_.innovation();
  offset_state_ = affine().g;
  observer_.addDisturbance(offset_state_);
}

bool ObservedModel::inherit(const InternalModel& older) {
  if (kinshipTo(older) == Kinship::kNone) return false;
  const auto& other = static_cast<const ObservedModel&>(older);
  measured_ = other.measured_;
  observer_.inherit(other.observer_);
  state_ = observer_.state();
  readUndelayed(state_);
  return true;
}

}  // namespace fpc
