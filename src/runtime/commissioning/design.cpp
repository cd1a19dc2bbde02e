#include "runtime/commissioning/design.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <sstream>

#include "base/finite_json.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/statistics.hpp"
#include "base/yaml_load.hpp"
#include "control/pi/tuning.hpp"
#include "estimation/disturbance_observer.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "optim/simplex_search.hpp"
#include "runtime/loop_exchange.hpp"
#include "runtime/loop_probe.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kStepRoom = 0.3;    // of the distance to a limit: steps of the setpoints
constexpr double kStepReach = 0.5;   // of what the strongest input can do
constexpr double kLoadReach = 0.1;   // of what the strongest input can do: loads
constexpr double kLoadRoom = 0.5;    // of the distance to a limit, that a load may shift an output
constexpr double kViolation = 10.0;  // cost of all samples beyond the limits
constexpr double kFailed = 1e3;      // cost of a run that fails
constexpr double kCalm = 3.0;        // settling times of one stretch of the scenario
constexpr int kFewestRun = 40, kMostRun = 220;  // samples of it, before it is doubled
constexpr int kMostDoubled = 3;                 // times, where the loop has not settled by its end
constexpr double kSettled = 0.05;               // of a step
constexpr double kShortHorizon = 10, kLongHorizon = 60;
constexpr double kPeakPower = 6.0, kMostPeak = 20.0;  // of the peak beyond what is allowed
constexpr int kMostRounds = 3;                        // of a search, behind its first
constexpr double kMostPresent = 10.0;  // sensitivity that a control which holds a plant may have
constexpr double kWeakWeight = 0.3;    // of the square of a weak direction's gain
constexpr double kZoneWeight = 0.01;   // of an output that may float
constexpr double kWorth = 0.9;         // of what the PI costs: above it a law is not worth it
constexpr const char* kNeither = "neither is offered: test again, or allow more plant time";

std::string mapOf(const std::vector<SignalInfo>& signals, const Vector& values) {
  std::string text = "{";
  for (std::size_t i = 0; i < signals.size(); ++i)
    text += (i ? ", " : "") + signals[i].name + ": " + exactText(values[static_cast<Index>(i)]);
  return text + "}";
}

struct Pairing {
  Index input, output;
};

/// What the models say of the loops, in the units of the plant.
struct Outline {
  Vector y_scale, u_range;  // step of each setpoint; range of each input
  Vector load;              // shift of each output, of integrators per settling time
  Vector disturbance;       // step of each one that is measured, no larger than was seen
  Matrix gain;              // likeliest; of integrators per settling time
  double settling{};
  std::vector<Pairing> pairs;
  int stretch{}, longest{};  // samples
};

double rangeOf(const InputLimits& limits, Index j) {
  const double range = limits.upper[j] - limits.lower[j];
  return std::isfinite(range) ? range : 100.0 * limits.move[j];
}

/// Kuhn's step to a matching with one more pair; false: there is none.
bool giveInput(const Matrix& strength, Index output, std::vector<bool>& tried,
               std::vector<Pairing>& pairs) {
  for (Index j = 0; j < strength.cols(); ++j) {
    if (!(strength(output, j) > 0.0) || tried[static_cast<std::size_t>(j)]) continue;
    tried[static_cast<std::size_t>(j)] = true;
    const auto owner =
        std::find_if(pairs.begin(), pairs.end(), [&](const Pairing& p) { return p.input == j; });
    if (owner == pairs.end()) {
      pairs.push_back({j, output});
      return true;
    }
    const Index other = owner->output;
    const auto at = owner - pairs.begin();
    if (!giveInput(strength, other, tried, pairs)) continue;
    pairs[static_cast<std::size_t>(at)] = {j, output};
    return true;
  }
  return false;
}

/// Inputs and outputs by relative gains near 1 (bristol1966) among those with an effect, else by
/// size; outputs that are held first.
std::vector<Pairing> pairsOf(const CommissioningBrief& brief, const Matrix& scaled) {
  Matrix strength = scaled.cwiseAbs();
  if (scaled.rows() == scaled.cols()) {
    const Eigen::FullPivLU<Matrix> lu(scaled);
    if (lu.isInvertible()) {
      const Matrix relative = scaled.cwiseProduct(lu.inverse().transpose());
      for (Index i = 0; i < scaled.rows(); ++i)
        for (Index j = 0; j < scaled.cols(); ++j)
          strength(i, j) = relative(i, j) > 0.0 ? 1.0 / (1e-3 + std::abs(std::log(relative(i, j))))
                                                : std::min(1e-6, std::abs(scaled(i, j)));
    }
  }
  for (Index i = 0; i < scaled.rows(); ++i)
    if (!brief.held[static_cast<std::size_t>(i)]) strength.row(i).setZero();
  std::vector<Pairing> pairs;
  Pairing next{};
  Matrix left = strength;
  while (left.size() > 0 && left.maxCoeff(&next.output, &next.input) > 0.0) {
    pairs.push_back(next);
    left.row(next.output).setZero();
    left.col(next.input).setZero();
  }
  // An output that got none may take the input of one that has another.
  for (Index i = 0; i < strength.rows(); ++i) {
    const auto holds = [&](const Pairing& p) { return p.output == i; };
    if (std::any_of(pairs.begin(), pairs.end(), holds)) continue;
    std::vector<bool> tried(static_cast<std::size_t>(strength.cols()), false);
    giveInput(strength, i, tried, pairs);
  }
  return pairs;
}

