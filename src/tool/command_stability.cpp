// fmbpc stability MODEL|LOOP: steady states, eigenvalues over the horizon, zeros, a certificate.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <numeric>

#include "analysis/common_lyapunov.hpp"
#include "analysis/horizon_advisor.hpp"
#include "analysis/transfer.hpp"
#include "base/files.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/model/local_model.hpp"
#include "runtime/plant_continuation.hpp"
#include "runtime/plot.hpp"
#include "tool/commands.hpp"
#include "tool/loop_margins.hpp"
#include "tool/stability_report.hpp"
#include "tool/stability_subject.hpp"

namespace fpc::tool {
namespace {

class Stage {
 public:
  Stage() : shown_(isatty(STDERR_FILENO) != 0) {}
  ~Stage() {
    if (shown_) std::fprintf(stderr, "\r\033[K");
  }
  void show(const char* what) const {
    if (shown_) std::fprintf(stderr, "\r\033[K%s ...", what);
  }

 private:
  bool shown_;
};

std::pair<int, int> parseHorizon(const std::string& text) {
  int first = 0, last = 0, read = 0;
  const int count = std::sscanf(text.c_str(), "%d..%d%n", &first, &last, &read);
  require(count == 2 && read == static_cast<int>(text.size()) && first >= 1 && last >= first &&
              last <= 100000,
          "--horizon", "FIRST..LAST with 1 <= FIRST <= LAST <= 100000");
  return {first, last};
}

Json jsonOf(const Eigenvalues& values) {
  Json list = Json::array();
  for (const auto& value : values) list.push_back({value.real(), value.imag()});
  return list;
}

/// By rows.
Json jsonOf(const Matrix& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    rows.push_back(Json::array());
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) rows.back().push_back(matrix(i, j));
  }
  return rows;
}

Json jsonOf(const std::vector<SignalInfo>& signals, const Vector& values) {
  Json object = Json::object();
  for (std::size_t i = 0; i < signals.size(); ++i)
    object[signals[i].name] = values[static_cast<Eigen::Index>(i)];
  return object;
}

Json pointOf(const StabilitySubject& s) {
  Json at = {{"outputs", jsonOf(s.model.outputs, s.outputs)},
             {"inputs", jsonOf(s.model.inputs, s.input)},
             {"disturbances", jsonOf(s.model.disturbances, s.disturbances)}};
  return at;
}

Json equilibriaOf(const StabilitySubject& s) {
  Json list = Json::array();
  for (const auto& rest : s.equilibria)
    list.push_back({{"outputs", jsonOf(s.model.outputs, rest.outputs)},
                    {"stable", rest.stable()},
                    {"eigenvalues", jsonOf(rest.values)}});
  return list;
}

Json linearOf(const LinearModel& model, const LoopLaw& law, int longest) {
  const Transfer transfer = transferOf(model.affine, 0, model.affine.C.rows() - 1);
  const ClosedLoop loop = closeLoop(model, law);
  return {{"open_loop", jsonOf(transfer.poles)},
          {"open_radius", spectralRadius(transfer.poles)},
          {"relative_degree", transfer.relative_degree},
          {"zeros", jsonOf(transfer.zeros)},
          {"applicable", loop.applicable},
          {"closed_loop", jsonOf(loop.values)},
          {"closed_radius", loop.applicable ? Json(spectralRadius(loop.values)) : Json(nullptr)},
          {"smallest_stable_horizon", smallestStableHorizon(model, law, longest)}};
}

Json overHorizon(const LinearModel& model, LoopLaw law, std::pair<int, int> range) {
  Json list = Json::array();
  for (law.coincidence_steps = range.first; law.coincidence_steps <= range.second;
       ++law.coincidence_steps) {
    const ClosedLoop loop = closeLoop(model, law);
    Json row = {{"coincidence_steps", law.coincidence_steps}, {"applicable", loop.applicable}};
    if (loop.applicable) {
      row["radius"] = spectralRadius(loop.values);
      row["eigenvalues"] = jsonOf(loop.values);
    }
    list.push_back(row);
  }
  return list;
}

