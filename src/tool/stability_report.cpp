#include "tool/stability_report.hpp"

#include "tool/loop_margins.hpp"

#include <cmath>
#include <cstdio>

namespace fpc::tool {
namespace {

/// What rounds to zero has no sign.
std::string number(double value, const char* format = "%.5g") {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  const bool zero = std::string(text).find_first_of("123456789") == std::string::npos;
  return zero && text[0] == '-' ? text + 1 : text;
}

std::string valuesText(const Json& values) {
  std::string text;
  for (const auto& value : values) {
    const double re = value[0].get<double>(), im = value[1].get<double>();
    if (im < 0.0) continue;
    text += (text.empty() ? "" : ", ") + number(re, "%.4f");
    if (im > 0.0) text += " +- " + number(im, "%.4f") + "i";
  }
  return text.empty() ? "-" : text;
}

/// "s = 54.1531 mg/l, x = 2024.25 mg/l"
std::string objectText(const Json& object, const Json& units) {
  std::string text;
  for (const auto& [key, value] : object.items()) {
    const std::string unit = units.value(key, "");
    text += (text.empty() ? "" : ", ") + key + " = " + number(value.get<double>(), "%.6g") +
            (unit.empty() || unit == "-" ? "" : " " + unit);
  }
  return text;
}

/// Inputs, then disturbances if there are any.
std::string pointText(const Json& at, const Json& units) {
  const std::string disturbances = objectText(at["disturbances"], units);
  return objectText(at["inputs"], units) + (disturbances.empty() ? "" : "; ") + disturbances;
}

constexpr char kStabilityLegend[] =
    "H: coincidence horizon [samples]. rules: the rule of each output; blended: all of them,\n"
    "weighted at the point. |open|, |closed|: largest modulus of the eigenvalues of the model and\n"
    "of the loop, below 1 is stable; rho: relative degree [samples]; stable from H: the least\n"
    "horizon from which on all that were looked at are stable, 0: none.\n";

std::string linearText(const std::string& name, const Json& j) {
  char line[400];
  std::snprintf(
      line, sizeof line, "  %-8s %-10s %3d   %-10s %6d   %s\n", name.c_str(),
      number(j["open_radius"].get<double>()).c_str(), j["relative_degree"].get<int>(),
      j["applicable"].get<bool>() ? number(j["closed_radius"].get<double>()).c_str() : "-",
      j["smallest_stable_horizon"].get<int>(), valuesText(j["closed_loop"]).c_str());
  return line;
}

std::string modelText(const Json& r) {
  const Json& units = r["units"];
  std::string out = "model " + r["model"].get<std::string>() + " at " + pointText(r["at"], units) +
                    "\n\nequilibria of the model, and the eigenvalues there\n";
  for (const auto& e : r["equilibria"])
    out += "  " + objectText(e["outputs"], units) +
           (e["stable"].get<bool>() ? "  stable  " : "  UNSTABLE  ") +
           valuesText(e["eigenvalues"]) + "\n";
  if (r["equilibria"].empty()) out += "  none found; blended at the given outputs instead\n";
  out += "\nH = " + std::to_string(r["law"]["coincidence_steps"].get<int>()) +
         "\n  rules    |open|     rho   |closed|  stable from H  closed-loop eigenvalues\n";
  out += linearText("blended", r["blended"]);
  for (const auto& rule : r["rules"]) out += linearText(rule["rules"].get<std::string>(), rule);
  out +=
      std::string("\n") + kStabilityLegend + "\nblended loop over the horizon: its eigenvalues\n";
  for (const auto& row : r["horizon"]) {
    const int H = row["coincidence_steps"].get<int>();
    if (H > 10 && H % 50 != 0) continue;
    out += "  H " + std::to_string(H) + ": " +
           (row["applicable"].get<bool>() ? valuesText(row["eigenvalues"]) : "not applicable") +
           "\n";
  }
  return out;
}

std::string certificateText(const Json& c) {
  std::string out = "\ncommon quadratic Lyapunov function over the closed loops of " +
                    std::to_string(c["applicable"].get<int>()) + " of " +
                    std::to_string(c["of"].get<int>()) +
                    " rule combinations: " + c["status"].get<std::string>();
  if (c.contains("decay")) out += ", decay " + number(c["decay"].get<double>()) + " a sample";
  out += "\n";
  if (!c.contains("region")) return out;
  std::string rules;
  for (const auto& rule : c["region"]["rules"])
    rules += (rules.empty() ? "" : " ") + rule.get<std::string>();
  out += "  largest set found (" + c["region"]["chosen"].get<std::string>() +
         "): " + (rules.empty() ? "none" : rules);
  if (c["region"].contains("decay"))
    out += ", decay " + number(c["region"]["decay"].get<double>()) + " a sample";
  return out + "\n";
}

std::string branchesText(const Json& s, const Json& units) {
  std::string out = "\nsteady states of the plant over " + s["input"].get<std::string>() + " [" +
                    s["input_unit"].get<std::string>() + "] from " +
                    number(s["input_lower"].get<double>()) + " to " +
                    number(s["input_upper"].get<double>()) +
                    (s["map"].get<bool>() ? ", as a map from sample to sample" : "") + "\n";
  if (s["cut"].get<bool>())
    out += "  not looked at: the rest of " + number(s["limit_lower"].get<double>()) + " to " +
           number(s["limit_upper"].get<double>()) +
           ", the plant's range (actuator.input_lower and input_upper say how far)\n";
  for (const auto& branch : s["branches"]) {
    out += "  branch of " + std::to_string(branch["points"].size()) + " points" +
           (branch["closed"].get<bool>() ? ", closed" : "") + "\n";
    for (const auto& p : branch["special"]) {
      std::string kind = p["kind"].get<std::string>();
      if (p.contains("of")) kind += " of " + p["of"].get<std::string>();
      out += "    " + kind + " at " + number(p["input"].get<double>(), "%.7g") + ": " +
             objectText(p["state"], units) + "\n";
    }
  }
  return out;
}

}  // namespace

Json unitsOf(const StabilitySubject& s) {
  Json units = Json::object();
  const auto add = [&units](const auto& signals) {
    for (const auto& signal : signals) units[signal.name] = signal.unit;
  };
  if (s.plant) {
    add(s.plant->description().states);
    add(s.plant->description().inputs);
  }
  add(s.model.outputs);
  add(s.model.inputs);
  add(s.model.disturbances);
  return units;
}

std::string stabilityTable(const Json& report) {
  std::string out = report["name"].get<std::string>() + "\n";
  if (report.contains("note")) out += "warning: " + report["note"].get<std::string>() + "\n";
  if (report.contains("points")) out += marginsText(report["points"], report["units"]) + "\n";
  if (report.contains("model")) out += modelText(report) + certificateText(report["certificate"]);
  if (report.contains("advice")) {
    out += "\nadvice\n";
    for (const auto& reason : report["advice"]["reasons"])
      out += "  " + reason.get<std::string>() + "\n";
  }
  if (report.contains("steady_states"))
    out += branchesText(report["steady_states"], report["units"]);
  return out;
}

}  // namespace fpc::tool
