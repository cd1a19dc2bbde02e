#include <cmath>
#include <utility>

#include "fmbpc/base/signals.hpp"
#include "runtime/session.hpp"

namespace fpc {
namespace {

bool hasSize(const Matrix& matrix, Eigen::Index rows, Eigen::Index columns) {
  return matrix.rows() == rows && matrix.cols() == columns;
}

bool allFinite(const PredictiveAction& p) {
  return p.state.allFinite() && p.A.allFinite() && p.B.allFinite() && p.C.allFinite() &&
         p.offset_state.allFinite() && p.offset_output.allFinite() && p.K.allFinite() &&
         p.feedforward.allFinite() && p.reference.allFinite() && p.setpoint.allFinite() &&
         p.input_base_unclipped.allFinite() && p.input_previous.allFinite() &&
         p.input_lower.allFinite() && (p.input_lower.array() <= p.input_upper.array()).all() &&
         (p.output_lower.array() <= p.output_upper.array()).all();
}

}  // namespace

bool needsPrediction(ActionSource source) {
  return source == ActionSource::kBase || source == ActionSource::kClipped ||
         source == ActionSource::kGuarded;
}

OptimizerSession::OptimizerSession(ClpParams params, InputLimits limits, PlantInfo plant)
    : params_(std::move(params)),
      limits_(std::move(limits)),
      moves_(limits_),
      transfer_(countOf(plant.inputs)),
      plant_(std::move(plant)) {
  const auto n_u = static_cast<Eigen::Index>(plant_.inputs.size());
  params_.validate(static_cast<Eigen::Index>(plant_.outputs.size()), n_u);
  limits_.validate(n_u);
  report_.perturbation = Vector::Zero(n_u);
}

bool OptimizerSession::sizesFit(const PredictiveAction& p) const {
  const auto n_y = static_cast<Eigen::Index>(plant_.outputs.size());
  const auto n_u = static_cast<Eigen::Index>(plant_.inputs.size());
  const Eigen::Index n_x = p.state.size();
  const Eigen::Index n_c = p.feedforward.cols();
  return n_x > 0 && n_c >= params_.perturbation_steps && hasSize(p.A, n_x, n_x) &&
         hasSize(p.B, n_x, n_u) && hasSize(p.C, n_y, n_x) && p.offset_state.size() == n_x &&
         p.offset_output.size() == n_y && hasSize(p.K, n_u, n_x) &&
         hasSize(p.feedforward, n_u, n_c) && hasSize(p.reference, n_y, n_c) &&
         p.setpoint.size() == n_y && p.input_base_unclipped.size() == n_u &&
         p.input_previous.size() == n_u && p.input_lower.size() == p.input_upper.size() &&
         (p.input_lower.size() == 0 || p.input_lower.size() == n_u) &&
         p.output_lower.size() == p.output_upper.size() &&
         (p.output_lower.size() == 0 || p.output_lower.size() == n_y);
}

// A sample is opened by whichever of its two messages comes first; its partner is not a repeat.
bool OptimizerSession::admit(const StepHeader& header, bool already_here) {
  if (!answered_ && !already_here && gate_.classify(header) == Arrival::kRepeat) return true;
  const Arrival arrival = gate_.pass(header);
  if (!isNew(arrival)) return false;
  if (needsReset(arrival)) moves_.restart();
  if (needsReset(arrival)) transfer_.reset(arrival != Arrival::kNewRun && transfer_.active());
  if (needsReset(arrival) && optimizer_) optimizer_->reset();
  have_base_ = have_prediction_ = answered_ = false;
  return true;
}

bool OptimizerSession::isAnswered(const StepHeader& header) const {
  return answered_ && gate_.classify(header) == Arrival::kRepeat;
}

bool OptimizerSession::receive(const ControlAction& base) {
  if (static_cast<std::size_t>(base.input.size()) != plant_.inputs.size()) {
    gate_.countWrongSize();
    return false;
  }
  if (!base.input.allFinite()) {
    gate_.countNotFinite();
    return false;
  }
  if (!admit(base.header, have_base_)) return isAnswered(base.header);
  base_ = base;
  have_base_ = true;
  return tryAnswer();
}

bool OptimizerSession::receive(const PredictiveAction& prediction) {
  const bool fits = sizesFit(prediction);
  if (!fits || !allFinite(prediction)) return refuse(prediction.header, fits);
  if (!admit(prediction.header, have_prediction_)) return isAnswered(prediction.header);
  prediction_ = prediction;
  have_prediction_ = true;
  return tryAnswer();
}

// What cannot be used must not open a sample: its header does not count before a base action
// says the same.
bool OptimizerSession::refuse(const StepHeader& header, bool fits) {
  if (fits)
    gate_.countNotFinite();
  else
    gate_.countWrongSize();
  refused_ = header;
  refused_reason_ = fits ? "the prediction is not finite" : "the prediction has wrong sizes";
  return !answered_ && tryAnswer();
}

bool OptimizerSession::baseIsRefused() const {
  return refused_reason_ != nullptr && refused_.run_id == base_.header.run_id &&
         refused_.step == base_.header.step;
}

bool OptimizerSession::tryAnswer() {
  if (!have_base_) return false;
  const char* trouble = "";
  if (!needsPrediction(base_.source)) {
    passThrough(SolveStatus::kNotRun);
  } else if (have_prediction_) {
    optimize();
  } else if (baseIsRefused()) {
    trouble = refused_reason_;
    passThrough(SolveStatus::kInvalidProblem);
  } else {
    return false;
  }
  trouble_ = trouble;
  action_.header = report_.header = base_.header;
  answered_ = true;
  return true;
}

void OptimizerSession::optimize() {
  if (!optimizer_ || n_x_ != prediction_.state.size()) {
    n_x_ = prediction_.state.size();
    optimizer_ = std::make_unique<ClosedLoopParadigm>(params_, limits_, n_x_, prediction_.C.rows(),
                                                      prediction_.B.cols());
  }
  moves_.look(prediction_.input_previous);
  prediction_.input_previous = moves_.origin();
  optimizer_->step(prediction_, action_, report_);
  if (base_.source == ActionSource::kGuarded) action_.source = ActionSource::kGuarded;
  const bool bridged = transfer_.bridge(prediction_.input_previous, action_.input);
  if (bridged) limits_.clip(action_.input, prediction_.input_previous);
  if (moves_.keepNear(action_.input) || bridged) {
    action_.source = ActionSource::kClipped;
    report_.perturbation = action_.input - prediction_.input_base_unclipped;
  }
  moves_.sent(action_.input);
}

Matrix OptimizerSession::plan() const {
  const bool solved =
      report_.status == SolveStatus::kSolved || report_.status == SolveStatus::kBoundWins;
  if (!optimizer_ || !solved) return {};
  const Vector& scale = optimizer_->problem().input_scale;
  const Vector& x = optimizer_->solution().x;  // the slacks come last
  return scale.asDiagonal() *
         Eigen::Map<const Matrix>(x.data(), scale.size(), params_.perturbation_steps);
}

/// The input is not the one that went out before: a person's, a fallback, the plant's own. Rounding
/// is no other hand.
bool OptimizerSession::isOtherHand() const {
  if (base_.source != ActionSource::kHeld) return !needsPrediction(base_.source);
  constexpr double kRounding = 1e-9;  // of the range, or of the input where it has none
  const Vector &before = action_.input, &now = base_.input;
  if (before.size() != now.size()) return true;
  for (Eigen::Index j = 0; j < now.size(); ++j) {
    const double range = limits_.upper[j] - limits_.lower[j];
    const double size = std::isfinite(range) ? range : std::abs(before[j]);
    if (!(std::abs(now[j] - before[j]) <= kRounding * size)) return true;
  }
  return false;
}

// The base action is inside its limits already; the bounds are for controllers that broke the rule.
void OptimizerSession::passThrough(SolveStatus status) {
  moves_.restart();
  if (isOtherHand() || transfer_.active()) transfer_.reset(true);
  action_.input = base_.input;
  limits_.clip(action_.input, base_.input);
  action_.source = status == SolveStatus::kNotRun ? base_.source : ActionSource::kClipped;
  report_.perturbation = action_.input - base_.input;
  report_.status = status;
  report_.iterations = 0;
  report_.kkt_residual = 0.0;
  report_.seconds = 0.0;
  report_.active_rows = 0;
}

}  // namespace fpc