/// Distance of a combination of rules from the point: how little its rules fire there.
std::vector<std::size_t> nearestFirst(const StabilitySubject& s,
                                      const std::vector<RuleChoice>& choices) {
  LocalModel local(s.model);
  Vector rest(local.stateSize());
  local.restState(s.outputs, s.input, s.disturbances, rest);
  local.blend(rest, s.disturbances);
  const auto weight = [&](std::size_t c) {
    double product = 1.0;
    for (std::size_t i = 0; i < choices[c].size(); ++i)
      product *= local.firing()[i].weights[static_cast<Eigen::Index>(choices[c][i])];
    return product;
  };
  std::vector<std::size_t> order(choices.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return weight(a) > weight(b); });
  return order;
}

const char* word(LyapunovStatus status) {
  switch (status) {
    case LyapunovStatus::kFound:
      return "found";
    case LyapunovStatus::kNone:
      return "none";
    case LyapunovStatus::kNoSolver:
      return "csdp not installed";
    default:
      return "solver failed";
  }
}

/// What others need to check it.
void addTo(Json& json, const CommonLyapunov& certificate) {
  if (!certificate.ok()) return;
  json["decay"] = certificate.decay;
  json["P"] = jsonOf(certificate.P);
}

Json certificateOf(const StabilitySubject& s, const std::vector<RuleChoice>& choices) {
  std::vector<Matrix> maps;
  std::vector<RuleChoice> usable;
  for (const std::size_t c : nearestFirst(s, choices)) {
    const ClosedLoop loop = closeLoop(ruleModel(s.model, choices[c], s.disturbances), s.law);
    if (!loop.applicable) continue;
    maps.push_back(loop.A);
    usable.push_back(choices[c]);
  }
  Json json = {{"of", choices.size()}, {"applicable", maps.size()}, {"maps", Json::array()}};
  for (std::size_t i = 0; i < maps.size(); ++i)
    json["maps"].push_back({{"rules", text(usable[i])}, {"A", jsonOf(maps[i])}});
  if (maps.empty()) {
    json["status"] = "none";
    return json;
  }
  const CommonLyapunov whole = commonLyapunov(maps);
  json["status"] = word(whole.status);
  addTo(json, whole);
  if (whole.ok() || whole.status == LyapunovStatus::kNoSolver) return json;
  std::vector<std::size_t> order(maps.size());
  std::iota(order.begin(), order.end(), 0U);
  const CertifiedRegion region = largestRegion(maps, order);
  Json members = Json::array();
  for (const std::size_t i : region.members) members.push_back(text(usable[i]));
  json["region"] = {{"rules", members},
                    {"chosen", "by firing weight at the point, kept while a common P remains"},
                    {"status", word(region.certificate.status)}};
  addTo(json["region"], region.certificate);
  return json;
}

/// The loop's limits of the first input, or its usual range where these are not said; an input that
/// cannot be negative begins at a hundredth.
PlantContinuation continuationOf(const StabilitySubject& s) {
  PlantContinuation set = plantContinuation(s.plant, 0, s.sample_time_s, -1.0, -1.0);
  if (s.upper_said) set.params.upper = s.input_upper;
  if (s.lower_said) set.params.lower = s.input_lower;
  if (set.params.lower >= 0.0) set.params.lower = std::max(s.input_lower, 0.01 * set.params.upper);
  return set;
}

Json branchesOf(const StabilitySubject& s) {
  const PlantContinuation set = continuationOf(s);
  const auto& states = s.plant->description().states;
  const auto stateOf = [&](const Vector& x) {
    Json object = Json::object();
    for (std::size_t i = 0; i < states.size(); ++i)
      object[states[i].name] = x[static_cast<Eigen::Index>(i)];
    return object;
  };
  const bool cut_below = s.input_lower < 0.0 && set.params.lower > s.input_lower;
  const bool cut = cut_below || set.params.upper < s.input_upper;
  Json list = Json::array();
  for (const auto& branch : continueBranches(set.problem, set.params)) {
    Json points = Json::array(), special = Json::array();
    for (const auto& p : branch.points)
      points.push_back(
          {{"input", p.parameter}, {"state", stateOf(p.state)}, {"unstable", p.unstable}});
    for (const auto& p : branch.special) {
      special.push_back(
          {{"kind", name(p.kind)}, {"input", p.parameter}, {"state", stateOf(p.state)}});
      if (p.turning_state >= 0)
        special.back()["of"] = states[static_cast<std::size_t>(p.turning_state)].name;
    }
    list.push_back({{"closed", branch.closed}, {"special", special}, {"points", points}});
  }
  return {{"input", s.plant->description().inputs[0].name},
          {"input_unit", s.plant->description().inputs[0].unit},
          {"input_lower", set.params.lower},
          {"input_upper", set.params.upper},
          {"limit_lower", s.input_lower},
          {"limit_upper", s.input_upper},
          {"cut", cut},
          {"output", s.plant->description().outputs.back()},
          {"map", set.problem.map},
          {"branches", list}};
}

