#include "tool/stability_report.hpp"

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

std::string objectText(const Json& object) {
  std::string text;
  for (const auto& [key, value] : object.items())
    text += (text.empty() ? "" : ", ") + key + " = " + number(value.get<double>(), "%.6g");
  return text;
}

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
  std::string out = "model " + r["model"].get<std::string>() + " at " +
                    objectText(r["at"]["inputs"]) + "; " + objectText(r["at"]["disturbances"]) +
                    "\n\nequilibria of the model\n";
  for (const auto& e : r["equilibria"])
    out += "  " + objectText(e["outputs"]) +
           (e["stable"].get<bool>() ? "  stable  " : "  UNSTABLE  ") +
           valuesText(e["eigenvalues"]) + "\n";
  if (r["equilibria"].empty()) out += "  none found; blended at the given outputs instead\n";
  out += "\nH = " + std::to_string(r["law"]["coincidence_steps"].get<int>()) +
         "\n  rules    |open|     rho   |closed|  stable from H  closed-loop eigenvalues\n";
  out += linearText("blended", r["blended"]);
  for (const auto& rule : r["rules"]) out += linearText(rule["rules"].get<std::string>(), rule);
  out += "\nblended loop over the horizon\n";
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

std::string branchesText(const Json& s) {
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
             objectText(p["state"]) + "\n";
    }
  }
  return out;
}

}  // namespace

std::string stabilityTable(const Json& report) {
  std::string out = report["name"].get<std::string>() + "\n";
  if (report.contains("note")) out += "warning: " + report["note"].get<std::string>() + "\n";
  if (report.contains("model")) out += modelText(report) + certificateText(report["certificate"]);
  if (report.contains("advice")) {
    out += "\nadvice\n";
    for (const auto& reason : report["advice"]["reasons"])
      out += "  " + reason.get<std::string>() + "\n";
  }
  if (report.contains("steady_states")) out += branchesText(report["steady_states"]);
  return out;
}

}  // namespace fpc::tool
