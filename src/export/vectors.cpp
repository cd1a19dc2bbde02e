#include "export/vectors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <random>

#include "base/number.hpp"
#include "export/block.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "runtime/factory.hpp"

namespace fpc {
namespace block_vectors {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

/// Of the optimizer: how many it tries depends on its path, and the block's is another.
constexpr int kEnoughSets = 10000;

/// What is given to the block at one sample.
struct BlockCase {
  bool enable{true}, reset{false}, track{true};
  int mode{2};
  double sample_time{0.0};
  Vector setpoint, cascade, manual, actuator, lower, upper;
  Vector values;  ///< outputs, then disturbances
  std::vector<bool> good;
};

/// A plant for a loop whose own is somewhere else: lags towards a mixture of the inputs.
class StandIn {
 public:
  explicit StandIn(const LoopFile& loop)
      : info_(loop.plant_info), input_(loop.simulation.actuator.initial) {
    outputs_ = loop.setpoint.initial;
    nominal_ = loop.disturbance_nominal;
  }
  Vector outputs() const { return outputs_; }
  Vector disturbances() const { return nominal_; }
  const Vector& input() const { return input_; }
  void advance(const Vector& input) {
    input_ = input;
    double share = 0.0;
    for (std::size_t j = 0; j < info_.inputs.size(); ++j) {
      const SignalInfo& u = info_.inputs[j];
      share += (input[static_cast<Eigen::Index>(j)] - u.lower) / (u.upper - u.lower) /
               static_cast<double>(info_.inputs.size());
    }
    for (std::size_t i = 0; i < info_.outputs.size(); ++i) {
      const SignalInfo& y = info_.outputs[i];
      double& at = outputs_[static_cast<Eigen::Index>(i)];
      at += 0.05 * (y.lower + (1.0 - share) * (y.upper - y.lower) - at);
    }
  }

 private:
  PlantInfo info_;
  Vector outputs_, nominal_, input_;
};

/// What happens: a fixed course first, then by chance.
class Scenario {
 public:
  Scenario(const LoopFile& loop, std::uint64_t seed) : loop_(loop), random_(seed) {
    low_ = high_ = loop.setpoint.initial;
    for (const SetpointStep& step : loop.setpoint.schedule)
      for (Eigen::Index i = 0; i < low_.size(); ++i) {
        if (std::isnan(step.value[i])) continue;
        low_[i] = std::min(low_[i], step.value[i]);
        high_[i] = std::max(high_[i], step.value[i]);
      }
    setpoint_ = cascade_ = loop.setpoint.initial;
    manual_ = loop.simulation.actuator.initial;
    offset_ = Vector::Zero(manual_.size());
  }

  void play(int k, BlockCase& now) {
    if (left_ > 0) --left_;
    if (k < 120)
      course(k);
    else if (left_ == 0)
      chance();
    if (k % 40 == 5) newSetpoint();
    fill(now);
    if (reset_) reset_ = false;
  }

 private:
  enum class Event {
    kNone,
    kManual,
    kOff,
    kDisabled,
    kCascade,
    kBadValue,
    kBadFlag,
    kWild,
    kBadActuator,
    kNoTrack,
    kOffset,
    kStuck,
    kSampleTime,
    kLimits,
    kBadSetpoint,
    kBadManual,
    kSetpointFar
  };

  double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(random_); }

  void begin(Event event, int samples) {
    event_ = event;
    left_ = samples;
    which_ = uniform();
    if (event == Event::kManual || event == Event::kBadManual)
      for (Eigen::Index i = 0; i < manual_.size(); ++i) manual_[i] = inside(i, uniform());
    for (Eigen::Index i = 0; i < offset_.size(); ++i)
      offset_[i] = (uniform() - 0.5) * 0.02 * (inside(i, 1.0) - inside(i, 0.0));
    if (event == Event::kCascade) cascade_ = drawn();
  }

  void course(int k) {
    switch (k) {
      case 10:
        return begin(Event::kManual, 8);
      case 18:
        return begin(Event::kNone, 10);
      case 28:
        return begin(Event::kBadValue, 2);
      case 30:
        return begin(Event::kNone, 5);
      case 35:
        return begin(Event::kBadFlag, 6);
      case 41:
        return begin(Event::kNone, 4);
      case 45:
        return begin(Event::kOff, 5);
      case 50:
        return begin(Event::kCascade, 10);
      case 60:
        return begin(Event::kBadActuator, 1);
      case 61:
        return begin(Event::kNone, 4);
      case 65:
        reset_ = true;
        return begin(Event::kNone, 5);
      case 70:
        return begin(Event::kSampleTime, 2);
      case 72:
        return begin(Event::kNone, 3);
      case 75:
        return begin(Event::kLimits, 2);
      case 77:
        return begin(Event::kNone, 3);
      case 80:
        return begin(Event::kSetpointFar, 15);
      case 95:
        return begin(Event::kNoTrack, 10);
      case 105:
        return begin(Event::kOffset, 10);
      case 115:
        return begin(Event::kNone, 5);
      default:
        return;
    }
  }