Json adviceOf(const LinearModel& model, const LoopLaw& law, const StabilityArguments& a) {
  require(a.noise_gain > 0.0 && a.settling > 0, "--noise-gain, --settling", "both, numbers > 0");
  const HorizonAdvice advice = adviseHorizon(model, law, {a.noise_gain, a.settling});
  return {{"found", advice.found},
          {"coincidence_steps", advice.coincidence_steps},
          {"reference_pole", advice.reference_pole},
          {"noise_gain", advice.figures.noise_gain},
          {"reasons", advice.reasons}};
}

/// Options that only an analysed law understands.
void refuseWithoutLaw(const StabilitySubject& s, const StabilityArguments& a) {
  const std::pair<const char*, bool> asked[] = {
      {"--horizon", a.horizon != StabilityArguments().horizon},
      {"--noise-gain", a.noise_gain != 0.0},
      {"--settling", a.settling != 0}};
  for (const auto& [option, given] : asked)
    require(s.has_model || !given, option,
            "a loop or model with a law that is analysed, which " + s.name + " is not");
}

Json reportOf(const StabilitySubject& s, const StabilityArguments& a) {
  const auto range = parseHorizon(a.horizon);
  refuseWithoutLaw(s, a);
  const Stage stage;
  Json json = {{"name", s.name}, {"units", unitsOf(s)}};
  if (!s.note.empty()) json["note"] = s.note;
  if (s.has_model) {
    stage.show("rules");
    json["model"] = s.model.name;
    json["law"] = {{"published", s.law.published}, {"coincidence_steps", s.law.coincidence_steps}};
    json["at"] = pointOf(s);
    json["equilibria"] = equilibriaOf(s);
    const LinearModel blended = blendedModel(s.model, s.outputs, s.input, s.disturbances);
    json["blended"] = linearOf(blended, s.law, range.second);
    const auto choices = ruleChoices(s.model);
    json["rules"] = Json::array();
    for (const auto& choice : choices) {
      json["rules"].push_back({{"rules", text(choice)}});
      json["rules"].back().update(
          linearOf(ruleModel(s.model, choice, s.disturbances), s.law, range.second));
    }
    stage.show("horizons");
    json["horizon"] = overHorizon(blended, s.law, range);
    stage.show("certificate");
    json["certificate"] = certificateOf(s, choices);
    if (a.noise_gain != 0.0 || a.settling != 0) json["advice"] = adviceOf(blended, s.law, a);
  }
  const bool follows = s.loop && !s.loop->controllerType().open_loop;
  if (follows && a.points > 0)
    json["points"] = marginsOf(*s.loop, a.points,
                               [&stage](const std::string& what) { stage.show(what.c_str()); });
  stage.show("steady states");
  if (s.plant) json["steady_states"] = branchesOf(s);
  return json;
}

}  // namespace

Json stabilityReport(const StabilityArguments& arguments) {
  require(arguments.points >= 0 && arguments.points <= 100, "points", "0 to 100");
  return reportOf(readSubject(arguments.name, arguments.set, arguments.at, arguments.on_model),
                  arguments);
}

int stability(const StabilityArguments& arguments) {
  const Json report = stabilityReport(arguments);
  std::cout << (arguments.json ? report.dump(2) + "\n" : stabilityTable(report));
  if (arguments.out.empty()) return 0;
  makeFolder(arguments.out);
  writeText(report.dump(1) + "\n", inFolder(arguments.out, "stability.json"));
  if (arguments.no_plot) return 0;
  const PlotResult plot = drawStability(arguments.out);
  if (!plot.warning.empty()) std::fprintf(stderr, "fmbpc: warning: %s\n", plot.warning.c_str());
  return 0;
}

}  // namespace fpc::tool
