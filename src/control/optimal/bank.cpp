#include "control/optimal/bank.hpp"

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Eigen::Index;

Index count(const std::vector<SignalInfo>& signals) { return static_cast<Index>(signals.size()); }

/// How a constant d_g moves the input: through every step of the recursion, or once on every
/// output.
Matrix correctionOf(const QuadraticLaw& law, const LocalModel& model, bool inside) {
  const Index n_y = count(model.model().outputs), n_u = law.K.rows();
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
  local.blend(Vector::Zero(local.stateSize()), Vector::Zero(count(model.disturbances)));
  QuadraticLaw law = makeQuadraticLaw(
      local.affine(), {tuning.horizon_steps, tuning.move_steps, params.solve == "together"},
      weights);
  require(law.usable, "controller.horizon_steps",
          "so many samples that in rule " + std::to_string(rule + 1) +
              " every input has an effect of its own, or a weight_move > 0");
  const Matrix correction = correctionOf(law, local, params.disturbance == "inside");
  for (Index j = 0; j < law.previous.cols(); ++j)
    law.K.col(local.inputState(j, 1)) -= law.previous.col(j);
  return {std::move(local), std::move(law), correction, Vector::Zero(correction.cols()),
          Vector::Zero(correction.rows())};
}

}  // namespace

FuzzyOptimalLaw::Bank::Bank(const TsModel& model, const FuzzyOptimalParams& params)
    : tuning(params.tuning),
      inside(params.disturbance == "inside"),
      estimated(params.disturbance != "none"),
      gain(params.disturbance_gain),
      local(model) {
  const RuleSplit split = splitRules(model);
  partition = split.partition;
  require(tuning.rules.empty() || tuning.rules.size() == split.rules.size(), "controller.rules",
          "one entry for each of the model's " + std::to_string(split.rules.size()) + " rules");
  for (std::size_t g = 0; g < split.rules.size(); ++g) {
    const QuadraticWeights& weights = tuning.rules.empty() ? tuning.weight : tuning.rules[g];
    rules.push_back(makeRule(split.rules[g], params, weights, g));
    short_sighted = short_sighted || rules.back().law.short_sighted;
  }
  const Index n_y = count(model.outputs), n_u = count(model.inputs), n_x = local.stateSize();
  state = before = predicted = offset_state = Vector::Zero(n_x);
  error = offset_output = seen = Vector::Zero(n_y);
  if (params.observe) observer.emplace(local, params.observer, 0);
  constant = Vector::Zero(n_u);
  future = Matrix::Zero(n_y, params.prediction_steps + tuning.horizon_steps - 1);
  K = Matrix::Zero(n_u, n_x);
  reference = Matrix::Zero(n_u, n_y * tuning.horizon_steps);
}

void FuzzyOptimalLaw::Bank::rest(const Measurement& now, VectorRef disturbances) {
  local.restState(now.outputs, now.input_applied, disturbances, state);
  before = state;
  begun = false;
  if (observer) observer->rest(now.outputs, now.input_applied, disturbances);
}

void FuzzyOptimalLaw::Bank::advance(const Measurement& now, VectorRef disturbances) {
  if (observer) {
    observer->advance(now.outputs, now.input_applied, disturbances);
    before = observer->before();
    state = observer->state();
    return;
  }
  before = state;
  local.shiftState(now.outputs, now.input_applied, disturbances, state);
}

/// What every rule is to agree with: the measurement, or what the observer makes of it.
void FuzzyOptimalLaw::Bank::look(const Measurement& now, VectorRef disturbances) {
  seen = now.outputs;
  if (!observer) return;
  local.blend(before, now.input_applied, disturbances);
  const AffineModel& m = local.affine();
  predicted = m.g;
  predicted.noalias() += m.A * before;
  predicted.noalias() += m.B * now.input_applied;
  for (Index i = 0; i < seen.size(); ++i)
    seen[i] = predicted[local.outputState(i)] + observer->disturbance()[i];
}

void FuzzyOptimalLaw::Bank::estimate(const Measurement& now, VectorRef disturbances) {
  if (!estimated) return;
  look(now, disturbances);
  for (FuzzyOptimalRule& rule : rules) {
    rule.model.blend(before, disturbances);
    const AffineModel& m = rule.model.affine();
    predicted = m.g;
    predicted.noalias() += m.A * before;
    predicted.noalias() += m.B * now.input_applied;
    for (Index i = 0; i < error.size(); ++i) {
      const double one_step = seen[i] - predicted[local.outputState(i)];
      double& d = rule.disturbance[i];
      d = begun && !observer ? d + gain * (one_step - d) : one_step;
    }
  }
  begun = true;
}

bool FuzzyOptimalLaw::Bank::blend(VectorRef disturbances, const Vector& input_target) {
  const bool fired = local.blend(state, disturbances);
  const Vector& weights = local.firing()[partition].weights;
  K.setZero();
  reference.setZero();
  constant.setZero();
  error.setZero();
  for (std::size_t g = 0; g < rules.size(); ++g) {
    FuzzyOptimalRule& rule = rules[g];
    const double w = weights[static_cast<Index>(g)];
    if (w == 0.0) continue;
    rule.model.blend(state, disturbances);
    rule.constant.noalias() = rule.law.target * input_target;
    rule.constant.noalias() -= rule.law.offset * rule.model.affine().g;
    rule.constant.noalias() += rule.correction * rule.disturbance;
    constant += w * rule.constant;
    K += w * rule.law.K;
    reference += w * rule.law.reference;
    error += w * rule.disturbance;
  }
  offset_state = local.affine().g;
  offset_output.setZero();
  for (Index i = 0; i < error.size(); ++i)
    (inside ? offset_state[local.outputState(i)] : offset_output[i]) += error[i];
  return fired;
}

void FuzzyOptimalLaw::Bank::forward(Index i, Eigen::Ref<Vector> input) const {
  const Eigen::Map<const Vector> path(future.col(i).data(), reference.cols());
  input = constant;
  input.noalias() += reference * path;
}

bool FuzzyOptimalLaw::Bank::inherit(const Bank& other) {
  const TsModel &mine = local.model(), &theirs = other.local.model();
  for (const SignalKind kind : {SignalKind::kOutput, SignalKind::kInput, SignalKind::kDisturbance})
    for (int i = 0; i < static_cast<int>(mine.signals(kind).size()); ++i)
      if (mine.maxLag(kind, i) != theirs.maxLag(kind, i)) return false;
  if (!other.state.allFinite() || !other.before.allFinite()) return false;
  state = other.state;
  before = other.before;
  if (observer && other.observer) observer->inherit(*other.observer);
  return true;
}

}  // namespace fpc