Outline outlineOf(const CommissioningBrief& brief, const ProcessModels& models) {
  const InputLimits& limits = brief.loop.simulation.actuator.limits;
  const Index n_y = countOf(brief.loop.plant_info.outputs),
              n_u = countOf(brief.loop.plant_info.inputs);
  const double Ts = brief.loop.plant_info.sample_time_s;
  Outline o;
  o.u_range.resize(n_u);
  for (Index j = 0; j < n_u; ++j) o.u_range[j] = rangeOf(limits, j);
  for (const ProcessFit& fit : models.fits)
    for (Index j = 0; j < n_u; ++j)
      if (fit.elements[static_cast<std::size_t>(j)].seen)
        o.settling =
            std::max(o.settling, fit.elements[static_cast<std::size_t>(j)].element.settling());
  o.settling = std::max(o.settling, 3.0 * Ts);
  const auto effect = [&](Index i, Index from) {
    const ProcessElement& e =
        models.fits[static_cast<std::size_t>(i)].elements[static_cast<std::size_t>(from)].element;
    return e.integrating ? e.gain * o.settling : e.gain;
  };
  o.gain.setZero(n_y, n_u);
  for (Index i = 0; i < n_y; ++i)
    for (Index j = 0; j < n_u; ++j) o.gain(i, j) = effect(i, j);
  // What the disturbances that are measured do to a held output, in parts of what they may.
  Vector share = Vector::Zero(models.disturbance_moves.size());
  o.y_scale.resize(n_y);
  o.load = kLoadReach * (o.gain.cwiseAbs() * o.u_range.asDiagonal()).rowwise().maxCoeff();
  for (Index i = 0; i < n_y; ++i) {
    const double room = std::min(brief.upper[i] - brief.hold[i], brief.hold[i] - brief.lower[i]);
    double reach = 0.0;
    const Vector& rest = models.fits[static_cast<std::size_t>(i)].input;
    for (Index j = 0; j < n_u; ++j)
      reach = std::max(reach, std::abs(o.gain(i, j)) * std::max(std::min(limits.upper[j] - rest[j],
                                                                         rest[j] - limits.lower[j]),
                                                                0.1 * o.u_range[j]));
    o.y_scale[i] = std::min(kStepRoom * room, kStepReach * reach);
    if (!(o.y_scale[i] > 0.0)) o.y_scale[i] = kStepRoom * room;
    o.load[i] = std::min(o.load[i], kLoadRoom * room);
    for (Index k = 0; brief.held[static_cast<std::size_t>(i)] && k < share.size(); ++k)
      share[k] = std::max(share[k], std::abs(effect(i, n_u + k)) * models.disturbance_moves[k] /
                                        (kLoadRoom * room));
  }
  o.disturbance = Vector::Zero(share.size());
  for (Index k = 0; k < share.size(); ++k)
    if (share[k] > 0.0) o.disturbance[k] = models.disturbance_moves[k] / std::max(share[k], 1.0);
  o.pairs = pairsOf(brief, o.y_scale.cwiseInverse().asDiagonal() * o.gain * o.u_range.asDiagonal());
  const double calm = std::max<double>(std::ceil(kCalm * o.settling / Ts), kFewestRun);
  o.stretch = static_cast<int>(std::min<double>(calm, kMostRun));
  o.longest = static_cast<int>(std::min<double>(calm, kMostRun << kMostDoubled));
  return o;
}

// ---- loop files

/// The plant's loop file with another control, as text that stands by itself.
std::string rewritten(const CommissioningBrief& brief, const std::string& what,
                      const std::vector<std::pair<std::string, std::string>>& sections) {
  YAML::Node root = detached(loadYaml(brief.loop.resolved, brief.loop.name));
  for (const char* key : {"controller", "clp", "model", "guard", "estimator", "standstill"})
    root.remove(key);
  for (const auto& [key, text] : sections) root[key] = detached(loadYaml(text, "design: " + key));
  root["actuator"]["move_upper"] =
      detached(loadYaml(mapOf(brief.loop.plant_info.inputs, brief.move), "design: moves"));
  root["title"] = brief.loop.report.title + ", commissioned " + what;
  YAML::Emitter out;
  out << root;
  return std::string(out.c_str()) + "\n";
}

struct PiSetting {
  double kp{}, ti_min{};
};

bool hasPresent(const CommissioningBrief& brief) {
  return brief.closed && !brief.loop.controllerType().needs_model;
}

/// A loop that is not linear at rest is taken for one that is not stable.
DesignFigures atRest(const LoopFile& loop) {
  const LoopCourse course(loop);
  const CoursePoint point = course.points(1).front();
  const LoopProbe probed = probeLoop(course.stayingAt(loop, point), point);
  DesignFigures figures;
  figures.worst_peak = kInfinity;
  if (probed.result != ProbeResult::kLinear) return figures;
  figures.worst_peak = probed.response->peak();
  figures.least_gain = figures.least_delay_s = kInfinity;
  for (Index j = 0; j < countOf(loop.plant_info.inputs); ++j) {
    const LoopMargins margin = probed.response->margins(j);
    figures.least_gain = std::min(figures.least_gain, margin.gain_upper);
    figures.least_delay_s = std::min(figures.least_delay_s, margin.delay_s);
  }
  return figures;
}

class Designer {
 public:
  Designer(const CommissioningBrief& brief, const Vector& noise, std::string model_file,
           const ProcessModels& models, const DesignParams& params)
      : brief_(brief),
        noise_(noise),
        model_file_(std::move(model_file)),
        models_(models),
        params_(params),
        outline_(outlineOf(brief, models)),
        allowed_peak_(params.peak) {
    std::vector<const TsModel*> all;
    for (const TsModel& member : models.ensemble) all.push_back(&member);
    require(split(all), "ensemble", "more members than are tuned on");
  }

  Design run() {
    Design d;
    require(!outline_.pairs.empty(), brief_.file + ": zone", "an output that is to be held");
    leaveOutRefuted(d);
    lookAtDirections(d);
    if (refuted_) return untuned(d);
    const Vector pi = searchedPi(d.pi_figures);
    pi_ = piOf(pi);
    if (!(d.pi_figures.worst_peak <= allowed_peak_)) d.remarks.push_back(leavePi());
    const Vector law = searched(
        "law", lawStarts(), [this](const Vector& x) { return lawText(x); }, d.law_figures);
    nameUnpaired(d);
    d.probed = tuned_.size() + held_out_.size();
    d.pi = piText(pi);
    d.law = lawText(law);
    compare(d);
    return d;
  }

