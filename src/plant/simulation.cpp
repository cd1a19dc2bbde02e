// Timing of one sample k: commands due at k come into force; measurement k shows y(k), d(k),
// u(k-1); then u(k) passes the actuator, its faults and the plant's local loop, and the plant moves
// over [t_k, t_k + Ts) with u(k) and d(k) held.
#include "plant/simulation.hpp"

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "plant/quantity_index.hpp"

namespace fpc {
namespace {

/// Disturbances inside their ranges; inputs (clamped, and said) and outputs of any size.
std::vector<SignalInfo> signalsForCommands(const SimulationParams& params,
                                           const PlantDescription& description) {
  std::vector<SignalInfo> signals;
  for (const auto& q : description.disturbances)
    signals.push_back({q.name, q.unit, q.lower, q.upper});
  for (const auto& q : description.inputs)
    signals.push_back({"input/" + q.name, "", -kInfinity, kInfinity});
  for (const auto& name : params.outputs)
    signals.push_back({"output/" + name, "", -kInfinity, kInfinity});
  return signals;
}

/// Why the state after a stepper's step is not to be used; empty if it is.
std::string troubleOf(const PlantStepper& stepper, const Vector& state) {
  if (!state.allFinite()) return "the state is not finite";
  return stepper.failure();
}

constexpr std::uint64_t kDisturbanceStream = 1;  // of the noise's seed

bool justSet(const std::vector<CommandEffect>& effects, const std::string& name) {
  for (const CommandEffect& effect : effects)
    if (std::find(effect.command.name.begin(), effect.command.name.end(), name) !=
        effect.command.name.end())
      return true;
  return false;
}

/// Where a valve is without its offset; at a bound, where the offset has no room, it may be nearer
/// to what is asked.
double withoutOffset(double applied, double offset, double lower, double upper, double asked) {
  double from = applied - offset, to = from;
  if (offset > 0.0 && applied >= upper) to = upper;
  if (offset < 0.0 && applied <= lower) from = lower;
  return std::clamp(std::isfinite(asked) ? asked : applied, from, to);
}

/// A valve with an offset moves from its own position: from the displaced one the offset would add
/// up whenever it is larger than the move limit.
void takeBackOffsets(const CommandTable& commands, const std::vector<CommandEffect>& effects,
                     std::size_t first, VectorRef asked, Actuator& actuator) {
  const InputLimits& limits = actuator.params().limits;
  for (Eigen::Index i = 0; i < actuator.applied().size() && i < asked.size(); ++i) {
    const std::size_t name = first + static_cast<std::size_t>(i);
    const ActiveCommand& entry = commands.active()[name];
    if (!entry.active || entry.mode != CommandMode::kOffset) continue;
    if (justSet(effects, commands.names()[name])) continue;  // it has not acted yet
    actuator.disturb(i, withoutOffset(actuator.applied()[i], entry.value, limits.lower[i],
                                      limits.upper[i], asked[i]));
  }
}

}  // namespace

Simulation::Simulation(SimulationParams params)
    : params_(std::move(params)),
      plant_(makePlant(params_)),
      clock_(params_.sample_time_s, params_.start_time_s),
      actuator_((params_ = checked(std::move(params_), *plant_)).actuator),
      integrator_(*plant_, params_.integrator),
      instruments_(params_.instruments, params_.actuator.drives, params_.outputs,
                   params_.measured_disturbances, params_.sample_time_s),
      stepper_(plant_->makeStepper(instruments_.stepSeconds())),
      commands_(signalsForCommands(params_, plant_->description())),
      info_(makePlantInfo(params_, plant_->description())) {
  const PlantDescription& plant = plant_->description();
  require(instruments_.steps() == 1 || !stepper_ || stepper_->divisible(), "sensors.step_s",
          "the sample time: plant " + plant.name + " moves from sample to sample only");
  const auto n_x = static_cast<Eigen::Index>(plant.states.size());
  for (const auto& name : params_.outputs) {
    const Eigen::Index state = indexOf(plant.states, name);
    output_index_.push_back(state < n_x ? state : n_x + indexOf(plant.algebraic, name));
  }
  algebraic_ = Vector::Zero(static_cast<Eigen::Index>(plant.algebraic.size()));
  for (const auto& name : params_.measured_disturbances)
    measured_disturbance_.push_back(indexOf(plant.disturbances, name));
  for (const double seconds : params_.output_delay_s)
    delays_.emplace_back(seconds / params_.sample_time_s);
  const auto n_y = static_cast<Eigen::Index>(params_.outputs.size());
  measurement_.outputs.resize(n_y);
  measurement_.disturbances.resize(static_cast<Eigen::Index>(measured_disturbance_.size()));
  state_.outputs.resize(n_y);
  true_outputs_.resize(n_y);
  true_measured_.resize(measurement_.disturbances.size());
  state_.disturbances = scheduled_ = params_.disturbance_nominal;
  reset(1);
}

const Measurement& Simulation::reset(std::uint64_t run_id) {
  info_.header = clock_.header(run_id, 0);
  measurement_.header = info_.header;
  state_.state = params_.initial_state;
  state_before_ = params_.initial_state;
  state_.actuator_clips = 0;
  state_.input_missing = false;
  state_.trouble.clear();
  failure_.clear();
  actuator_.reset();
  if (stepper_) stepper_->reset(params_.actuator.initial, params_.disturbance_nominal);
  noise_.seed(params_.noise_seed);
  disturbance_noise_ = seededEngine(params_.noise_seed, {kDisturbanceStream});
  trouble_.clear();
  held_input_ = params_.actuator.initial;
  disturbance_error_ = Vector::Zero(params_.disturbance_nominal.size());
  schedule();
  startInstruments();
  for (std::size_t i = 0; i < delays_.size(); ++i) delays_[i].reset(outputOf(i));
  measure();
  return measurement_;
}

void Simulation::schedule() {
  commands_.clear();
  for (std::size_t i = 0; i < params_.disturbance_commands.size(); ++i) {
    const auto& [time_h, command] = params_.disturbance_commands[i];
    try {
      commands_.accept(command, clock_.firstStepAtHours(time_h));
    } catch (const InputError& e) {
      const std::string words = e.what();
      if (words.rfind("value of ", 0) != 0) throw;
      throw InputError("disturbance.commands[" + std::to_string(i) + "].value" +
                       words.substr(words.find(':')));
    }
  }
}

bool Simulation::answers(const StepHeader& header) const {
  return !measurement_.final && header.run_id == measurement_.header.run_id &&
         header.step == measurement_.header.step;
}

const Measurement& Simulation::advance(VectorRef input) {
  if (measurement_.final) return measurement_;
  takeBackOffsets(commands_, effects_, plant_->description().disturbances.size(), input, actuator_);
  actuator_.apply(input);
  return integrate();
}

const Measurement& Simulation::advanceWithoutAction() {
  if (measurement_.final) return measurement_;
  takeBackOffsets(commands_, effects_, plant_->description().disturbances.size(),
                  actuator_.applied(), actuator_);
  actuator_.miss();
  return integrate();
}

const Measurement& Simulation::integrate() {
  const std::size_t first = plant_->description().disturbances.size();
  for (Eigen::Index i = 0; i < actuator_.applied().size(); ++i) {
    const std::size_t name = first + static_cast<std::size_t>(i);
    if (commands_.active()[name].active)
      actuator_.disturb(i, commands_.apply(name, actuator_.applied()[i]));
  }
  const std::uint32_t step = measurement_.header.step;
  passLocalLoop();
  movePlant();
  measurement_.header = clock_.header(measurement_.header.run_id, step + 1);
  state_.actuator_clips = actuator_.clips();
  state_.input_missing = actuator_.missing();
  measure();
  return measurement_;
}

// The actuator's limits bound what is applied; what the local loop adds is bounded by what the
// plant can take at all.
void Simulation::passLocalLoop() {
  plant_input_ = actuator_.applied();
  plant_->localLoop(state_.state, state_before_, plant_input_);
  state_before_ = state_.state;
  const auto& ranges = plant_->description().inputs;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    double& input = plant_input_[static_cast<Eigen::Index>(i)];
    input = std::clamp(input, ranges[i].lower, ranges[i].upper);
  }
}

