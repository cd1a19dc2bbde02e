#include "control/mpc/horizon_mpc.hpp"

#include <algorithm>
#include <cmath>

#include "control/mpc/shifted_model.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kDifference = 1e-5;  // relative, of finite differences
constexpr double kTrial = 1e-3;       // of an input's range: a move whose effect is looked for

}  // namespace

HorizonMpc::HorizonMpc(HorizonParams params, InputLimits limits, const PlantInfo& plant)
    : params_((params.validate(countOf(plant.outputs), countOf(plant.inputs)), std::move(params))),
      limits_(std::move(limits)),
      n_y_(countOf(plant.outputs)),
      n_u_(countOf(plant.inputs)),
      reference_(params_.reference_pole, params_.preview),
      future_(Matrix::Zero(n_y_, params_.horizon_steps + params_.reference_lead_steps)),
      correction_(Vector::Zero(n_y_)),
      disturbances_(Vector::Zero(countOf(plant.disturbances))),
      plan_(Vector::Zero(n_u_ * params_.move_steps)),
      kept_(plan_),
      trial_(Vector::Zero(n_u_)) {
  limits_.validate(n_u_);
  range_ = limits_.upper - limits_.lower;
  range_ = (range_.array() > 0.0).select(range_, 1.0);
  for (const SignalInfo& output : plant.outputs)
    signals_.emplace_back(output.name + "_correction", 0.0);
  if (params_.observe && params_.observer.atInputs())
    for (const SignalInfo& input : plant.inputs)
      signals_.emplace_back(input.name + "_disturbance", 0.0);
  signals_.emplace_back("plan_cost", 0.0);
  signals_.emplace_back("plan_effort", 0.0);
}

void HorizonMpc::predictWith(std::unique_ptr<SampleModel> model) {
  if (params_.observe && params_.observer.atInputs()) {
    auto shifted = std::make_unique<ShiftedModel>(std::move(model), n_u_);
    shifted_ = shifted.get();
    model = std::move(shifted);
  }
  cost_ = std::make_unique<PlanCost>(*model, params_);
  model_ = std::move(model);
  state_ = present_ = next_ = moved_ = Vector::Zero(model_->stateSize());
  inputs_ = Matrix::Zero(n_u_, model_->delaySteps() + 1);
  past_ = Matrix::Zero(disturbances_.size(), inputs_.cols());
  if (params_.observe) {
    std::vector<Index> rows;
    for (Index i = 0; i < n_y_; ++i) rows.push_back(model_->outputState(i));
    observer_.emplace(params_.observer, state_.size(), rows);
    A_ = Matrix::Zero(state_.size(), state_.size());
    E_ = Matrix::Zero(state_.size(), n_u_);
    root_ = Matrix::Zero(state_.size(), n_y_ + n_u_);
    measured_ = Vector::Zero(n_y_);
    input_ = Vector::Zero(n_u_);
  }
  fresh_ = true;
}

bool HorizonMpc::goesOn(const StepHeader& header) const {
  return header.run_id == seen_.run_id && header.step == seen_.step + 1;
}

void HorizonMpc::reset(const Measurement& start) {
  reference_.reset(start.outputs);
  fresh_ = fresh_ || !goesOn(start.header);
  anew_ = true;
}

void HorizonMpc::lookOn(const Measurement& now) {
  if (!model_) return;
  fresh_ = fresh_ || !goesOn(now.header);
  estimate(now);
  seen_ = now.header;
  fresh_ = !state_.allFinite();
}

/// inputs_ and past_ are still those of the sample before.
bool HorizonMpc::foresee(const Measurement& now, Eigen::Ref<Vector> outputs) {
  if (!model_ || fresh_ || !goesOn(now.header)) return false;
  next_ = state_;
  const bool late = inputs_.cols() > 1;
  if (!(late ? model_->step(inputs_.col(1), past_.col(1), next_)
             : model_->step(now.input_applied, disturbances_, next_)))
    return false;
  for (Index i = 0; i < n_y_; ++i) outputs[i] = next_[model_->outputState(i)] + correction_[i];
  return true;
}

/// All inputs as the one in force.
void HorizonMpc::restPlan(const Measurement& now) {
  for (Index j = 0; j < plan_.size(); ++j) plan_[j] = now.input_applied[j % n_u_];
}

/// u(k-1) and d(k-1) become the newest; a start fills all.
void HorizonMpc::remember(const Measurement& now) {
  const Index last = inputs_.cols() - 1;
  if (fresh_) {
    inputs_.colwise() = now.input_applied;
    past_.colwise() = now.disturbances;
  } else {
    for (Index j = 0; j < last; ++j) {
      inputs_.col(j) = inputs_.col(j + 1);
      past_.col(j) = past_.col(j + 1);
    }
    inputs_.col(last) = now.input_applied;
    past_.col(last) = disturbances_;
  }
  disturbances_ = now.disturbances;
}

/// From when the outputs were true to now; false if something is not finite.
bool HorizonMpc::runForward() {
  present_ = state_;
  for (Index j = 1; j < inputs_.cols(); ++j) {
    if (!model_->step(inputs_.col(j), past_.col(j), present_)) return false;
    for (Index i = 0; i < n_y_; ++i) present_[model_->outputState(i)] += correction_[i];
  }
  return true;
}

/// (F(moved_) - F) / h with the inputs input_; false if something is not finite.
bool HorizonMpc::takeColumn(Eigen::Ref<Vector> column, double h) {
  if (!model_->step(input_, past_.col(0), moved_)) return false;
  column = (moved_ - next_) / h;
  return column.allFinite();
}