  void chance() {
    const double what = uniform();
    if (event_ != Event::kNone || what < 0.4)
      return begin(Event::kNone, 5 + static_cast<int>(60.0 * uniform()));
    const auto events = static_cast<double>(static_cast<int>(Event::kSetpointFar));
    const auto event = static_cast<Event>(1 + static_cast<int>(uniform() * events * 0.999999));
    reset_ = uniform() < 0.05;
    begin(event, 1 + static_cast<int>(14.0 * uniform()));
  }

  double inside(Eigen::Index i, double share) const {
    const auto& limits = loop_.simulation.actuator.limits;
    return limits.lower[i] + share * (limits.upper[i] - limits.lower[i]);
  }

  Vector drawn() {
    Vector to = low_;
    for (Eigen::Index i = 0; i < to.size(); ++i) to[i] += uniform() * (high_[i] - low_[i]);
    return to;
  }

  void newSetpoint() { setpoint_ = drawn(); }

  void fill(BlockCase& now) {
    now.setpoint = setpoint_;
    now.cascade = cascade_;
    now.manual = manual_;
    now.reset = reset_;
    const auto signal =
        static_cast<Eigen::Index>(which_ * static_cast<double>(now.values.size()) * 0.999999);
    const bool finite_ranges = loop_.plausibility.enabled;
    switch (event_) {
      case Event::kManual:
        now.mode = 1;
        break;
      case Event::kOff:
        now.mode = 0;
        break;
      case Event::kDisabled:
        now.enable = false;
        break;
      case Event::kCascade:
        now.mode = 3;
        break;
      case Event::kBadValue:
        now.values[signal] = kNoNumber;
        break;
      case Event::kBadFlag:
        now.good[static_cast<std::size_t>(signal)] = false;
        break;
      case Event::kWild:
        if (finite_ranges) now.values[signal] *= 1.0 + 6.0 * (which_ - 0.5);
        break;
      case Event::kBadActuator:
        now.actuator[0] = kNoNumber;
        break;
      case Event::kNoTrack:
        now.track = false;
        break;
      case Event::kOffset:
        now.actuator += offset_;
        break;
      case Event::kStuck:
        if (stuck_.size() == 0) stuck_ = now.actuator;
        now.actuator = stuck_;
        break;
      case Event::kSampleTime:
        now.sample_time = 1.5 * loop_.plant_info.sample_time_s;
        break;
      case Event::kLimits:
        now.lower[0] = now.upper[0] + 1.0;
        break;
      case Event::kBadSetpoint:
        now.setpoint[0] = kNoNumber;
        break;
      case Event::kBadManual:
        now.mode = 1;
        if (which_ < 0.5) now.manual[0] = kNoNumber;
        break;
      case Event::kSetpointFar:
        for (Eigen::Index i = 0; i < now.setpoint.size(); ++i) {
          const SignalInfo& y = loop_.plant_info.outputs[static_cast<std::size_t>(i)];
          if (std::isfinite(y.upper) && std::isfinite(y.lower))
            now.setpoint[i] = which_ < 0.5 ? y.lower : y.upper;
        }
        break;
      case Event::kNone:
        break;
    }
    if (event_ != Event::kStuck) stuck_.resize(0);
  }

  const LoopFile& loop_;
  std::mt19937_64 random_;
  Vector low_, high_, setpoint_, cascade_, manual_, offset_, stuck_;
  Event event_{Event::kNone};
  int left_{0};
  double which_{0.0};
  bool reset_{false};
};

}  // namespace block_vectors

using block_vectors::BlockCase;
using block_vectors::kEnoughSets;
using block_vectors::kNoNumber;

