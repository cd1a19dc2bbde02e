#include "control/fuzzy_lq/core.hpp"

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "model/same_rules.hpp"

namespace fpc {
namespace {

using Eigen::Index;

/// How a constant d_g moves the input: through every step of the recursion, or once on every
/// output.
Matrix correctionOf(const QuadraticLaw& law, const LocalModel& model, bool inside) {
  const Index n_y = countOf(model.model().outputs), n_u = law.K.rows();
  Matrix correction = Matrix::Zero(n_u, n_y);
  for (Index i = 0; inside && i < n_y; ++i)
    correction.col(i) = -law.offset.col(model.outputState(i));
  for (Index j = 0; !inside && j < law.reference.cols(); j += n_y)
    correction -= law.reference.middleCols(j, n_y);
  return correction;
}

FuzzyOptimalRule makeRule(const TsModel& model, const FuzzyOptimalParams& params,
                          const QuadraticWeights& weights, std::size_t rule) {
  const FuzzyOptimalTuning& tuning = params.tuning;
  LocalModel local(model);
  local.blend(Vector::Zero(local.stateSize()), Vector::Zero(countOf(model.disturbances)));
  QuadraticLaw law = makeQuadraticLaw(
      local.affine(),
      {tuning.horizon_steps, tuning.move_steps, params.solve == FuzzyOptimalSolve::kTogether},
      weights);
  require(law.usable, "controller.horizon_steps",
          "so many samples that in rule " + std::to_string(rule + 1) +
              " every input has an effect of its own, or a weight_move > 0");
  const Matrix correction =
      correctionOf(law, local, params.disturbance == FuzzyOptimalDisturbance::kInside);
  for (Index j = 0; j < law.previous.cols(); ++j)
    law.K.col(local.inputState(j, 1)) -= law.previous.col(j);
  return {std::move(local), std::move(law), correction, Vector::Zero(correction.cols()),
          Vector::Zero(correction.rows())};
}

}  // namespace

FuzzyOptimalCore::FuzzyOptimalCore(const TsModel& model, const FuzzyOptimalParams& params)
    : params_(params), local_(model) {
  const FuzzyOptimalTuning& tuning = params_.tuning;
  const RuleSplit split = splitRules(model);
  partition_ = split.partition;
  require(tuning.rules.empty() || tuning.rules.size() == split.rules.size(), "controller.rules",
          "one entry for each of the model's " + std::to_string(split.rules.size()) + " rules");
  for (std::size_t g = 0; g < split.rules.size(); ++g) {
    const QuadraticWeights& weights = tuning.rules.empty() ? tuning.weight : tuning.rules[g];
    rules_.push_back(makeRule(split.rules[g], params, weights, g));
    short_sighted_ = short_sighted_ || rules_.back().law.short_sighted;
  }
  const Index n_y = countOf(model.outputs), n_u = countOf(model.inputs), n_x = local_.stateSize();
  state_ = before_ = predicted_ = offset_state_ = Vector::Zero(n_x);
  error_ = offset_output_ = seen_ = Vector::Zero(n_y);
  if (params.observe) observer_.emplace(local_, params.observer, 0);
  constant_ = Vector::Zero(n_u);
  future_ = Matrix::Zero(n_y, params.prediction_steps + tuning.horizon_steps - 1);
  K_ = Matrix::Zero(n_u, n_x);
  reference_ = Matrix::Zero(n_u, n_y * tuning.horizon_steps);
}

void FuzzyOptimalCore::rest(const LawSample& sample) {
  const Measurement& now = sample.now;
  local_.restState(now.outputs, now.input_applied, sample.disturbances, state_);
  before_ = state_;
  warns_ = short_sighted_;
  if (observer_) observer_->rest(now.outputs, now.input_applied, sample.disturbances);
}

void FuzzyOptimalCore::advance(const LawSample& sample) {
  const Measurement& now = sample.now;
  warns_ = false;
  if (observer_) {
    observer_->advance(now.outputs, now.input_applied, sample.past_disturbances);
    before_ = observer_->before();
    state_ = observer_->state();
    return;
  }
  before_ = state_;
  local_.shiftState(now.outputs, now.input_applied, sample.past_disturbances, state_);
}

void FuzzyOptimalCore::foresee(VectorRef input, VectorRef past_disturbances,
                               Eigen::Ref<Vector> outputs) {
  if (observer_) return observer_->foresee(input, past_disturbances, outputs);
  predicted_ = offset_state_;
  predicted_.noalias() += local_.affine().A * state_;
  predicted_.noalias() += local_.affine().B * input;
  outputs.noalias() = local_.affine().C.lazyProduct(predicted_);
  outputs += offset_output_;
}

/// predicted_ = x(k|k-1) of a model that was blended at k-1.
void FuzzyOptimalCore::predictOneStep(const AffineModel& model, VectorRef input) {
  predicted_ = model.g;
  predicted_.noalias() += model.A * before_;
  predicted_.noalias() += model.B * input;
}

/// What every rule is to agree with: the measurement, or what the observer makes of it.
void FuzzyOptimalCore::see(const LawSample& sample) {
  seen_ = sample.now.outputs;
  if (!observer_) return;
  local_.blend(before_, sample.now.input_applied, sample.past_disturbances);
  predictOneStep(local_.affine(), sample.now.input_applied);
  for (Index i = 0; i < seen_.size(); ++i)
    seen_[i] = predicted_[local_.outputState(i)] + observer_->disturbance()[i];
}

/// d_g from the one-step errors.
void FuzzyOptimalCore::estimate(const LawSample& sample) {
  if (params_.disturbance == FuzzyOptimalDisturbance::kNone) return;
  see(sample);
  for (FuzzyOptimalRule& rule : rules_) {
    rule.model.blend(before_, sample.past_disturbances);
    predictOneStep(rule.model.affine(), sample.now.input_applied);
    for (Index i = 0; i < error_.size(); ++i) {
      rule.disturbance[i] = seen_[i] - predicted_[local_.outputState(i)];
    }
  }
}

bool FuzzyOptimalCore::look(const LawSample& sample) {
  estimate(sample);
  return blend(sample.disturbances);
}

/// Models and laws at x(k), d(k).
bool FuzzyOptimalCore::blend(VectorRef disturbances) {
  const bool fired = local_.blend(state_, disturbances);
  const Vector& weights = local_.firing()[partition_].weights;
  K_.setZero();
  reference_.setZero();
  constant_.setZero();
  error_.setZero();
  for (std::size_t g = 0; g < rules_.size(); ++g) {
    FuzzyOptimalRule& rule = rules_[g];
    const double w = weights[static_cast<Index>(g)];
    if (w == 0.0) continue;
    rule.model.blend(state_, disturbances);
    rule.constant.noalias() = rule.law.target * params_.tuning.input_target;
    rule.constant.noalias() -= rule.law.offset * rule.model.affine().g;
    rule.constant.noalias() += rule.correction * rule.disturbance;
    constant_ += w * rule.constant;
    K_ += w * rule.law.K;
    reference_ += w * rule.law.reference;
    error_ += w * rule.disturbance;
  }
  offset_state_ = local_.affine().g;
  offset_output_.setZero();
  const bool inside = params_.disturbance == FuzzyOptimalDisturbance::kInside;
  for (Index i = 0; i < error_.size(); ++i)
    (inside ? offset_state_[local_.outputState(i)] : offset_output_[i]) += error_[i];
  return fired;
}

void FuzzyOptimalCore::forward(Index i, Eigen::Ref<Vector> input) const {
  const Eigen::Map<const Vector> path(future_.col(i).data(), reference_.cols());
  input = constant_;
  input.noalias() += reference_ * path;
}

Proposal FuzzyOptimalCore::propose(const LawSample& sample, Vector& input) {
  sample.reference.predict(sample.setpoint, sample.now.header.step, future_);
  forward(0, input);
  input.noalias() -= K_ * state_;
  return {EventCode::kNone, {warns_ ? EventCode::kHorizonTooShort : EventCode::kNone}};
}

void FuzzyOptimalCore::predict(PredictiveAction& prediction) const {
  const Index n_c = params_.prediction_steps;
  prediction.state = state_;
  prediction.A = local_.affine().A;
  prediction.B = local_.affine().B;
  prediction.C = local_.affine().C;
  prediction.offset_state = offset_state_;
  prediction.offset_output = offset_output_;
  prediction.K = K_;
  prediction.feedforward.resize(constant_.size(), n_c);
  for (Index i = 0; i < n_c; ++i) forward(i, prediction.feedforward.col(i));
  prediction.reference = future_.leftCols(n_c);
}

bool FuzzyOptimalCore::inherit(const LawCore& older) {
  const auto& other = static_cast<const FuzzyOptimalCore&>(older);
  if (!sameLags(local_.model(), other.local_.model())) return false;
  if (!other.state_.allFinite() || !other.before_.allFinite()) return false;
  state_ = other.state_;
  before_ = other.before_;
  if (observer_ && other.observer_) observer_->inherit(*other.observer_);
  return true;
}

}  // namespace fpc
