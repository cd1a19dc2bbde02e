#include "control/fmbpc/internal_model.hpp"

#include "control/fmbpc/realisations.hpp"
#include "fmbpc/base/signals.hpp"
#include "model/same_rules.hpp"
#include "model/undelayed.hpp"

namespace fpc {

InternalModel::InternalModel(const TsModel& model, const FmbpcParams& params)
    : at_measured_(params.realisation == FmbpcRealisation::kLiteral),
      local_(withoutDelay(model, params.delay_steps)),
      measured_(Vector::Zero(local_.stateSize())),
      offset_output_(Vector::Zero(countOf(model.outputs))),
      undelayed_(offset_output_),
      outputs_(offset_output_) {
  resize(local_.stateSize());
}

void InternalModel::resize(Eigen::Index n_x) {
  state_ = next_ = offset_state_ = correction_ = Vector::Zero(n_x);
}

InternalModel::Kinship InternalModel::kinshipTo(const InternalModel& older) const {
  const TsModel &mine = local_.model(), &other = older.local_.model();
  if (!sameLags(mine, other) || !older.measured_.allFinite()) return Kinship::kNone;
  return older.state_.allFinite() && sameRules(mine, other) ? Kinship::kSameRules
                                                            : Kinship::kSameLags;
}

void InternalModel::predict(VectorRef input) {
  next_ = affine().g;
  next_.noalias() += affine().A * state_;
  next_.noalias() += affine().B * input;
}

void InternalModel::readUndelayed(const Vector& state) {
  for (Eigen::Index i = 0; i < undelayed_.size(); ++i) undelayed_[i] = state[local_.outputState(i)];
}

void InternalModel::rest(const Measurement& now, VectorRef disturbances) {
  local_.restState(now.outputs, now.input_applied, disturbances, measured_);
  state_ = measured_;
  undelayed_ = now.outputs;
}

bool InternalModel::blend(VectorRef disturbances) {
  return local_.blend(antecedents(), disturbances);
}

void InternalModel::blendAt(VectorRef input, VectorRef disturbances) {
  local_.blend(state_, input, disturbances);
}

const Vector& InternalModel::correction() const {
  correction_ = offset_state_ - affine().g;
  return correction_;
}

void InternalModel::replan(VectorRef input, VectorRef disturbances) {
  correction();
  blendAt(input, disturbances);
  offset_state_ = affine().g + correction_;
}

std::unique_ptr<InternalModel> makeInternalModel(const TsModel& model, const FmbpcParams& params) {
  switch (params.realisation) {
    case FmbpcRealisation::kRealigned:
      return std::make_unique<RealignedModel>(model, params);
    case FmbpcRealisation::kLiteral:
      return std::make_unique<LiteralModel>(model, params);
    case FmbpcRealisation::kObserver:
      return std::make_unique<ObservedModel>(model, params);
    case FmbpcRealisation::kParallel:
      break;
  }
  return std::make_unique<ParallelModel>(model, params);
}

}  // namespace fpc
