#include "runtime/session.hpp"

#include <cmath>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/model/model_match.hpp"
#include "model/gain_sign.hpp"
#include "model/model_check.hpp"
#include "supervision/actuator_effectiveness.hpp"

namespace fpc {
namespace {

SampleClock clockOf(const PlantInfo& plant) {
  return SampleClock(plant.sample_time_s, static_cast<double>(plant.header.time_ns) / 1e9);
}

constexpr const char* kNotFinite = "data before were not finite";
constexpr const char* kDoubted = "data before were doubtful";

bool isIn(const TsModel& model, SignalKind kind, Eigen::Index index) {
  for (const auto& submodel : model.submodels)
    for (const auto* list : {&submodel.antecedents, &submodel.regressors})
      for (const Regressor& regressor : *list)
        if (regressor.kind == kind && regressor.index == index) return true;
  return false;
}

std::string missingSamples(std::uint32_t first, std::uint32_t last) {
  if (first == last) return "sample " + std::to_string(first) + " missing";
  return "samples " + std::to_string(first) + ".." + std::to_string(last) + " missing";
}

/// By output; empty without limits.
std::vector<std::string> setpointTexts(const SetpointParams& setpoint, const PlantInfo& plant) {
  std::vector<std::string> texts(plant.outputs.size());
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double lower = k < setpoint.lower.size() ? setpoint.lower[k] : -kInfinity;
    const double upper = k < setpoint.upper.size() ? setpoint.upper[k] : kInfinity;
    if (std::isfinite(lower) || std::isfinite(upper))
      texts[i] = "a setpoint of " + plant.outputs[i].name + " was asked beyond its limits, " +
                 rangeText(lower, upper, plant.outputs[i].unit) + ", and clamped";
  }
  return texts;
}

}  // namespace

ControllerSession::ControllerSession(std::unique_ptr<Controller> controller,
                                     SetpointParams setpoint, InputLimits limits,
                                     Vector initial_input, PlantInfo plant, double max_pole,
                                     PlausibilityParams plausibility)
    : controller_(std::move(controller)),
      setpoint_texts_(setpointTexts(setpoint, plant)),
      setpoint_(std::move(setpoint), plant, clockOf(plant)),
      limits_(std::move(limits)),
      plant_(std::move(plant)),
      last_input_(std::move(initial_input)),
      transfer_(countOf(plant_.inputs)),
      moves_(limits_),
      plausibility_(std::move(plausibility), plant_),
      recent_(plant_),
      max_pole_(max_pole) {
  require(controller_ != nullptr, "controller", "a controller");
  answer_.events.reserve(Notices::kMost);
  const auto n_u = static_cast<Eigen::Index>(plant_.inputs.size());
  limits_.validate(n_u);
  require(last_input_.size() == n_u && last_input_.allFinite(), "actuator.initial",
          std::to_string(n_u) + " finite numbers");
  manual_texts_.resize(plant_.inputs.size());
  manual_input_ = last_input_;
  seen_.outputs = Vector::Zero(countOf(plant_.outputs));
  seen_.disturbances = Vector::Zero(countOf(plant_.disturbances));
  seen_.input_applied = answer_.base.input = last_input_;
  noteNeeds();
}

ControllerSession::ControllerSession(ControllerSession&&) noexcept = default;
ControllerSession::~ControllerSession() = default;

// What is in no model of a law with a model cannot move its input.
void ControllerSession::noteNeeds() {
  const std::size_t n_y = plant_.outputs.size();
  for (std::size_t i = 0; i < n_y + plant_.disturbances.size(); ++i) {
    const SignalKind kind = i < n_y ? SignalKind::kOutput : SignalKind::kDisturbance;
    const auto index = static_cast<Eigen::Index>(i < n_y ? i : i - n_y);
    const bool in_model = kind == SignalKind::kOutput || models_ == 0 ||
                          !controller_->needsModel() || isIn(model_, kind, index);
    const auto& needs = plausibility_.params().needs;
    plausibility_.need(i, in_model && (needs.empty() || needs[i]));
  }
}

bool ControllerSession::ready() const { return models_ > 0 || !controller_->needsModel(); }

bool ControllerSession::sizesFit(const Measurement& m) const {
  return static_cast<std::size_t>(m.outputs.size()) == plant_.outputs.size() &&
         static_cast<std::size_t>(m.disturbances.size()) == plant_.disturbances.size() &&
         static_cast<std::size_t>(m.input_applied.size()) == plant_.inputs.size();
}

