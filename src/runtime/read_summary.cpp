// summary.json read back, for tables of runs that other processes made.
#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/finite_json.hpp"
#include "base/ordered_json.hpp"
#include "fmbpc/base/input_error.hpp"
#include "runtime/report.hpp"

namespace fpc {
namespace {

using Json = OrderedJson;

/// An index that a run does not have (no setpoint was followed) is null.
double numberOf(const Json& y, const char* key) {
  return y.at(key).is_null() ? std::nan("") : y.at(key).get<double>();
}

void readOutputs(const Json& json, Summary& summary) {
  for (const auto& [name, y] : json.items()) {
    summary.output_names.push_back(name);
    summary.output_units.push_back(y.value("unit", ""));
    summary.outputs.push_back(
        {numberOf(y, "ise"), numberOf(y, "iae"), numberOf(y, "itae"), numberOf(y, "itse"),
         numberOf(y, "rmse"), numberOf(y, "ise_reference"), y.value("rejected", std::uint64_t{0})});
    if (y.contains("controlled")) summary.controlled.push_back(y.at("controlled"));
    if (!y.contains("windows")) continue;
    for (const Json& w : y.at("windows"))
      summary.windows.push_back({{w.at("name"), name, w.at("from_h"), w.at("to_h")},
                                 name,
                                 numberOf(w, "rmse"),
                                 numberOf(w, "mean_error"),
                                 w.at("samples")});
  }
}

void readInputs(const Json& json, Summary& summary) {
  for (const auto& [name, u] : json.items()) {
    summary.input_names.push_back(name);
    summary.input_units.push_back(u.value("unit", ""));
    summary.inputs.push_back(
        {u.at("min"), u.at("max"), u.at("mean_abs_move"), u.at("travel"), u.at("switches")});
  }
}

void readClp(const Json& json, Summary& summary) {
  summary.has_clp = true;
  summary.clp_solves = json.at("solves");
  summary.clp_infeasible = json.at("infeasible");
  summary.clp_failed = json.at("failed");
  summary.clp_median_us = json.at("median_us");
  summary.clp_p99_us = json.at("p99_us");
}

/// Bounds of the inputs; null: none.
void readLimits(const Json& json, Summary& summary) {
  const auto size = static_cast<Eigen::Index>(json.size());
  summary.limits = {Vector(size), Vector(size), Vector::Constant(size, kInfinity)};
  Eigen::Index i = 0;
  for (const auto& [name, u] : json.items()) {
    summary.limits.lower[i] = u.at("lower").is_null() ? -kInfinity : u.at("lower").get<double>();
    summary.limits.upper[i] = numberOrInfinity(u.at("upper"));
    ++i;
  }
}

Summary summaryOf(const Json& json) {
  Summary summary;
  summary.loop = json.at("loop");
  summary.title = json.value("title", "");
  summary.run_id = json.value("run_id", std::uint64_t{0});
  summary.first_step = json.value("first_step", 0U);
  summary.complete = json.at("complete");
  summary.failed_samples = json.value("failed_samples", 0U);
  summary.trouble = json.value("trouble", "");
  summary.steps = json.at("steps");
  summary.wall_s = json.at("wall_s");
  readOutputs(json.at("outputs"), summary);
  readInputs(json.at("inputs"), summary);
  const Json& violations = json.at("violations");
  summary.input_violations = violations.at("input");
  summary.move_violations = violations.at("move");
  summary.output_violations = violations.at("output");
  summary.actuator_clips = json.at("actuator_clips");
  summary.sources.assign(1, 0);
  if (json.contains("sources"))
    for (const auto& [name, count] : json.at("sources").items()) summary.sources.push_back(count);
  if (json.contains("events"))
    for (const Json& event : json.at("events"))
      summary.events.push_back({eventCode(event.at("code")), event.at("signal"), event.at("text"),
                                event.at("first"), event.at("last"), event.at("count")});
  if (json.contains("limits")) readLimits(json.at("limits").at("inputs"), summary);
  summary.outside_model = json.value("outside_model", std::uint64_t{0});
  if (json.contains("clp")) readClp(json.at("clp"), summary);
  return summary;
}

}  // namespace

Summary readSummary(const std::string& file) {
  std::ifstream stream(file);
  require(stream.good(), file, "a readable file");
  try {
    return summaryOf(Json::parse(stream));
  } catch (const Json::exception& error) {
    throw InputError(file + ": expected a summary of `fmbpc run --out`: " + error.what());
  }
}

}  // namespace fpc