 private:
  void show(const std::string& text) const {
    if (params_.show) params_.show(text);
  }

  // ---- the models

  /// False: too few.
  bool split(const std::vector<const TsModel*>& members) {
    const auto tuned = static_cast<std::ptrdiff_t>(params_.tuned_members);
    if (static_cast<std::ptrdiff_t>(members.size()) < tuned + 2) return false;
    tuned_.assign(members.begin(), members.begin() + tuned);
    tuned_.insert(tuned_.begin(), &models_.model);
    held_out_.assign(members.begin() + tuned, members.end());
    return true;
  }

  /// The present control holds the plant: a model that it does not bring to rest is not the
  /// plant's.
  void leaveOutRefuted(Design& d) {
    if (!hasPresent(brief_)) return;
    show("models on which the present control holds");
    std::vector<const TsModel*> all, held;
    for (const TsModel& member : models_.ensemble) all.push_back(&member);
    const std::vector<DesignFigures> present = probes(brief_.loop.resolved, all);
    std::vector<double> peaks;
    for (std::size_t m = 0; m < all.size(); ++m) {
      if (!(present[m].worst_peak <= kMostPresent)) continue;
      held.push_back(all[m]);
      peaks.push_back(present[m].worst_peak);
    }
    d.refuted = all.size() - held.size();
    refuted_ = !split(held);
    if (refuted_) return;
    // A plant that is hard to hold may not allow the peak that is asked for: then nothing may be
    // more sensitive than the control in charge is on half of the models.
    d.present_peak = median(peaks);
    allowed_peak_ = std::max(allowed_peak_, d.present_peak);
  }

  void nameUnpaired(Design& d) const {
    for (Index i = 0; i < countOf(brief_.loop.plant_info.outputs); ++i) {
      const bool paired = std::any_of(outline_.pairs.begin(), outline_.pairs.end(),
                                      [&](const Pairing& pair) { return pair.output == i; });
      if (brief_.held[static_cast<std::size_t>(i)] && !paired)
        d.remarks.push_back(brief_.loop.plant_info.outputs[static_cast<std::size_t>(i)].name +
                            " has no PI: no input is left that moves it");
    }
  }

  /// There is nothing to tune on: the loop files hold what a search would begin with.
  Design untuned(Design& d) {
    const Vector rule = Vector::Zero(2 * loops());
    pi_ = piOf(rule);
    d.pi = piText(rule);
    d.law = lawText(lawStarts().front());
    for (DesignFigures* figures : {&d.law_figures, &d.pi_figures}) figures->worst_peak = kInfinity;
    d.remarks.push_back("the present control holds the plant and would not hold " +
                        std::to_string(d.refuted) + " of " +
                        std::to_string(models_.ensemble.size()) +
                        " models: they are not its, and nothing was tuned on them");
    d.remarks.push_back(kNeither);
    return d;
  }

  // ---- the PI

  Index loops() const { return static_cast<Index>(outline_.pairs.size()); }
  const ProcessElement& elementOf(Index pair) const {
    const Pairing& pairing = outline_.pairs[static_cast<std::size_t>(pair)];
    return models_.fits[static_cast<std::size_t>(pairing.output)]
        .elements[static_cast<std::size_t>(pairing.input)]
        .element;
  }

  bool isStable(Index pair) const {
    return !elementOf(pair).integrating && elementOf(pair).time_constant >= 0.0;
  }

  PiSetting ruleOf(Index p) const {
    const double Ts = brief_.loop.plant_info.sample_time_s;
    const ProcessElement& e = elementOf(p);
    PiSetting s;
    const double late = e.dead_time + std::abs(std::min(e.lead, 0.0)) + 0.5 * Ts;
    if (e.integrating) {  // skogestad2003
      const double wait = std::max(late + e.second, Ts);
      s.kp = 0.5 / (e.gain * wait);
      s.ti_min = 8.0 * wait / 60.0;
    } else if (e.time_constant < 0.0) {
      // 1 + K kp < 0 stabilises K / (tau s + 1) with tau < 0; the more, the sooner it acts.
      const double wait = std::max(late + e.second, Ts);
      s.kp = -1.5 / e.gain * std::max(std::min(std::sqrt(-e.time_constant / wait), 4.0), 1.0);
      s.ti_min = 4.0 * std::max(-e.time_constant, wait) / 60.0;
    } else {
      const Fopdt lag{e.gain, std::max(e.lags(), 0.3 * Ts) / 60.0, late / 60.0};
      const PiTuning t =
          imcTuning(lag, std::max({lag.dead_time, 0.5 * lag.time_constant, Ts / 60.0}));
      s = {t.kp, t.integral_time_min};
    }
    return s;
  }

  /// A PI that is not stable enough is no fallback of a law: the loops in charge are one where they
  /// are PIs, else there is none.
  std::string leavePi() {
    pi_.clear();
    for (Index p = 0; p < loops(); ++p) {
      const PiSetting now = inCharge(p, {0.0, 0.0});
      if (now.ti_min > 0.0) pi_.push_back(now);
    }
    if (static_cast<Index>(pi_.size()) == loops()) return "the law falls back to the PIs in charge";
    pi_.clear();
    return "the law has no fallback: inputs are held where it may not act";
  }

  /// x: log2 of what the rule's gain and integral time are multiplied by.
  std::vector<PiSetting> piOf(const Vector& x) const {
    std::vector<PiSetting> settings;
    for (Index p = 0; p < loops(); ++p) {
      settings.push_back(ruleOf(p));
      settings.back().kp *= std::exp2(x[2 * p]);
      settings.back().ti_min *= std::exp2(x[2 * p + 1]);
      // Integral action slower than the plant is none; the scenario may be too short to show it.
      if (isStable(p))
        settings.back().ti_min = std::min(settings.back().ti_min, outline_.settling / 60.0);
    }
    return settings;
  }