Receipt ControllerSession::receive(const Measurement& measurement) {
  if (!sizesFit(measurement)) {
    gate_.countWrongSize();
    return Receipt::kDropped;
  }
  if (!ready()) return Receipt::kNotReady;
  const StepHeader before = gate_.last();
  const Arrival arrival = gate_.pass(measurement.header);
  const bool again = arrival == Arrival::kRepeat;
  // A sample that was called the last one, and is not, is answered when it comes again.
  if (again && (answer_.has_action || measurement.final)) return Receipt::kRepeated;
  if (!again && !isNew(arrival)) return Receipt::kDropped;
  begin(measurement, again ? Arrival::kResync : arrival, before);
  process(measurement);
  return Receipt::kAnswered;
}

// What a sample brings whatever its values are: identity, setpoints, and why memory may be invalid.
void ControllerSession::begin(const Measurement& m, Arrival arrival, const StepHeader& before) {
  const std::uint32_t step = m.header.step;
  arrival_ = arrival;
  if (arrival == Arrival::kFirst) arrival_reason_ = "first sample is " + std::to_string(step);
  if (arrival == Arrival::kNewRun) arrival_reason_ = "new run";
  if (arrival == Arrival::kGap) arrival_reason_ = missingSamples(before.step + 1, step - 1);
  if (arrival == Arrival::kResync)
    arrival_reason_ = "back to sample " + std::to_string(step) + ", where the plant is";
  if (arrival == Arrival::kNewRun) beginAnew();
  if (arrival != Arrival::kNext) begins_ = step == 0;
  if (arrival == Arrival::kFirst || arrival == Arrival::kNewRun) {
    setpoint_.anchor(m.header);
    const Eigen::Index n_y = countOf(plant_.outputs);
    answer_.tracking.reference.setConstant(n_y, std::nan(""));  // till a law acts
  }

  answer_.base.header = answer_.tracking.header = m.header;
  answer_.has_action = !m.final;
  answer_.has_prediction = false;
  answer_.tracking.setpoint = setpoint_.advance(step);
  if (targets_.outputs.size() > 0)
    answer_.tracking.setpoint = setpoint_.aim(targets_.outputs, targets_.inputs);
  if (!controller_->followsSetpoint()) answer_.tracking.setpoint.setConstant(std::nan(""));
  answer_.effects = setpoint_.effects();
  for (CommandEffect& effect : answer_.effects) effect.header = m.header;
  reset_reason_.clear();
}

void ControllerSession::aim(const Targets& targets) {
  const auto n_y = countOf(plant_.outputs);
  if (targets.outputs.size() != n_y || targets.inputs.size() != countOf(plant_.inputs) ||
      targets.output_lower.size() != n_y || targets.output_upper.size() != n_y)
    return;
  targets_ = targets;
}

void ControllerSession::process(const Measurement& m) {
  fell_back_ = false;
  output_.events.clear();
  if (needsReset(arrival_)) forgetSamples();
  lookAtMoves(m);
  const Verdict verdict =
      plausibility_.look(m, [&](Eigen::Ref<Vector> outputs) { return foresee(m, outputs); });
  const Measurement& accepted = verdict == Verdict::kClean ? m : plausibility_.accepted();
  const bool usable = m.input_applied.allFinite() && verdict <= Verdict::kRepaired;
  const bool finite = allFinite(m);
  if (!finite) gate_.countNotFinite();
  if (usable)
    keep(accepted);
  else
    interrupt();
  if (unreleased_) {
    hold(m, {EventCode::kOperatorUnknown});
    interruption_ = "released";
  } else if (manual_ && m.input_applied.allFinite()) {
    sendManual(accepted);
    interruption_ = "back from manual";
  } else if (!takes_actions_) {
    hold(m, {EventCode::kPlantLocal});
    interruption_ = "the plant takes actions again";
  } else if (!m.input_applied.allFinite()) {
    hold(m, {EventCode::kSignalMissing, "the applied input is not finite: input held"});
    interruption_ = kNotFinite;
  } else if (verdict == Verdict::kFallback) {
    fallBack(m, plausibility_.notice());
    interruption_ = kDoubted;
  } else if (!usable) {
    hold(m, plausibility_.notice());
    interruption_ = finite ? kDoubted : kNotFinite;
  } else {
    runLaw(seen(accepted));
    if (verdict == Verdict::kRepaired) output_.events.add(plausibility_.notice());
  }
  if (interruption_ != nullptr && usable) controller_->lookOn(accepted);
  if (tap_) endTest();
  gatherEvents();
  answered();
}

void ControllerSession::forgetSamples() {
  plausibility_.reset();
  recent_.reset();
  if (reaction_) reaction_->reset();
}

/// An accepted sample; only who has a model is asked for its past.
void ControllerSession::keep(const Measurement& accepted) {
  present_ = accepted;
  if (models_ > 0) recent_.add(accepted);
  watchReaction(accepted);
}

void ControllerSession::interrupt() {
  recent_.reset();
  if (reaction_) reaction_->interrupt();
}

/// What a law expects that has run up to now, in case the sample is not accepted.
bool ControllerSession::foresee(const Measurement& m, Eigen::Ref<Vector> outputs) {
  return interruption_ == nullptr && arrival_reason_.empty() && m.input_applied.allFinite() &&
         controller_->foresee(seen(m), outputs);
}