// A plant that cannot be moved is held, and the sample says why.
void Simulation::movePlant() {
  const Vector& d = state_.disturbances;
  state_.trouble.clear();
  std::string& reason = failure_;
  reason.clear();
  for (int i = 0; i < instruments_.steps() && reason.empty(); ++i) {
    const Vector& u = held_input_ = instruments_.drive(plant_input_);
    if (stepper_) {
      stepper_->advance(state_.state, u, d);
      reason = troubleOf(*stepper_, state_.state);
    } else {
      reason = integrator_.advance(state_.state, u, d, instruments_.stepSeconds()).reason;
    }
    if (!reason.empty()) state_.state = state_before_;
    lookAtPlant();
    instruments_.advance(true_outputs_, true_measured_);
  }
  if (reason.empty()) return;
  state_.trouble = "sample " + std::to_string(measurement_.header.step) + ": " + reason;
  trouble_ = state_.trouble;
}

double Simulation::outputOf(std::size_t i) const {
  const Eigen::Index n_x = state_.state.size(), at = output_index_[i];
  return at < n_x ? state_.state[at] : algebraic_[at - n_x];
}

void Simulation::lookAtPlant() {
  if (algebraic_.size() > 0)
    plant_->algebraic(state_.state, held_input_, state_.disturbances, algebraic_);
  for (std::size_t i = 0; i < output_index_.size(); ++i)
    true_outputs_[static_cast<Eigen::Index>(i)] = outputOf(i);
  for (std::size_t i = 0; i < measured_disturbance_.size(); ++i)
    true_measured_[static_cast<Eigen::Index>(i)] = state_.disturbances[measured_disturbance_[i]];
}