  /// The rule's, softer ones, and those in charge where a PI holds the pair.
  std::vector<Vector> piStarts() const {
    std::vector<Vector> starts(4, Vector::Zero(2 * loops()));
    for (Index p = 0; p < loops(); ++p) {
      for (std::size_t k = 1; k < starts.size(); ++k)
        starts[k].segment(2 * p, 2) << -static_cast<double>(k),
            isStable(p) ? 0.0 : static_cast<double>(k);
    }
    Vector present = Vector::Zero(2 * loops());
    for (Index p = 0; p < loops(); ++p) {
      const PiSetting rule = ruleOf(p), now = inCharge(p, rule);
      present.segment(2 * p, 2) << std::log2(now.kp / rule.kp), std::log2(now.ti_min / rule.ti_min);
    }
    if (present.allFinite()) starts.push_back(present);
    return starts;
  }

  PiSetting inCharge(Index p, const PiSetting& otherwise) const {
    const PlantInfo& plant = brief_.loop.plant_info;
    const Pairing& pair = outline_.pairs[static_cast<std::size_t>(p)];
    if (!brief_.closed) return otherwise;
    const YAML::Node law = loadYaml(brief_.loop.resolved, brief_.loop.name)["controller"];
    for (const auto& loop : law["loops"]) {
      const double kp = loop["kp"].as<double>(0.0), ki_per_h = loop["ki_per_h"].as<double>(0.0);
      if (loop["input"].as<std::string>("") ==
              plant.inputs[static_cast<std::size_t>(pair.input)].name &&
          loop["output"].as<std::string>("") ==
              plant.outputs[static_cast<std::size_t>(pair.output)].name &&
          kp / ki_per_h > 0.0)
        return {loop["reverse"].as<bool>(false) ? -kp : kp, kp / ki_per_h * 60.0};
    }
    return otherwise;
  }

  /// The zero of a PI drives an unstable process far beyond a step of its setpoint: the step is
  /// filtered with 1 / (Ti s + 1), which takes the zero away (astrom2008).
  std::string piLoops(const std::vector<PiSetting>& settings) const {
    const PlantInfo& plant = brief_.loop.plant_info;
    std::string text = "[";
    for (Index p = 0; p < loops(); ++p) {
      const auto at = static_cast<std::size_t>(p);
      const Pairing& pair = outline_.pairs[at];
      const PiSetting& s = settings[at];
      text += std::string(p ? ", " : "") +
              "{input: " + plant.inputs[static_cast<std::size_t>(pair.input)].name +
              ", output: " + plant.outputs[static_cast<std::size_t>(pair.output)].name +
              ", kp: " + exactText(s.kp) + ", ki_per_h: " + exactText(s.kp * 60.0 / s.ti_min);
      if (elementOf(p).time_constant < 0.0)
        text += ", setpoint_pole: " + exactText(std::exp(-plant.sample_time_s / (60.0 * s.ti_min)));
      text += ", start: bumpless}";
    }
    return text + "]";
  }

  std::string piText(const Vector& x) const {
    return rewritten(brief_, "PI", {{"controller", "{type: pi, loops: " + piLoops(piOf(x)) + "}"}});
  }

  // ---- the predictive law

  /// x: log10 of the moves' weight, in parts of what they cost, log10 of a disturbance's effect
  /// over noise, then log2 of the reference times of the held outputs.
  std::vector<Vector> lawStarts() const {
    Vector softer = Vector::Ones(2 + std::count(brief_.held.begin(), brief_.held.end(), true));
    softer[1] = -0.5;
    const Vector start = 0.25 * Vector::Unit(softer.size(), 1);
    return {start, start + softer, start + 2.0 * softer, start + 3.0 * softer};
  }

  std::string lawText(const Vector& x) const {
    const PlantInfo& plant = brief_.loop.plant_info;
    const double Ts = plant.sample_time_s;
    const Index n_y = countOf(plant.outputs), n_u = countOf(plant.inputs);
    Vector weight(n_y), pole(n_y), move(n_u), noise(n_y), walk(n_y), pull = Vector::Zero(n_u);
    Index next = 2;
    for (Index i = 0; i < n_y; ++i) {
      const bool held = brief_.held[static_cast<std::size_t>(i)];
      weight[i] = (held ? 1.0 : kZoneWeight) / (outline_.y_scale[i] * outline_.y_scale[i]);
      double lag = Ts;
      const ProcessFit& fit = models_.fits[static_cast<std::size_t>(i)];
      double most = 0.0;
      for (Index j = 0; j < n_u; ++j) {
        const ProcessElement& e = fit.elements[static_cast<std::size_t>(j)].element;
        if (std::abs(outline_.gain(i, j)) * outline_.u_range[j] <= most) continue;
        most = std::abs(outline_.gain(i, j)) * outline_.u_range[j];
        lag = std::max({0.3 * e.lags(), 0.5 * e.dead_time, 0.5 * Ts});
      }
      pole[i] = std::exp(-Ts / (lag * (held ? std::exp2(x[next]) : 1.0)));
      if (held) ++next;
      noise[i] = std::max(noise_[i], 1e-4 * outline_.y_scale[i]);
      walk[i] =
          std::pow(10.0, x[1]) * std::max(fit.one_step, 1e-4 * outline_.y_scale[i]) * loadUnit(i);
    }
    for (Index j = 0; j < n_u; ++j) {
      move[j] = std::pow(10.0, x[0]) * params_.movement / (brief_.move[j] * brief_.move[j]);
      pull[j] = pull_ / (outline_.u_range[j] * outline_.u_range[j]);
    }
    const double horizon =
        std::clamp(std::ceil(outline_.settling / Ts), kShortHorizon, kLongHorizon);
    std::ostringstream c;
    c << "{type: fmbpc, law: iterated, horizon_steps: " << horizon
      << ", reference_pole: " << mapOf(plant.outputs, pole)
      << ", weight_output: " << mapOf(plant.outputs, weight)
      << ", weight_move: " << mapOf(plant.inputs, move);
    if (pull_ > 0.0)
      c << ", weight_input: " << mapOf(plant.inputs, pull)
        << ", input_target: " << mapOf(plant.inputs, modelRest(models_.fits, n_u).inputs);
    c << ", realisation: observer, observer: {noise_std: " << mapOf(plant.outputs, noise)
      << ", disturbance_std: 0, estimated: {";
    const std::vector<bool> counted = brief_.counted();
    const char* comma = "";
    for (std::size_t i = 0; i < counted.size(); ++i) {
      if (!counted[i]) continue;
      const double change = walk[static_cast<Index>(i)];
      c << comma << loadName(plant.outputs[i].name)
        << ": {std: " << exactText(kUnknownChanges * change) << ", walk_std: " << exactText(change)
        << "}";
      comma = ", ";
    }
    c << "}}}";
    std::vector<std::pair<std::string, std::string>> sections{
        {"model", "{file: '" + model_file_ + "'}"}, {"controller", c.str()}};
    if (!pi_.empty())
      sections.emplace_back("guard", "{fallback: {type: pi, loops: " + piLoops(pi_) + "}}");
    return rewritten(brief_, "law", sections);
  }

