#include "supervision/guard.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/model/model_match.hpp"
#include "model/model_inputs.hpp"
#include "model/process_trust.hpp"

namespace fpc {
namespace {

using Eigen::Index;

/// Outputs, an input and disturbances, as models have them.
void place(const Measurement& now, VectorRef input, Vector& point) {
  const Index n_y = now.outputs.size(), n_u = input.size();
  point.head(n_y) = now.outputs;
  point.segment(n_y, n_u) = input;
  point.tail(now.disturbances.size()) = now.disturbances;
}

constexpr double kHalf = 0.5;  // of an input's range

}  // namespace

void GuardParams::validate(Index n_y, bool has_fallback) const {
  require(trust_low >= 0.0 && trust_high >= trust_low && trust_high <= 1.0, "guard.trust",
          "[low, high] with 0 <= low <= high <= 1");
  require(look_ahead >= 0, "guard.look_ahead", "an integer >= 0");
  require(horizon_least >= 0, "guard.horizon_least", "an integer >= 0");
  require(return_samples >= 1, "guard.return_samples", "an integer >= 1");
  require(lock_samples >= 0, "guard.lock_samples", "an integer >= 0");
  require(growing_swings == 0 ||
              (growing_swings >= GrowingSwings::kFewest && growing_swings <= GrowingSwings::kMost),
          "guard.growing_swings", "0, or an integer from 3 to 20");
  require(growing_swings == 0 || has_fallback, "guard.growing_swings", "guard.fallback beside it");
  for (const Index i : lock_outputs)
    require(i >= 0 && i < n_y, "guard: outputs that the law follows", "outputs of the plant");
}

GuardedController::GuardedController(std::unique_ptr<Controller> inside,
                                     std::unique_ptr<Controller> fallback, GuardParams params,
                                     InputLimits limits, PlantInfo plant)
    : ControllerAround(std::move(inside), "guard"),
      plan_(dynamic_cast<PlanView*>(inside_.get())),
      params_(std::move(params)),
      limits_(std::move(limits)),
      shrunk_(limits_),
      lower_(limits_.lower),
      upper_(limits_.upper),
      plant_(std::move(plant)),
      fallback_(std::move(fallback)) {
  const Index n_y = countOf(plant_.outputs), n_u = countOf(plant_.inputs);
  params_.validate(n_y, fallback_ != nullptr);
  limits_.validate(n_u);
  if (plan_ && params_.horizon_least > 0)
    plan_->setTrustThreshold(params_.trust_low, params_.horizon_least);
  for (Index i = 0; i < n_u; ++i) locks_.emplace_back(params_, limits_.lower[i], limits_.upper[i]);
  moved_.assign(locks_.size(), true);
  growing_.assign(locks_.size(), GrowingSwings(params_.growing_swings, n_y));
  if (params_.lock_outputs.empty())
    for (Index i = 0; i < n_y; ++i) params_.lock_outputs.push_back(i);
  point_ = Vector::Zero(n_y + n_u + countOf(plant_.disturbances));
  refreshSignals();
}

void GuardedController::forget() {
  inside_->forget();
  if (fallback_) fallback_->forget();
}

void GuardedController::lookOn(const Measurement& now) {
  inside_->lookOn(now);
  if (fallback_) fallback_->lookOn(now);
}

bool GuardedController::expect(std::uint32_t k, Index disturbance, VectorRef ahead) {
  const bool used = fallback_ && fallback_->expect(k, disturbance, ahead);
  return inside_->expect(k, disturbance, ahead) || used;
}

void GuardedController::setModel(const TsModel& model) {
  inside_->setModel(model);
  try {
    if (fallback_) fallback_->setModel(model);
  } catch (const InputError&) {
    if (!model_.submodels.empty()) inside_->setModel(model_);
    throw;
  }
  model_ = matchToPlant(model, plant_);
  known_ = knowsDomain(model_);
  for (std::size_t i = 0; i < moved_.size(); ++i)
    moved_[i] = knowsInput(model_, static_cast<int>(i));
}

void GuardedController::reset(const Measurement& start) {
  inside_->reset(start);
  if (fallback_) fallback_->reset(start);
  from_ = start;
  for (LockUpWatch& lock : locks_) lock.reset();
  for (GrowingSwings& swing : growing_) swing.reset();
  fallen_back_ = unstable_ = false;
  above_ = 0;
  ahead_.reset();
  view_ = {};
}

double GuardedController::trustAt(const Measurement& now, VectorRef input) {
  if (!known_) return 1.0;
  place(now, input, point_);
  return trustOf(model_, point_);
}

/// Trust along what the law expects.
void GuardedController::lookAhead(const Measurement& now, const ControllerOutput& output) {
  ahead_.reset();
  if (!known_ || !output.ok) return;
  if (plan_ && plan_->plannedSteps() > 0) {
    ahead_.judge(model_, *plan_, params_.trust_low);
    view_.near = ahead_.leastOfProcess(model_, *plan_, params_.look_ahead);
  } else if (output.predictive) {
    ahead_.judge(model_, output.prediction, now.disturbances, params_.trust_low);
  }
  view_.ahead = ahead_.least();
}

/// The law goes on from the applied input once the data are back for long enough. What it learned
/// of the process where its model knows nothing is forgotten.
void GuardedController::comeBack(const Measurement& now, double trust) {
  above_ = trust >= params_.trust_high ? above_ + 1 : 0;
  if (!fallen_back_ || unstable_ || above_ < params_.return_samples) return;
  fallen_back_ = false;
  for (GrowingSwings& swing : growing_) swing.reset();
  inside_->forget();
  inside_->reset(now);
}

WorstError GuardedController::worstError(const Measurement& now,
                                         const SetpointSource& setpoint) const {
  WorstError worst;
  for (const Index i : params_.lock_outputs) {
    const SignalInfo& output = plant_.outputs[static_cast<std::size_t>(i)];
    const double tolerated = params_.lock_error * (output.upper - output.lower);
    if (!std::isfinite(tolerated) || tolerated <= 0.0) continue;
    const double error = (setpoint.present()[i] - now.outputs[i]) / tolerated;
    if (!(std::abs(error) > worst.size)) continue;  // NaN is none
    worst.size = std::abs(error);
    worst.whose = static_cast<int>(error > 0.0 ? i + 1 : -(i + 1));
  }
  return worst;
}

void GuardedController::watchLocks(const Measurement& now, const SetpointSource& setpoint) {
  const WorstError error = worstError(now, setpoint);
  view_.locked = false;
  for (std::size_t i = 0; i < locks_.size(); ++i) {
    if (!moved_[i]) continue;
    const auto k = static_cast<Index>(i);
    view_.locked = locks_[i].observe(now.input_applied[k], error.size, error.whose) || view_.locked;
    shrunk_.lower[k] = locks_[i].lower();
    shrunk_.upper[k] = locks_[i].upper();
  }
}

/// Below trust_high no move is larger than half the range, and the limit goes down to least_move of
/// it at trust_low.
void GuardedController::shrink(double trust) {
  const double width = params_.trust_high - params_.trust_low;
  const double part = width > 0.0 ? std::clamp((trust - params_.trust_low) / width, 0.0, 1.0) : 0.0;
  for (Index i = 0; i < shrunk_.move.size(); ++i) {
    const double range = limits_.upper[i] - limits_.lower[i];
    const double first = std::max(kHalf, params_.least_move);
    const double share = params_.least_move + (first - params_.least_move) * part;
    shrunk_.move[i] = limits_.move[i];
    if (trust < params_.trust_high && std::isfinite(range))
      shrunk_.move[i] = std::min(limits_.move[i], share * range);
  }
}

/// Limits that are drawn in are reached by allowed moves only.
void GuardedController::narrow(const Vector& before) {
  for (Index i = 0; i < before.size(); ++i) {
    const auto allowed = [&](double end) {
      const double move = std::clamp(end, before[i] - shrunk_.move[i], before[i] + shrunk_.move[i]);
      return std::clamp(move, limits_.lower[i], limits_.upper[i]);
    };
    lower_[i] = allowed(shrunk_.lower[i]);
    upper_[i] = allowed(shrunk_.upper[i]);
  }
}

/// Whether the law swings an input further each time; from_ is then the middle of the swing.
bool GuardedController::swingsGrow(const Measurement& now) {
  bool grow = false;
  for (std::size_t i = 0; i < growing_.size(); ++i) {
    const auto k = static_cast<Index>(i);
    if (!growing_[i].add(now.input_applied[k], now.outputs)) continue;
    if (!grow) from_ = now;
    growing_[i].middle(from_.input_applied[k], from_.outputs);
    grow = true;
  }
  return grow;
}

/// Where the model has no data, and for good once an input swings further each time. A fallback
/// that begins in a swing begins from its middle, but one with a model follows the process, which
/// is not there.
void GuardedController::fallBack(const Measurement& now, bool outside) {
  if (!fallback_ || fallen_back_) return;
  unstable_ = swingsGrow(now);
  if (!unstable_ && !outside) return;
  if (!unstable_ || fallback_->needsModel()) from_ = now;
  fallen_back_ = begins_ = true;
  fallback_->reset(from_);
}

void GuardedController::askFallback(const Measurement& now, const SetpointSource& setpoint,
                                    ControllerOutput& output) {
  fallback_output_.begin();
  fallback_->step(begins_ ? from_ : now, setpoint, fallback_output_);
  begins_ = false;
  output.input = fallback_output_.input;
  output.ok = fallback_output_.ok;
  for (const Notice& notice : fallback_output_.events) output.events.add(notice);
}

double GuardedController::trustForMoves(const Measurement& now) {
  if (fallen_back_ || !known_) return 1.0;
  place(now, now.input_applied, point_);
  return processTrustOf(model_, point_);
}

void GuardedController::act(const Measurement& now, const SetpointSource& setpoint,
                            ControllerOutput& output) {
  if (fallen_back_) askFallback(now, setpoint, output);
  const double trust = trustForMoves(now);
  shrink(std::min(trust, fallen_back_ ? 1.0 : view_.near));
  bool drawn = false;
  proposed_ = output.input;
  narrow(now.input_applied);
  for (Index i = 0; i < output.input.size(); ++i) {
    const double proposed = proposed_[i];
    const double allowed = std::clamp(proposed, lower_[i], upper_[i]);
    drawn = drawn || (allowed != proposed && locks_[static_cast<std::size_t>(i)].drawnIn());
    view_.acting = view_.acting || allowed != proposed;
    if (allowed != proposed) output.input[i] = allowed;
  }
  if (view_.acting && !inside_->mayBeSent(output.input)) {  // between two positions of a valve
    output.input = proposed_;
    view_.acting = drawn = false;
  }
  if (output.predictive) {
    output.prediction.input_lower = lower_;
    output.prediction.input_upper = upper_;
  }
  if (fallen_back_) {
    output.source = ActionSource::kFallback;
    output.predictive = false;
    view_.acting = true;
  }
  if (!view_.acting || fallen_back_) return;
  output.source = ActionSource::kGuarded;
  if (drawn) output.events.add({EventCode::kLockUp});
}

void GuardedController::step(const Measurement& now, const SetpointSource& setpoint,
                             ControllerOutput& output) {
  view_ = {};
  const double present = trustAt(now, now.input_applied);
  const double process = known_ ? processTrustOf(model_, point_) : 1.0;
  if (fallback_) comeBack(now, process);
  watchLocks(now, setpoint);
  inside_->step(now, setpoint, output);
  lookAhead(now, output);
  view_.trust = present;
  const bool acts = isLawsOwn(output.source);
  if (acts) {
    view_.trust = std::min(present, trustAt(now, output.input));
    fallBack(now, process < params_.trust_low);
    view_.outside = view_.trust < params_.trust_low;
    act(now, setpoint, output);
  }
  if (unstable_) output.events.add({EventCode::kOscillationGrows});
  if (process < params_.trust_low) output.events.add({EventCode::kOutsideModel});
  if (fallback_ && !(acts && fallen_back_)) fallback_->lookOn(now);
  refreshSignals();
}

void GuardedController::refreshSignals() {
  const auto& inner = inside_->signals();
  if (signals_.size() != inner.size() + 4) {
    signals_ = inner;
    signals_.emplace_back("model_trust", 1.0);
    signals_.emplace_back("model_trust_ahead", 1.0);
    signals_.emplace_back("model_trust_steps", 0.0);
    signals_.emplace_back("locked", 0.0);
  }
  for (std::size_t i = 0; i < inner.size(); ++i) signals_[i].second = inner[i].second;
  const double own[] = {view_.trust, view_.ahead, static_cast<double>(ahead_.trustedSteps()),
                        view_.locked ? 1.0 : 0.0};
  for (std::size_t i = 0; i < std::size(own); ++i) signals_[inner.size() + i].second = own[i];
}

}  // namespace fpc