Notice ControllerSession::reaction() const { return reaction_ ? reaction_->notice() : Notice(); }

/// What is said of this sample; nothing of the final one, which has no action.
void ControllerSession::gatherEvents() {
  if (!answer_.has_action) return written_.write({}, 0, answer_.events);
  Notices& said = output_.events;
  if (const EventCode code = std::exchange(model_event_, EventCode::kNone);
      code != EventCode::kNone)
    said.add({code, model_text_.c_str()});
  if (const Notice away = reaction(); away.code != EventCode::kNone && !said.has(away.code))
    said.add(away);
  for (std::size_t i = 0; i < manual_texts_.size(); ++i)
    if (manual_ && !manual_texts_[i].empty())
      said.add({EventCode::kInputClamped, manual_texts_[i].c_str(), plant_.inputs[i].name.c_str()});
  for (std::size_t i = 0; controller_->followsSetpoint() && i < setpoint_texts_.size(); ++i)
    if (!setpoint_texts_[i].empty() && setpoint_.isClamped(static_cast<Eigen::Index>(i)))
      said.add({EventCode::kSetpointClamped, setpoint_texts_[i].c_str(),
                plant_.outputs[i].name.c_str()});
  written_.write(said, answer_.tracking.header.step, answer_.events);
}

void ControllerSession::withoutSetpoint(const std::vector<Eigen::Index>& outputs) {
  for (const Eigen::Index i : outputs) setpoint_texts_[static_cast<std::size_t>(i)].clear();
}

void ControllerSession::watchReaction(const Measurement& m) {
  if (reaction_) reaction_->look(m);
}

void ControllerSession::runLaw(const Measurement& m) {
  const bool restarts = interruption_ != nullptr || !arrival_reason_.empty();
  const Measurement& of_law = restarts ? withoutTest(m) : m;
  const bool begins = std::exchange(begins_, false) && !other_hand_;
  if (restarts) {
    reset_reason_ = arrival_reason_;
    if (interruption_ != nullptr) {
      if (!reset_reason_.empty()) reset_reason_ += "; ";
      reset_reason_ += interruption_;
    }
    Measurement start = of_law;
    if (begins) start.header.step = 0;
    controller_->reset(start);
    transfer_.reset(other_hand_ || transfer_.active());
    other_hand_ = false;
    interruption_ = nullptr;
    arrival_reason_.clear();
  }
  if (std::exchange(gains_due_, false)) lookAtGains(m);
  output_.begin();
  controller_->step(of_law, setpoint_, output_);
  const bool refers = output_.reference.size() == m.outputs.size();
  answer_.tracking.reference = refers ? output_.reference : answer_.tracking.setpoint;
  if (!output_.ok) return hold(m, {});
  if (output_.input.size() != m.input_applied.size() || !output_.input.allFinite())
    return hold(m, {EventCode::kLawFailed});
  answer_.base.input = output_.input;
  handOver(of_law);
  limit(m);
  if (tap_) passToTest(m);
  answer_.base.source = output_.source;
  answer_.has_prediction = output_.predictive && !m.final;
  if (!answer_.has_prediction) return;
  answer_.prediction = output_.prediction;
  answer_.prediction.header = m.header;
  answer_.prediction.output_lower = targets_.output_lower;
  answer_.prediction.output_upper = targets_.output_upper;
}

/// Of the first model, at the first sample.
void ControllerSession::lookAtGains(const Measurement& m) {
  const std::string weak = weakDirection(model_, m);
  if (weak.empty()) return;
  model_text_ = weak;
  model_event_ = EventCode::kWeakDirection;
}

void ControllerSession::setModel(const TsModel& model) {
  const bool matters = controller_->needsModel() && !model.submodels.empty();
  TsModel matched = matters ? matchToPlant(model, plant_) : TsModel();
  if (models_ > 0 && matters && present_.outputs.size() > 0) {
    requireStable(matched, present_, max_pole_);
    const auto turned = turnedGains(model_, matched, present_);
    if (plausibility_.params().gain_sign && !turned.empty()) {
      requireFewTurned(turned, matched);
      requireForeseen(turned, matched, recent_.errorsOf(model_), recent_.errorsOf(matched));
    }
    model_text_ = wordsOf(turned, matched);
    model_event_ = model_text_.empty() ? EventCode::kNone : EventCode::kModelGainTurned;
  }
  controller_->setModel(model);
  model_ = std::move(matched);
  gains_due_ = matters && models_ == 0;
  const int window = plausibility_.params().reaction_samples;
  if (matters && window > 0) reaction_ = std::make_unique<ActuatorEffectiveness>(model_, window);
  ++models_;
  noteNeeds();
}

}  // namespace fpc