  // ---- judging

  /// Of the models' loads, for a shift of the output by 1; of an integrator: per settling time.
  double loadUnit(Index output) const {
    const bool per_hour =
        models_.fits[static_cast<std::size_t>(output)].kind == ProcessKind::kIntegrating;
    return per_hour ? 3600.0 / outline_.settling : 1.0;
  }

  LoopFile loopOf(const std::string& text) const { return parseLoop(text, brief_.loop.name); }

  /// The loop on one model, asked for steps of all that is held, then under disturbances that are
  /// measured, one after the other, then under loads.
  LoopFile scenario(const LoopFile& given, const TsModel& model) const {
    LoopFile loop =
        onModel(given, model, modelRest(models_.fits, countOf(brief_.loop.plant_info.inputs)));
    const double Ts = brief_.loop.plant_info.sample_time_s,
                 stretch_h = outline_.stretch * Ts / 3600.0;
    loop.setpoint.initial = loop.simulation.initial_state;
    const Vector rest = loop.simulation.initial_state;
    Vector asked = rest;
    int stretch = 0;
    const auto at = [&](int n) { return 0.1 * stretch_h + n * stretch_h; };
    for (Index i = 0; i < rest.size(); ++i) {
      if (!brief_.held[static_cast<std::size_t>(i)]) continue;
      const double up = brief_.upper[i] - rest[i], down = rest[i] - brief_.lower[i];
      asked[i] = rest[i] + (up >= down ? 1.0 : -1.0) * outline_.y_scale[i];
      loop.setpoint.schedule.push_back({at(stretch++), asked, 0.0});
    }
    loop.setpoint.schedule.push_back({at(stretch++), rest, 0.0});
    const auto offset = [&](const std::string& name, double value) {
      Command command;
      command.name = {name};
      command.value = {value};
      command.mode = CommandMode::kOffset;
      loop.simulation.disturbance_commands.push_back({at(stretch), command});
    };
    for (Index k = 0; k < outline_.disturbance.size(); ++k) {
      if (!(outline_.disturbance[k] > 0.0)) continue;
      const std::string& name =
          brief_.loop.plant_info.disturbances[static_cast<std::size_t>(k)].name;
      offset(name, outline_.disturbance[k]);
      ++stretch;
      offset(name, 0.0);
    }
    for (Index i = 0; i < rest.size(); ++i) {
      if (!brief_.held[static_cast<std::size_t>(i)]) continue;
      offset(loadName(brief_.loop.plant_info.outputs[static_cast<std::size_t>(i)].name),
             outline_.load[i] * loadUnit(i));
      ++stretch;
    }
    loop.simulation.samples =
        static_cast<std::uint32_t>(stretch * outline_.stretch + outline_.stretch / 10);
    return loop;
  }

  /// What acts on the outputs beside inputs, as the fits found it, n_d (samples + 1): with r their
  /// autoregressive noise and p the shared pole of the elements, y = G u + r / (1 - p q). The load
  /// of the model's equation that makes it is A r / (1 - p q), A the model's denominator.
  Matrix noiseOf(const SimulationParams& plant, const TsModel& model, std::uint64_t seed) const {
    const Index n_y = countOf(model.outputs), n = static_cast<Index>(plant.samples) + 1;
    Matrix values = plant.disturbance_nominal.replicate(1, n);
    for (Index i = 0; i < n_y; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const ProcessFit& fit = models_.fits[at];
      double pole = fit.kind == ProcessKind::kIntegrating ? 1.0 : 0.0;
      for (const ElementEstimate& e : fit.elements)
        if (fit.kind == ProcessKind::kUnstable && e.seen)
          pole = std::exp(-brief_.loop.plant_info.sample_time_s / e.element.time_constant);
      Vector shape = Vector::Ones(1);
      for (std::size_t k = 0; k < model.submodels[at].regressors.size(); ++k) {
        const Regressor& own = model.submodels[at].regressors[k];
        if (own.kind != SignalKind::kOutput) continue;
        if (own.lag + 2 > shape.size()) shape.conservativeResizeLike(Vector::Zero(own.lag + 2));
        shape[own.lag + 1] = -model.submodels[at].rules.front().coefficients[static_cast<Index>(k)];
      }
      if (pole > 0.0) shape.conservativeResize(shape.size() - 1);
      for (Index k = 1; k < shape.size(); ++k) shape[k] += pole * shape[k - 1];
      std::mt19937_64 engine = seededEngine(seed, {static_cast<std::uint64_t>(i)});
      Vector r(n);
      for (Index k = 0; k < n; ++k) {
        r[k] = fit.one_step * standardNormal(engine);
        const Index past = std::min(k, fit.noise.size());
        r[k] += fit.noise.head(past).dot(r.segment(k - past, past).reverse());
        const Index rows = std::min(k + 1, shape.size());
        values(values.rows() - n_y + i, k) +=
            shape.head(rows).dot(r.segment(k + 1 - rows, rows).reverse());
      }
    }
    return values;
  }

