#include "tool/loop_margins.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "analysis/rule_models.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/model/local_model.hpp"
#include "fmbpc/model/model_match.hpp"
#include "plant/model_plant.hpp"
#include "runtime/loop_probe.hpp"

namespace fpc::tool {
namespace {

using Eigen::Index;
using Json = OrderedJson;

constexpr double kFires = 0.05;  // weight of a combination of rules that counts at a point
constexpr std::size_t kMostRules = 16;
constexpr std::size_t kCurvePoints = 150;  // of the picture
constexpr double kAny = 1e6;               // a factor that is none

std::string figure(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string timeText(double seconds) {
  if (seconds < 120.0) return figure(seconds) + " s";
  return seconds < 7200.0 ? figure(seconds / 60.0) + " min" : figure(seconds / 3600.0) + " h";
}

Json finiteOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template <typename Signals>
Json valuesOf(const Signals& signals, const Vector& values) {
  Json object = Json::object();
  for (std::size_t i = 0; i < signals.size() && static_cast<Index>(i) < values.size(); ++i)
    object[signals[i].name] = finiteOrNull(values[static_cast<Index>(i)]);
  return object;
}

/// The tightest of all inputs' margins, and of which input if there are several.
struct Tightest {
  double gain_upper{std::numeric_limits<double>::infinity()}, gain_lower{}, phase_deg{180.0};
  double delay_s{std::numeric_limits<double>::infinity()};
};

std::string stableWords(const Tightest& m) {
  std::string words = "stable, ";
  words += m.gain_upper < kAny ? figure(m.gain_upper) + " in gain" : "any gain";
  if (m.gain_lower > 0.02) words += " (not below " + figure(m.gain_lower) + ")";
  words += ", " + (std::isfinite(m.delay_s) ? timeText(m.delay_s) + " in delay" : "any delay");
  return words;
}

Json curveOf(const PulseResponse& response, Index input) {
  const auto& all = response.frequencies();
  const std::size_t stride = std::max<std::size_t>(1, all.size() / kCurvePoints);
  Json curve = {{"rad_s", Json::array()}, {"loop_gain", Json::array()}};
  for (std::size_t i = 0; i < all.size(); i += stride) {
    const auto L = response.loopGain(input, all[i]);
    curve["rad_s"].push_back(all[i]);
    curve["loop_gain"].push_back({finiteOrNull(L.real()), finiteOrNull(L.imag())});
  }
  return curve;
}

void addLinear(const LoopFile& loop, const LoopProbe& probe, bool curves, Json& json) {
  Tightest tightest;
  json["inputs"] = Json::array();
  for (std::size_t i = 0; i < loop.plant_info.inputs.size(); ++i) {
    const auto input = static_cast<Index>(i);
    Json row = {{"input", loop.plant_info.inputs[i].name}, {"at_limit", bool(probe.at_limit[i])}};
    if (!probe.at_limit[i]) {
      const LoopMargins m = probe.response->margins(input);
      tightest.gain_upper = std::min(tightest.gain_upper, m.gain_upper);
      tightest.gain_lower = std::max(tightest.gain_lower, m.gain_lower);
      tightest.phase_deg = std::min(tightest.phase_deg, m.phase_deg);
      tightest.delay_s = std::min(tightest.delay_s, m.delay_s);
      row.update({{"gain_upper", finiteOrNull(m.gain_upper)},
                  {"gain_lower", m.gain_lower},
                  {"phase_deg", m.phase_deg},
                  {"delay_s", finiteOrNull(m.delay_s)},
                  {"crossover_rad_s", m.crossover_rad_s}});
      if (curves) row["curve"] = curveOf(*probe.response, input);
    }
    json["inputs"].push_back(row);
  }
  json["gain_upper"] = finiteOrNull(tightest.gain_upper);
  json["gain_lower"] = tightest.gain_lower;
  json["phase_deg"] = tightest.phase_deg;
  json["delay_s"] = finiteOrNull(tightest.delay_s);
  json["sensitivity_peak"] = probe.response->peak();
  json["verdict"] = stableWords(tightest);
}

std::string swingWords(const LoopFile& loop, const LoopProbe& probe) {
  Index input = 0;
  const InputLimits& limits = loop.simulation.actuator.limits;
  (probe.swing.array() / (limits.upper - limits.lower).array()).maxCoeff(&input);
  const SignalInfo& u = loop.plant_info.inputs[static_cast<std::size_t>(input)];
  std::string words = "swings: " + u.name + " by " + figure(probe.swing[input]) + " " + u.unit;
  if (probe.period_s > 0.0) words += " every " + timeText(probe.period_s);
  return words;
}

Json probeJson(const LoopFile& loop, const LoopProbe& probe, bool curves) {
  Json json = {{"stable", probe.result == ProbeResult::kLinear ? Json(true) : Json(false)}};
  switch (probe.result) {
    case ProbeResult::kLinear:
      addLinear(loop, probe, curves, json);
      break;
    case ProbeResult::kGrows:
      json["growth"] = finiteOrNull(probe.growth);
      json["verdict"] =
          "unstable, a deviation grows by " + figure(100.0 * (probe.growth - 1.0)) + " % a sample";
      break;
    case ProbeResult::kSwings:
      json["period_s"] = probe.period_s;
      json["swing"] = valuesOf(loop.plant_info.inputs, probe.swing);
      json["verdict"] = swingWords(loop, probe);
      break;
    case ProbeResult::kHeld:
      json["stable"] = nullptr;
      json["verdict"] = "no feedback: every input stands at a limit";
      break;
    case ProbeResult::kBends:
      json["stable"] = nullptr;
      json["verdict"] = "not linear there, however small the deviation";
      break;
    case ProbeResult::kFailed:
      json["verdict"] = "lost: " + probe.words;
      break;
  }
  return json;
}

/// The model with one rule of each output, shifted so that it rests at the point.
TsModel oneRule(const TsModel& model, const RuleChoice& choice, const Vector& y, const Vector& u,
                const Vector& d) {
  TsModel one = model;
  for (std::size_t i = 0; i < one.submodels.size(); ++i) {
    OutputModel& submodel = one.submodels[i];
    Rule rule = submodel.rules[choice[i]];
    submodel.antecedents.clear();
    rule.antecedents.clear();
    rule.multivariate.reset();
    const auto valueOf = [&](const Regressor& r) {
      if (r.kind == SignalKind::kOutput) return y[r.index];
      if (r.kind == SignalKind::kInput) return u[r.index];
      return r.kind == SignalKind::kDisturbance ? d[r.index] : 0.0;
    };
    rule.offset = y[static_cast<Index>(i)];
    for (std::size_t j = 0; j < submodel.regressors.size(); ++j)
      rule.offset -= rule.coefficients[static_cast<Index>(j)] * valueOf(submodel.regressors[j]);
    submodel.rules = {rule};
  }
  return one;
}

/// The loop around that model in the place of its plant, at rest there.
LoopFile aroundModel(const LoopFile& staying, const TsModel& model, const LoopProbe& rest,
                     const Vector& measured) {
  LoopFile loop = staying;
  SimulationParams& sim = loop.simulation;
  std::vector<SignalInfo> ranges;
  for (const SignalInfo& y : model.outputs) ranges.push_back({y.name, y.unit, -1e12, 1e12});
  for (std::size_t i = 0; i < model.inputs.size(); ++i)
    ranges.push_back({model.inputs[i].name, model.inputs[i].unit,
                      std::max(-1e12, sim.actuator.limits.lower[static_cast<Index>(i)]),
                      std::min(1e12, sim.actuator.limits.upper[static_cast<Index>(i)])});
  for (const SignalInfo& d : model.disturbances) ranges.push_back({d.name, d.unit, -1e12, 1e12});
  TsModel plain = asIdentified(model);
  sim.factory = [plain, ranges](const PlantParameters&) {
    return std::make_unique<ModelPlant>(plain, ModelErrors{}, ranges);
  };
  sim.parameters.clear();
  sim.initial_state = rest.outputs;
  sim.outputs.clear();
  for (const SignalInfo& y : model.outputs) sim.outputs.push_back(y.name);
  sim.output_delay_s.clear();
  sim.instruments = {};
  sim.actuator.drives.clear();
  sim.actuator.initial = rest.input;
  sim.disturbance = {};
  const auto plant = makePlant(sim);
  sim.disturbance_nominal =
      Vector::Zero(static_cast<Index>(plant->description().disturbances.size()));
  sim.disturbance_nominal.head(measured.size()) = measured;
  sim.disturbance_noise_std.setZero(sim.disturbance_nominal.size());
  loop.setpoint.initial = rest.point.setpoint;
  loop.setpoint.schedule.clear();
  return loop;
}

/// The combinations that fire at the rest, the strongest first.
std::vector<RuleChoice> firing(const TsModel& model, const Vector& y, const Vector& u,
                               const Vector& d) {
  LocalModel local(model);
  Vector state(local.stateSize());
  local.restState(y, u, d, state);
  local.blend(state, d);
  std::vector<std::pair<double, RuleChoice>> all;
  for (const RuleChoice& choice : ruleChoices(model)) {
    double weight = 1.0;
    for (std::size_t i = 0; i < choice.size(); ++i)
      weight *= local.firing()[i].weights[static_cast<Index>(choice[i])];
    if (weight >= kFires) all.emplace_back(weight, choice);
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  if (all.size() > kMostRules) all.resize(kMostRules);
  std::vector<RuleChoice> choices;
  for (auto& [weight, choice] : all) choices.push_back(std::move(choice));
  return choices;
}

/// Unstable before swinging before the smallest gain.
double hardness(const Json& json) {
  if (json["stable"] == false) return 0.0;
  if (!json.contains("gain_upper") || json["gain_upper"].is_null()) return kAny;
  return json["gain_upper"].get<double>();
}

/// The worst of the rules that fire at the rest, taken one by one for the plant.
Json worstRules(const LoopFile& staying, const LoopProbe& rest, const Vector& measured) {
  const TsModel& model = staying.model;
  Json worst = nullptr;
  int count = 0;
  for (const RuleChoice& choice : firing(model, rest.outputs, rest.input, measured)) {
    const TsModel one = oneRule(model, choice, rest.outputs, rest.input, measured);
    const LoopFile loop = aroundModel(staying, one, rest, measured);
    CoursePoint point = rest.point;
    point.step = 0;
    Json json = probeJson(loop, probeLoop(loop, point), false);
    json["rules"] = text(choice);
    ++count;
    if (worst.is_null() || hardness(json) < hardness(worst)) worst = json;
  }
  if (!worst.is_null()) worst["of"] = count;
  return worst;
}

/// What of the disturbances is measured, at the point.
Vector measuredOf(const LoopFile& loop, const CoursePoint& point) {
  const auto plant = makePlant(loop.simulation);
  const auto& all = plant->description().disturbances;
  Vector values(static_cast<Index>(loop.plant_info.disturbances.size()));
  for (Index i = 0; i < values.size(); ++i)
    for (std::size_t j = 0; j < all.size(); ++j)
      if (all[j].name == loop.plant_info.disturbances[static_cast<std::size_t>(i)].name)
        values[i] = point.disturbances[static_cast<Index>(j)];
  return values;
}

bool hasRules(const LoopFile& loop) {
  return loop.has_model && loop.controllerType().needs_model && loop.model.unmeasured.empty();
}

}  // namespace

Json marginsOf(const LoopFile& loop, int points,
               const std::function<void(const std::string&)>& show) {
  require(!loop.controllerType().open_loop, loop.name + ": controller.type",
          "a controller that follows setpoints: an experiment closes no loop");
  const LoopCourse course(loop);
  const auto disturbances = makePlant(loop.simulation)->description().disturbances;
  Json list = Json::array();
  for (const CoursePoint& point : course.points(points)) {
    show("point " + std::to_string(list.size() + 1));
    const LoopFile staying = course.stayingAt(loop, point);
    const LoopProbe probe = probeLoop(staying, point);
    Json json = {{"time_h", point.step * loop.plant_info.sample_time_s / 3600.0},
                 {"setpoint", valuesOf(loop.plant_info.outputs, point.setpoint)},
                 {"disturbances", valuesOf(disturbances, point.disturbances)},
                 {"outputs", valuesOf(loop.plant_info.outputs, probe.outputs)},
                 {"input", valuesOf(loop.plant_info.inputs, probe.input)}};
    json.update(probeJson(loop, probe, true));
    const bool rests = probe.result == ProbeResult::kLinear || probe.result == ProbeResult::kGrows;
    if (rests && hasRules(loop)) {
      show("rules at point " + std::to_string(list.size() + 1));
      json["worst_rules"] = worstRules(staying, probe, measuredOf(loop, point));
    }
    list.push_back(std::move(json));
  }
  return list;
}

std::string marginsText(const Json& points, const Json& units) {
  std::string out = "the loop where its run leads it, without noise\n";
  for (const Json& p : points) {
    std::string where;
    for (const char* group : {"outputs", "input"})
      for (const auto& [name, value] : p[group].items())
        if (value.is_number())
          where += (where.empty() ? "" : ", ") + name + " " + figure(value.get<double>()) +
                   (units.value(name, "-") == "-" ? "" : " " + units.value(name, ""));
    out += "  " + timeText(3600.0 * p["time_h"].get<double>()) + " (" + where +
           "): " + p["verdict"].get<std::string>();
    if (p.contains("sensitivity_peak"))
      out += ", " + figure(p["phase_deg"].get<double>()) + " deg, sensitivity peak " +
             figure(p["sensitivity_peak"].get<double>());
    out += "\n";
    for (const Json& input : p.value("inputs", Json::array()))
      if (input["at_limit"] == true)
        out += "    " + input["input"].get<std::string>() + " stands at a limit\n";
    if (p.contains("worst_rules") && !p["worst_rules"].is_null())
      out += "    worst of the " + std::to_string(p["worst_rules"]["of"].get<int>()) +
             " combinations of rules that fire there, " +
             p["worst_rules"]["rules"].get<std::string>() + ": " +
             p["worst_rules"]["verdict"].get<std::string>() + "\n";
  }
  return out;
}

}  // namespace fpc::tool