// The plant has rested at its first sample, commands of the file that act from there on included.
void Simulation::startInstruments() {
  updateDisturbances();
  lookAtPlant();
  instruments_.reset(true_outputs_, true_measured_, params_.actuator.initial);
}

void Simulation::updateDisturbances() {
  const auto& ranges = plant_->description().disturbances;
  const Matrix& record = params_.disturbance.values;
  const auto step = static_cast<Eigen::Index>(measurement_.header.step);
  for (Eigen::Index i = 0; i < state_.disturbances.size(); ++i) {
    const auto name = static_cast<std::size_t>(i);
    if (record.size() > 0) scheduled_[i] = record(i, std::min(step, record.cols() - 1));
    state_.disturbances[i] =
        std::clamp(commands_.apply(name, scheduled_[i]) + disturbance_error_[i], ranges[name].lower,
                   ranges[name].upper);
  }
}

void Simulation::measure() {
  effects_.clear();
  for (const auto& command : commands_.advance(measurement_.header.step))
    effects_.push_back({measurement_.header, command});
  for (Eigen::Index i = 0; i < disturbance_error_.size(); ++i)
    if (params_.disturbance_noise_std[i] > 0.0)
      disturbance_error_[i] = params_.disturbance_noise_std[i] * standardNormal(disturbance_noise_);
  updateDisturbances();
  lookAtPlant();
  measurement_.disturbances = true_measured_;
  instruments_.read(true_outputs_, measurement_.disturbances);
  const std::size_t first_output = commands_.names().size() - output_index_.size();
  for (std::size_t i = 0; i < output_index_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const bool sensed = instruments_.hasSensor(row);
    const double shown = delays_[i].pass(true_outputs_[row]);
    state_.outputs[row] = sensed ? outputOf(i) : shown;
    const double noise = params_.noise_std[row] * standardNormal(noise_);
    measurement_.outputs[row] = commands_.apply(first_output + i, shown + noise);
  }
  instruments_.lose(measurement_.outputs, measurement_.disturbances);
  measurement_.input_applied = actuator_.applied();
  measurement_.final = params_.samples > 0 && measurement_.header.step == params_.samples;
  state_.header = measurement_.header;
  gatherEvents();
}

/// What people ask of the plant that it cannot do: of an input an override beyond the actuator's
/// limits, or an offset wider than they are apart (one that an offset leads beyond them from where
/// it is told to be is no slip); of a disturbance an offset out of its range.
void Simulation::gatherEvents() {
  events_.clear();
  const auto say = [&](EventCode code, const std::string& signal, const std::string& text) {
    events_.push_back(eventOf({code, text.c_str(), signal.c_str()}, measurement_.header.step));
  };
  if (!failure_.empty()) say(EventCode::kPlantFailed, "", failure_);
  const std::vector<Quantity>& ranges = plant_->description().disturbances;
  const std::vector<ActiveCommand>& active = commands_.active();
  for (std::size_t i = 0; i < info_.inputs.size(); ++i) {
    const ActiveCommand& asked = active[ranges.size() + i];
    const SignalInfo& of = info_.inputs[i];
    const bool offset = asked.mode == CommandMode::kOffset;
    const bool fits = offset ? std::abs(asked.value) <= of.upper - of.lower
                             : asked.value >= of.lower && asked.value <= of.upper;
    const std::string& name = commands_.names()[ranges.size() + i];
    if (asked.active && !fits)
      say(EventCode::kInputClamped, name,
          name + " was asked to be " + (offset ? "off by " : "") + exactText(asked.value) +
              (offset ? ", more than its limits are apart, " : ", beyond its limits, ") +
              rangeText(of.lower, of.upper, of.unit) + ", and clamped");
  }
  for (std::size_t i = 0; i < ranges.size() && !measurement_.final; ++i) {
    const Quantity& of = ranges[i];
    const double asked = scheduled_[static_cast<Eigen::Index>(i)] + active[i].value;
    const bool offset = active[i].active && active[i].mode == CommandMode::kOffset;
    if (offset && (asked < of.lower || asked > of.upper))
      say(EventCode::kDisturbanceClamped, of.name,
          "an offset of " + of.name + " was asked beyond its range, " +
              rangeText(of.lower, of.upper, of.unit) + ", and clamped");
  }
}

std::uint32_t Simulation::command(const Command& command) {
  const std::uint32_t next = measurement_.header.step + 1;
  const std::uint32_t step =
      command.time_ns == 0 ? next : std::max(next, clock_.firstStepAt(command.time_ns));
  commands_.accept(command, step);
  return step;
}

void Simulation::setOutputDelay(std::size_t output, double seconds) {
  require(measurement_.header.step == 0, "output delay",
          "to be set before the first sample is answered");
  require(output < delays_.size(), "output delay", "an output of the plant");
  TransportDelay delay(seconds / params_.sample_time_s);
  delay.reset(outputOf(output));
  delay.pass(outputOf(output));
  delays_[output] = std::move(delay);
  params_.output_delay_s[output] = seconds;
}

}  // namespace fpc