  /// Sums of what has been counted of a run.
  struct Counted {
    std::size_t samples{};
    double error{}, moves{}, beyond{};
    double over(double n) const {
      const double value = (error + moves + kViolation * beyond) / n;
      return std::isfinite(value) ? std::min(value, kFailed) : kFailed;
    }
  };
  /// The next sample. The last one of a run, which has no move, is counted when the run has ended.
  void count(const RunRecord& record, Counted& counted) const {
    const std::size_t k = counted.samples++;
    const SampleRecord& s = record.samples[k];
    for (Index i = 0; i < s.state.outputs.size(); ++i) {
      if (s.state.outputs[i] > brief_.upper[i] || s.state.outputs[i] < brief_.lower[i])
        counted.beyond += 1.0;
      double e = s.tracking.setpoint[i] - s.state.outputs[i];
      if (!brief_.held[static_cast<std::size_t>(i)]) {
        const double y = s.state.outputs[i];
        e = std::max({y - brief_.zone_upper[i], brief_.zone_lower[i] - y, 0.0});
      }
      counted.error += e * e / (outline_.y_scale[i] * outline_.y_scale[i]);
    }
    if (k == 0 || k + 1 == record.samples.size()) return;
    const Vector& u = s.action.input;
    const Vector& before = record.samples[k - 1].action.input;
    for (Index j = 0; j < u.size(); ++j) {
      const double part = (u[j] - before[j]) / brief_.move[j];
      counted.moves += params_.movement * part * part;
    }
  }

  /// Mean square of the errors, in steps, plus that of the moves, in parts of the largest allowed.
  /// `enough`: given what the run costs at least, whether it may end; that is the answer then.
  template <typename Enough>
  double cost(const LoopFile& asked, const TsModel& model, std::uint64_t seed,
              const Enough& enough) const {
    LoopFile loop = scenario(asked, model);
    loop.simulation.disturbance.values = noiseOf(loop.simulation, model, seed);
    const RunOptions options;
    LoopExchange exchange(loop, options);
    const double n = loop.simulation.samples + 1.0;
    Counted counted;
    while (exchange.step()) {
      while (counted.samples + 1 < exchange.recorded().samples.size())
        count(exchange.recorded(), counted);
      if (enough(counted.over(n))) return counted.over(n);
    }
    const RunRecord record = exchange.take();
    if (!record.complete) return kFailed;
    while (counted.samples < record.samples.size()) count(record, counted);
    return counted.over(n);
  }

  /// Half of what counts is the worst of the models.
  template <typename Costs>
  static double joined(const Costs& costs) {
    double sum = 0.0, most = 0.0;
    for (const double cost : costs) {
      sum += cost;
      most = std::max(most, cost);
    }
    return 0.5 * (sum / static_cast<double>(costs.size()) + most);
  }

  /// Where joined() is not below `least`: what is sure of them when that is known.
  std::vector<double> costsOver(const std::string& text, const std::vector<const TsModel*>& models,
                                double least = kInfinity) const {
    std::vector<std::atomic<double>> sure(models.size());
    for (std::atomic<double>& cost : sure) cost = 0.0;
    std::vector<double> costs(models.size(), kFailed);
    LoopFile asked;
    try {
      asked = loopOf(text);
    } catch (const InputError&) {
      return costs;
    }
    parallelFor(models.size(), params_.threads, [&](std::size_t m) {
      if (joined(sure) >= least) return;
      try {
        sure[m] = cost(asked, *models[m], params_.seed + m, [&](double at_least) {
          sure[m] = at_least;
          return joined(sure) >= least;
        });
      } catch (const InputError&) {
        sure[m] = kFailed;  // as above: a setting with which the loop cannot be run
      }
    });
    std::copy(sure.begin(), sure.end(), costs.begin());
    return costs;
  }

  double tunedCost(const std::string& text, double least = kInfinity) const {
    return joined(costsOver(text, tuned_, least));
  }

  /// The cost, dearer the less stable the loop is on one of `asked`; of what is not below `least`,
  /// something that is not, which takes less time.
  double value(const std::string& text, const std::vector<const TsModel*>& asked, double least,
               double& peak) const {
    const double cost = tunedCost(text, least);
    if (cost >= least) return cost;
    peak = worst(probes(text, asked)).worst_peak;
    return cost * std::pow(std::max(std::min(peak, kMostPeak) / allowed_peak_, 1.0), kPeakPower);
  }

  template <typename Text>
  Vector leastOf(const std::vector<Vector>& settings, const Text& text,
                 const std::vector<const TsModel*>& asked) const {
    Vector best = settings.front();
    double least = kInfinity, peak{};
    for (const Vector& x : settings) {
      const double cost = value(text(x), asked, least, peak);
      if (cost < least) best = x;
      least = std::min(least, cost);
    }
    return best;
  }