/// A and E at the state a sample before the outputs were true, and the state then; false if
/// something is not finite.
bool HorizonMpc::linearise() {
  next_ = state_;
  if (!model_->step(inputs_.col(0), past_.col(0), next_)) return false;
  input_ = inputs_.col(0);
  for (Index j = 0; j < state_.size(); ++j) {
    moved_ = state_;
    const double h = kDifference * std::max(kDifference, std::abs(state_[j]));
    moved_[j] += h;
    if (!takeColumn(A_.col(j), h)) return false;
  }
  for (Index a = 0; a < n_u_ && shifted_; ++a) {
    moved_ = state_;
    const bool high = input_[a] > limits_.lower[a] + 0.5 * range_[a];  // away from the bound
    const double before = input_[a], h = (high ? -kDifference : kDifference) * range_[a];
    input_[a] = before + h;
    if (!takeColumn(E_.col(a), h)) return false;
    input_[a] = before;
  }
  state_ = next_;
  return true;
}

/// At rest, and how uncertain that is: by the noise of what is measured and, where the inputs are
/// disturbed, by a disturbance that nobody has seen yet.
void HorizonMpc::restAnew(const Measurement& now) {
  const ObserverParams& stated = params_.observer;
  measured_ = now.outputs;
  input_ = now.input_applied;
  model_->rest(measured_, input_, disturbances_, state_);
  root_.setZero();
  for (Index i = 0; i < n_y_; ++i) {
    measured_[i] = now.outputs[i] + stated.noise_std[i];
    model_->rest(measured_, input_, disturbances_, moved_);
    root_.col(i) = moved_ - state_;
    measured_[i] = now.outputs[i];
  }
  for (Index a = 0; a < n_u_ && shifted_; ++a) {
    input_[a] = now.input_applied[a] + kUnknownChanges * stated.input_std[a];
    model_->rest(measured_, input_, disturbances_, moved_);
    root_.col(n_y_ + a) = moved_ - state_;
    input_[a] = now.input_applied[a];
  }
  if (root_.allFinite())
    observer_->reset(root_);
  else
    observer_->reset();
}

/// estimate() with the observer.
bool HorizonMpc::observe(const Measurement& now) {
  const bool follows = !fresh_ && linearise();
  fresh_ = false;
  if (follows) {
    if (shifted_) {
      observer_->predict(A_, E_);
    } else {
      observer_->addDisturbance(state_);
      observer_->predict(A_);
    }
    observer_->correct(now.outputs, state_);
  } else {
    restAnew(now);
    for (Index i = 0; i < n_y_; ++i) state_[model_->outputState(i)] = now.outputs[i];
  }
  if (shifted_)
    shifted_->setOffset(observer_->disturbance());
  else
    correction_ = observer_->disturbance();
  return follows;
}

/// False if the state had to start anew.
bool HorizonMpc::estimate(const Measurement& now) {
  remember(now);
  if (observer_) return observe(now);
  const bool follows = !fresh_ && model_->step(inputs_.col(0), past_.col(0), state_);
  fresh_ = false;
  correction_.setZero();
  if (!follows) model_->rest(now.outputs, now.input_applied, disturbances_, state_);
  for (Index i = 0; i < n_y_; ++i) {
    double& predicted = state_[model_->outputState(i)];
    if (follows) correction_[i] = now.outputs[i] - predicted;
    predicted = now.outputs[i];
  }
  return follows;
}

void HorizonMpc::step(const Measurement& now, const SetpointSource& setpoint,
                      ControllerOutput& output) {
  output.begin();
  output.reference = reference_.present();
  reference_.predict(setpoint, now.header.step, future_);
  reference_.advance(setpoint, now.header.step);
  const Index rest = plan_.size() - n_u_;
  const bool follows = estimate(now);
  seen_ = now.header;
  if (follows && runForward()) {
    for (Index j = 0; j < rest; ++j) plan_[j] = plan_[j + n_u_];
  } else {
    anew_ = true;
    present_ = state_;
  }
  if (anew_) restPlan(now);
  clipPlan(plan_, now.input_applied, limits_);
  kept_ = plan_;
  cost_->start(present_, correction_, disturbances_, now.input_applied,
               future_.rightCols(params_.horizon_steps));
  PlanFound found = search(now, plan_);
  found.usable = found.usable && plan_.allFinite();
  if (!found.usable) plan_ = kept_;
  clipPlan(plan_, now.input_applied, limits_);  // round-off
  output.input = plan_.head(n_u_);
  output.source = found.usable ? ActionSource::kBase : ActionSource::kClipped;
  output.ok = found.usable;
  if (found.event != EventCode::kNone) output.events.add({found.event});
  if (anew_ && isShortSighted(now)) output.events.add({EventCode::kHorizonTooShort});
  anew_ = false;
  if (!state_.allFinite()) fresh_ = true;
  refreshSignals(found);
}

/// Moves each input into its range; one whose bounds coincide never acts.
bool HorizonMpc::isShortSighted(const Measurement& now) {
  for (Index a = 0; a < n_u_; ++a) {
    const double step = limits_.upper[a] > limits_.lower[a] ? kTrial * range_[a] : 0.0;
    trial_[a] = now.input_applied[a] + step <= limits_.upper[a] ? step : -step;
  }
  return cost_->isShortSighted(trial_);
}

void HorizonMpc::refreshSignals(const PlanFound& found) {
  std::size_t place = 0;
  for (Index i = 0; i < n_y_; ++i) signals_[place++].second = correction_[i];
  for (Index a = 0; a < n_u_ && shifted_; ++a) signals_[place++].second = shifted_->offset()[a];
  signals_[place++].second = found.cost;
  signals_[place].second = static_cast<double>(found.effort);
}

}  // namespace fpc