struct BlockVectors::Run {
  Run(const LoopFile& given, const ir::Program& program, std::uint64_t seed, int samples)
      : loop(given), scenario(loop, seed) {
    loop.clp.qp.max_iterations = kEnoughSets;
    loop.setpoint.schedule.clear();
    loop.setpoint.commands.clear();
    // A record may be at another place, or too short: disturbances go to and fro instead.
    if (loop.disturbance.source == DisturbanceSource::kCsv)
      loop.disturbance.source = DisturbanceSource::kConstant;
    // The block leaves readings that stand still or come twice to the PLC, and a plant that is held
    // shows the same again.
    for (auto* group : {&loop.plausibility.outputs, &loop.plausibility.disturbances})
      for (SignalPlausibility& signal : *group) signal.frozen = signal.repeated = false;
    loop.simulation.samples = static_cast<std::uint32_t>(samples) + 1;
    asked = loop.setpoint.initial;
    last = loop.simulation.actuator.initial;
    if (loop.external_plant)
      stand_in.emplace(loop);
    else
      simulation.emplace(makeSimulation(loop));
    for (const ir::Variable& v : program.variables())
      if (v.role == ir::Role::kInput) {
        inputs.push_back(v.name);
        defaults.push_back(v.initial[0]);
      }
    for (const SignalInfo& s : loop.plant_info.inputs)
      outputs.push_back("rOut_" + plainName(s.name));
    for (const SignalInfo& s : loop.plant_info.outputs)
      outputs.push_back("rActive_" + plainName(s.name));
    for (const char* name : {"iSource", "iState", "iErrors"}) outputs.emplace_back(name);
    begin();
  }

  void begin() {
    session.emplace(makeControllerSession(loop));
    if (loop.has_clp) optimizer.emplace(makeOptimizerSession(loop));
    if (loop.has_model && loop.controllerType().needs_model) session->setModel(loop.model);
  }

  void measure(BlockCase& now) {
    const Eigen::Index n_y = countOf(loop.plant_info.outputs),
                       n_d = countOf(loop.plant_info.disturbances);
    now.values.resize(n_y + n_d);
    now.values << (stand_in ? stand_in->outputs() : simulation->measurement().outputs),
        (stand_in ? stand_in->disturbances() : simulation->measurement().disturbances);
    for (Eigen::Index i = 0; i < n_d; ++i)
      now.values[n_y + i] *= 1.0 + 0.1 * std::sin(0.1 * k * static_cast<double>(i + 1));
    now.actuator = stand_in ? stand_in->input() : simulation->measurement().input_applied;
    now.good.assign(static_cast<std::size_t>(n_y + n_d), true);
    now.lower = loop.simulation.actuator.limits.lower;
    now.upper = loop.simulation.actuator.limits.upper;
  }

  /// What the session makes of a case, by the block's rules of who has the input.
  void answer(const BlockCase& now) {
    if (now.reset) {
      begin();
      asked = loop.setpoint.initial;
      last = loop.simulation.actuator.initial;
    }
    const bool limits_ok = (now.lower.array() <= now.upper.array()).all();
    const double ts = loop.plant_info.sample_time_s;
    const bool time_ok = now.sample_time == 0.0 || std::abs(now.sample_time / ts - 1.0) <= 0.1;
    const bool manual = now.enable && now.mode == 1 && limits_ok;
    const bool takes = manual || (now.enable && now.mode >= 2 && limits_ok && time_ok);
    int errors = (limits_ok ? 0 : kLimitsInconsistent) + (time_ok ? 0 : kSampleTimeOff);
    const Vector& wish = now.mode == 3 ? now.cascade : now.setpoint;
    Command command{0, {}, {}, CommandMode::kOverride};
    for (Eigen::Index i = 0; i < wish.size(); ++i) {
      if (std::isfinite(wish[i])) asked[i] = wish[i];
      command.name.push_back(loop.plant_info.outputs[static_cast<std::size_t>(i)].name);
      command.value.push_back(asked[i]);
    }
    if (!wish.allFinite()) errors += kSetpointBad;
    session->command(command);
    session->manual(manual);
    if (manual && now.manual.allFinite()) session->manualInput(now.manual);
    if (manual && !now.manual.allFinite() && (errors & kSetpointBad) == 0) errors += kSetpointBad;
    session->plantTakesActions(takes);
    Measurement m;
    m.header = {static_cast<std::int64_t>(ts * 1e9) * k, 1, static_cast<std::uint32_t>(k) + 1};
    const Eigen::Index n_y = wish.size();
    Vector values = now.values;
    for (Eigen::Index i = 0; i < values.size(); ++i)
      if (!now.good[static_cast<std::size_t>(i)]) values[i] = kNoNumber;
    m.outputs = values.head(n_y);
    m.disturbances = values.tail(values.size() - n_y);
    m.input_applied = now.track ? now.actuator : last;
    if (!m.input_applied.allFinite()) errors += kActuatorBad;
    session->receive(m);
    const ControlAction& action = optimized();
    last = action.input;
    for (Eigen::Index i = 0; i < last.size(); ++i) row.push_back(last[i]);
    for (Eigen::Index i = 0; i < n_y; ++i) row.push_back(session->answer().tracking.setpoint[i]);
    row.push_back(static_cast<double>(action.source));
    BlockState state = static_cast<BlockState>(now.mode);
    if (action.source == ActionSource::kHeld) state = BlockState::kHeld;
    if (session->fellBack()) state = BlockState::kFallback;
    if (!now.enable || now.mode < 1) state = BlockState::kOff;
    row.push_back(static_cast<double>(state));
    row.push_back(errors);
  }