  /// The cheapest setting found that is stable enough on the models tuned on, from the first of
  /// `starts`, or from the best one where none was found. The model held out on which it is least
  /// stable joins them where that is not enough, and the search goes on.
  template <typename Text>
  Vector searched(const std::string& what, const std::vector<Vector>& starts, const Text& text,
                  DesignFigures& figures) const {
    std::vector<const TsModel*> asked = tuned_, others = held_out_;
    Vector x = starts.front();
    int count = 0;
    for (int round = 0;; ++round) {
      Vector stable;
      double cheapest = kInfinity;
      const auto judge = [&](const Vector& at, double least) {
        show(what + ": " + std::to_string(++count) + " settings");
        double peak = kInfinity;
        const double cost = value(text(at), asked, least, peak);
        if (peak <= allowed_peak_ && cost < cheapest) {
          cheapest = cost;
          stable = at;
        }
        return cost;
      };
      x = simplexSearch(x, params_.evaluations / (round > 0 ? 3 : 1), judge);
      const bool found = stable.size() > 0;
      if (found) x = stable;
      const std::vector<DesignFigures> more = probes(text(x), others);
      const auto last = std::max_element(
          more.begin(), more.end(),
          [](const auto& p, const auto& q) { return p.worst_peak < q.worst_peak; });
      const bool holds = last == more.end() || last->worst_peak <= allowed_peak_;
      if ((found && holds) || round == kMostRounds) {
        figures = worst({worst(probes(text(x), asked)), worst(more)});
        figures.tuned = tunedCost(text(x));
        return x;
      }
      if (!found && round == 0) x = leastOf(starts, text, asked);
      if (!found) continue;
      asked.push_back(others[static_cast<std::size_t>(last - more.begin())]);
      others.erase(others.begin() + (last - more.begin()));
    }
  }

  /// Again with longer stretches where they end before the loop found has settled: what integral
  /// action does is not seen in them. The law, which costs many times the time, is then tuned and
  /// compared on the same ones.
  Vector searchedPi(DesignFigures& figures) {
    const auto text = [this](const Vector& x) { return piText(x); };
    Vector x = searched("PI", piStarts(), text, figures);
    while (outline_.stretch < outline_.longest && !settles(piText(x))) {
      outline_.stretch = std::min(2 * outline_.stretch, outline_.longest);
      x = searched("PI", piStarts(), text, figures);
    }
    return x;
  }

  /// Whether the last tenth of each stretch is within a part of a step, without noise.
  bool settles(const std::string& text) const {
    const RunRecord record = runLoop(scenario(loopOf(text), models_.model));
    const auto stretch = static_cast<std::size_t>(outline_.stretch);
    for (std::size_t k = stretch; k < record.samples.size(); ++k) {
      if (k % stretch >= stretch / 10) continue;
      const SampleRecord& s = record.samples[k];
      for (Index i = 0; i < s.state.outputs.size(); ++i) {
        const double e = s.tracking.setpoint[i] - s.state.outputs[i];
        if (brief_.held[static_cast<std::size_t>(i)] &&
            std::abs(e) > kSettled * outline_.y_scale[i])
          return false;
      }
    }
    return record.complete;
  }

  DesignFigures probe(const LoopFile& asked, const TsModel& model) const {
    LoopFile loop = scenario(asked, model);
    loop.simulation.disturbance_commands.clear();
    return atRest(loop);
  }
  std::vector<DesignFigures> probes(const std::string& text,
                                    const std::vector<const TsModel*>& models) const {
    std::vector<DesignFigures> each(models.size());
    const LoopFile asked = loopOf(text);
    parallelFor(each.size(), params_.threads,
                [&](std::size_t m) { each[m] = probe(asked, *models[m]); });
    return each;
  }
  static DesignFigures worst(const std::vector<DesignFigures>& each) {
    DesignFigures all;
    all.least_gain = all.least_delay_s = kInfinity;
    for (const DesignFigures& one : each) {
      all.worst_peak = std::max(all.worst_peak, one.worst_peak);
      all.least_gain = std::min(all.least_gain, one.least_gain);
      all.least_delay_s = std::min(all.least_delay_s, one.least_delay_s);
    }
    return all;
  }

  /// Costs over others, means of the pairs' ratios, and half widths of their 95 % intervals.
  struct Ratio {
    double mean{}, half{};  // logarithms
    bool isBetter() const { return mean + half < 0.0; }
  };
  static Ratio ratioOf(const std::vector<double>& costs, const std::vector<double>& others) {
    const auto n = static_cast<double>(costs.size());
    double mean = 0.0, square = 0.0;
    for (std::size_t m = 0; m < costs.size(); ++m) {
      const double r = std::log(costs[m] / others[m]);
      mean += r / n;
      square += r * r / n;
    }
    return {mean, studentBound(0.95, n - 1.0) *
                      std::sqrt(std::max(square - mean * mean, 0.0) / (n - 1.0))};
  }

  void compare(Design& d) const {
    d.law_figures.costs = costsOver(d.law, held_out_);
    d.pi_figures.costs = costsOver(d.pi, held_out_);
    const Ratio ratio = ratioOf(d.law_figures.costs, d.pi_figures.costs);
    d.ratio = std::exp(ratio.mean);
    d.ratio_bound = d.ratio * std::expm1(ratio.half);
    if (hasPresent(brief_)) d.present_costs = costsOver(brief_.loop.resolved, held_out_);
    const auto isFit = [&](const DesignFigures& figures, const std::string& name) {
      const bool stable = figures.worst_peak <= allowed_peak_;
      const bool better =
          d.present_costs.empty() || ratioOf(figures.costs, d.present_costs).isBetter();
      if (!stable)
        d.remarks.push_back("the " + name +
                            " is not stable on every model with a sensitivity peak of at most " +
                            shortText(allowed_peak_));
      else if (!better)
        d.remarks.push_back("the " + name + " does not beat the control in charge");
      return stable && better;
    };
    const bool law = isFit(d.law_figures, "law"), pi = isFit(d.pi_figures, "PI");
    d.offers_law = law && (!pi || (ratio.isBetter() && d.ratio <= kWorth));
    d.offers_pi = !d.offers_law && pi;
    d.remarks.push_back(d.offers_law ? "the law is offered: it costs " + shortText(d.ratio) +
                                           " of what the PI does"
                        : !d.offers_pi ? kNeither
                        : law          ? "the PI is offered: the law costs " + shortText(d.ratio) +
                                    " of it, and " + shortText(kWorth) + " at most is asked"
                              : "the PI is offered");
  }

