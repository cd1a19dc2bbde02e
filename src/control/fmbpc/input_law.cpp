#include "control/fmbpc/input_law.hpp"
#include "model/model_inputs.hpp"

namespace fpc {

std::unique_ptr<InputLaw> makeInputLaw(const InternalModel& model, const FmbpcParams& params,
                                       const InputLimits& limits, DisturbanceForecast& forecast) {
  switch (params.law) {
    case FmbpcForm::kIterated:
      return std::make_unique<IteratedLaw>(model, params, limits, forecast);
    case FmbpcForm::kGeneral:
      return std::make_unique<GeneralLaw>(model, params, limits.lower.size());
    case FmbpcForm::kPublished:
      break;
  }
  return std::make_unique<PublishedLaw>(model, params, limits.lower.size());
}

CoincidenceLaw::CoincidenceLaw(const InternalModel& model, const FmbpcParams& params,
                               Eigen::Index n_u)
    : gains_(model.state().size(), n_u, model.outputs().size()),
      coincidence_steps_(params.coincidence_steps),
      aim_(params.aimedColumn()),
      shortfall_(model.outputs().size()),
      settled_(model.outputs().size()) {}

void CoincidenceLaw::retune(const FmbpcParams& params) {
  coincidence_steps_ = params.coincidence_steps;
  aim_ = params.aimedColumn();
}

const Vector& CoincidenceLaw::shortfall(const InternalModel& model, const Matrix& future,
                                        Eigen::Index column) const {
  shortfall_ = future.col(column) - model.offsetOutput();
  shortfall_ -= settled_;
  return shortfall_;
}

Proposal CoincidenceLaw::propose(InternalModel& model, const LawSample& sample,
                                 const Matrix& future, Vector& input) {
  const bool solvable = computeGains(model.affine());
  settled_.noalias() = gains_.sum() * model.offsetState();
  shortfall(model, future, aim_);
  shortfall_.noalias() -= gains_.free() * model.state();
  input.noalias() = gains_.gain() * shortfall_;
  input.noalias() += gains_.moveGain() * sample.now.input_applied;
  return {solvable ? EventCode::kNone : EventCode::kInputWithoutEffect, notice()};
}

/// With A, B, g and y - y_m frozen, the law at k+i is affine in x(k+i): K = F P - V E, where E
/// picks u(k+i-1) from the state; what is left is the feedforward.
void CoincidenceLaw::predict(const InternalModel& model, const Matrix& future,
                             PredictiveAction& prediction) const {
  prediction.K.noalias() = gains_.gain() * gains_.free();
  for (Eigen::Index i = 0; i < prediction.feedforward.cols(); ++i)
    prediction.feedforward.col(i).noalias() = gains_.gain() * shortfall(model, future, i + aim_);
}

bool PublishedLaw::computeGains(const AffineModel& model) {
  return gains_.computePublished(model, coincidence_steps_);
}

GeneralLaw::GeneralLaw(const InternalModel& model, const FmbpcParams& params, Eigen::Index n_u)
    : CoincidenceLaw(model, params, n_u),
      weight_output_(params.weight_output),
      weight_move_(params.weight_move) {
  const TsModel& rules = model.local().model();
  for (std::size_t j = 0; j < rules.inputs.size(); ++j)
    idle_words_.push_back(knowsInput(rules, static_cast<int>(j))
                              ? "input " + rules.inputs[j].name +
                                    " has no effect at controller.coincidence_steps and rests"
                              : "");
}

void GeneralLaw::retune(const FmbpcParams& params) {
  CoincidenceLaw::retune(params);
  weight_output_ = params.weight_output;
  weight_move_ = params.weight_move;
}

bool GeneralLaw::computeGains(const AffineModel& model) {
  return gains_.computeWeighted(model, coincidence_steps_, weight_output_, weight_move_);
}

/// A weight of its moves makes an input solvable that cannot do anything.
Notice GeneralLaw::notice() const {
  for (std::size_t j = 0; j < idle_words_.size(); ++j)
    if (!idle_words_[j].empty() && gains_.isIdle(static_cast<Eigen::Index>(j)))
      return {EventCode::kInputWithoutEffect, idle_words_[j].c_str()};
  return {};
}

void GeneralLaw::predict(const InternalModel& model, const Matrix& future,
                         PredictiveAction& prediction) const {
  CoincidenceLaw::predict(model, future, prediction);
  for (Eigen::Index j = 0; j < weight_move_.size(); ++j)
    prediction.K.col(model.local().inputState(j, 1)) -= gains_.moveGain().col(j);
}

}  // namespace fpc