  const ControlAction& optimized() {
    const ControllerAnswer& answer = session->answer();
    if (!optimizer) return answer.base;
    if (answer.has_prediction) optimizer->receive(answer.prediction);
    optimizer->receive(answer.base);
    return optimizer->action();
  }

  void describe(const BlockCase& now) {
    row.clear();
    const auto& plant = loop.plant_info;
    const auto put = [&](const std::string& name, double value) {
      const auto at = std::find(inputs.begin(), inputs.end(), name);
      require(at != inputs.end(), "export", "an input " + name);
      row[static_cast<std::size_t>(at - inputs.begin())] = value;
    };
    row = defaults;
    put("xEnable", now.enable);
    put("iMode", now.mode);
    put("xReset", now.reset);
    put("xTrack", now.track);
    put("rSampleTime", now.sample_time);
    if (loop.has_clp) put("iMostSets", kEnoughSets);
    for (std::size_t i = 0; i < plant.outputs.size() + plant.disturbances.size(); ++i) {
      const bool output = i < plant.outputs.size();
      const auto row_of = static_cast<Eigen::Index>(i);
      const std::string name = plainName(
          output ? plant.outputs[i].name : plant.disturbances[i - plant.outputs.size()].name);
      put("rValue_" + name, now.values[row_of]);
      put("xOk_" + name, now.good[i]);
      if (!output) continue;
      put("rSetpoint_" + name, now.setpoint[row_of]);
      put("rCascade_" + name, now.cascade[row_of]);
    }
    for (std::size_t i = 0; i < plant.inputs.size(); ++i) {
      const auto of = static_cast<Eigen::Index>(i);
      const std::string name = plainName(plant.inputs[i].name);
      put("rManual_" + name, now.manual[of]);
      put("rActuator_" + name, now.actuator[of]);
      put("rLower_" + name, now.lower[of]);
      put("rUpper_" + name, now.upper[of]);
    }
  }

  const std::vector<double>& next() {
    BlockCase now;
    measure(now);
    scenario.play(k, now);
    describe(now);
    answer(now);
    if (stand_in)
      stand_in->advance(last);
    else
      simulation->advance(last);
    ++k;
    return row;
  }

  LoopFile loop;
  block_vectors::Scenario scenario;
  std::optional<ControllerSession> session;
  std::optional<OptimizerSession> optimizer;
  std::optional<Simulation> simulation;
  std::optional<block_vectors::StandIn> stand_in;
  std::vector<std::string> inputs, outputs;
  std::vector<double> defaults, row;
  Vector asked, last;
  int k{0};
};

BlockVectors::BlockVectors(const LoopFile& loop, const ir::Program& program, std::uint64_t seed,
                           int samples)
    : run_(std::make_unique<Run>(loop, program, seed, samples)) {}
BlockVectors::~BlockVectors() = default;
const std::vector<std::string>& BlockVectors::inputs() const { return run_->inputs; }
const std::vector<std::string>& BlockVectors::outputs() const { return run_->outputs; }
const std::vector<double>& BlockVectors::next() { return run_->next(); }

std::string BlockVectors::csv(int samples, std::size_t kept,
                              std::vector<std::vector<double>>& rows) {
  std::string text;
  for (const auto* names : {&inputs(), &outputs()})
    for (const std::string& name : *names) text += (text.empty() ? "" : ",") + name;
  text += "\n";
  for (int k = 0; k < samples; ++k) {
    const std::vector<double>& row = next();
    if (rows.size() < kept) rows.push_back(row);
    for (std::size_t i = 0; i < row.size(); ++i) text += (i == 0 ? "" : ",") + printNumber(row[i]);
    text += "\n";
  }
  return text;
}

}  // namespace fpc