  void lookAtDirections(Design& d) {
    d.weak = weakDirections(models_, outline_.u_range, outline_.y_scale);
    // Scaled gains: a unit of cost is a step of an output, a unit of input its range.
    const Matrix scaled = outline_.y_scale.cwiseInverse().asDiagonal() * outline_.gain *
                          outline_.u_range.asDiagonal();
    for (const WeakDirection& w : d.weak) {
      const double gain = (scaled * w.inputs).norm();
      std::string direction;
      for (Index j = 0; j < w.inputs.size(); ++j)
        direction += (j ? ", " : "") +
                     brief_.loop.plant_info.inputs[static_cast<std::size_t>(j)].name + " " +
                     shortText(w.inputs[j]);
      if (w.certain) {
        d.remarks.push_back("moving (" + direction + ") together, in parts of their ranges, does " +
                            shortText(100.0 * w.share) +
                            " % of what the strongest direction does: it is used, and slow");
      } else {
        pull_ = std::max(pull_, kWeakWeight * gain * gain);
        d.remarks.push_back("the sign of what (" + direction +
                            ") do together, in parts of their ranges, is not known: that direction "
                            "is left alone, and an offset stays in it");
      }
    }
  }

  const CommissioningBrief& brief_;
  Vector noise_;
  std::string model_file_;
  const ProcessModels& models_;
  DesignParams params_;
  Outline outline_;
  std::vector<const TsModel*> tuned_, held_out_;
  std::vector<PiSetting> pi_;  // the law's fallback; empty: none
  double pull_{}, allowed_peak_;
  bool refuted_{false};  // too few of the models hold under the present control
};

}  // namespace

bool presentHolds(const CommissioningBrief& brief, const ProcessModels& models) {
  if (!hasPresent(brief)) return true;
  const LinearPoint rest = modelRest(models.fits, countOf(brief.loop.plant_info.inputs));
  const auto held =
      std::count_if(models.ensemble.begin(), models.ensemble.end(), [&](const TsModel& member) {
        LoopFile loop = onModel(brief.loop, member, rest);
        loop.setpoint.initial = loop.simulation.initial_state;
        return atRest(loop).worst_peak <= kMostPresent;
      });
  return 2 * held >= static_cast<std::ptrdiff_t>(models.ensemble.size());
}

LoopFile onModel(const LoopFile& loop, const TsModel& model, const LinearPoint& rest) {
  LoopFile on = loop;
  on.external_plant = false;
  SimulationParams& sim = on.simulation;
  sim.samples = 1;  // a loop that runs may have no end
  const InputLimits& limits = sim.actuator.limits;
  // A run leaves the operator's limits without ending: that is judged.
  std::vector<SignalInfo> ranges;
  for (const SignalInfo& y : model.outputs) {
    const double wide = 10.0 * (y.upper - y.lower);
    ranges.push_back({y.name, y.unit, y.lower - wide, y.upper + wide});
  }
  for (std::size_t j = 0; j < model.inputs.size(); ++j)
    ranges.push_back({model.inputs[j].name, model.inputs[j].unit,
                      std::max(-1e12, limits.lower[static_cast<Index>(j)]),
                      std::min(1e12, limits.upper[static_cast<Index>(j)])});
  const auto made = std::make_shared<ModelPlant>(model, ModelErrors{}, ranges);
  const PlantDescription& about = made->description();
  sim.factory = [model, ranges](const PlantParameters&) {
    return std::make_unique<ModelPlant>(model, ModelErrors{}, ranges);
  };
  sim.parameters.clear();
  sim.outputs = namesOf(model.outputs);
  sim.output_delay_s.clear();
  sim.measured_disturbances = namesOf(loop.plant_info.disturbances);
  sim.instruments = {};
  sim.actuator.drives.clear();
  sim.disturbance = {};
  on.disturbance = {};
  sim.disturbance_commands.clear();
  const auto n_d = countOf(about.disturbances);
  sim.disturbance_nominal.setZero(n_d);
  sim.disturbance_nominal.head(rest.disturbances.size()) = rest.disturbances;
  sim.disturbance_noise_std.setZero(n_d);
  sim.noise_std.setZero(countOf(model.outputs));
  sim.initial_state = rest.outputs;
  sim.actuator.initial = rest.inputs;
  on.setpoint.schedule.clear();
  on.setpoint.commands.clear();
  return on;
}

Design designLaws(const CommissioningBrief& brief, const Vector& noise,
                  const std::string& model_file, const ProcessModels& models,
                  const DesignParams& params) {
  return Designer(brief, noise, model_file, models, params).run();
}

OrderedJson toJson(const Design& d, const PlantInfo& plant) {
  const auto figures = [&](const DesignFigures& f) {
    return OrderedJson{{"tuned_cost", numberOrNull(f.tuned)},
                       {"held_out_costs", f.costs},
                       {"sensitivity_peak", numberOrNull(f.worst_peak)},
                       {"gain_margin", numberOrNull(f.least_gain)},
                       {"delay_margin_s", numberOrNull(f.least_delay_s)}};
  };
  OrderedJson weak = OrderedJson::array();
  for (const WeakDirection& w : d.weak) {
    OrderedJson inputs = OrderedJson::object();
    for (std::size_t j = 0; j < plant.inputs.size(); ++j)
      inputs[plant.inputs[j].name] = w.inputs[static_cast<Index>(j)];
    weak.push_back({{"inputs", inputs}, {"share", w.share}, {"certain", w.certain}});
  }
  return {{"offers", d.offers_law  ? "law"
                     : d.offers_pi ? "pi"
                                   : "none"},
          {"cost_ratio", numberOrNull(d.ratio)},
          {"cost_ratio_bound", numberOrNull(d.ratio_bound)},
          {"models_probed", d.probed},
          {"models_refuted", d.refuted},
          {"present_sensitivity_peak", numberOrNull(d.present_peak)},
          {"present_costs", d.present_costs},
          {"law", figures(d.law_figures)},
          {"pi", figures(d.pi_figures)},
          {"weak_directions", weak},
          {"remarks", d.remarks}};
}

}  // namespace fpc
