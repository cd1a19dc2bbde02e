#include "fmbpc/loop/report.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "fmbpc/base/csv.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kSourceNames[] = {"",     "base",   "constrained", "clipped",
                                        "held", "manual", "fallback"};

/// JSON has no infinity: an absent limit is null.
Json limit(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json outputsOf(const Summary& summary) {
  Json outputs = Json::object();
  for (std::size_t i = 0; i < summary.outputs.size(); ++i) {
    const OutputIndices& y = summary.outputs[i];
    Json& output = outputs[summary.output_names[i]];
    output = {{"unit", i < summary.output_units.size() ? summary.output_units[i] : ""},
              {"ise", y.ise},
              {"iae", y.iae},
              {"itae", y.itae},
              {"itse", y.itse},
              {"rmse", y.rmse},
              {"ise_reference", y.ise_reference}};
    for (const WindowIndices& w : summary.windows)
      if (w.output == summary.output_names[i])
        output["windows"].push_back({{"name", w.window.name},
                                     {"from_h", w.window.from_h},
                                     {"to_h", w.window.to_h},
                                     {"rmse", w.rmse},
                                     {"mean_error", w.mean_error},
                                     {"samples", w.samples}});
  }
  return outputs;
}

Json inputsOf(const Summary& summary) {
  Json inputs = Json::object();
  for (std::size_t i = 0; i < summary.inputs.size(); ++i) {
    const InputIndices& u = summary.inputs[i];
    inputs[summary.input_names[i]] = {
        {"unit", i < summary.input_units.size() ? summary.input_units[i] : ""},
        {"min", u.min},
        {"max", u.max},
        {"mean_abs_move", u.mean_abs_move},
        {"switches", u.switches},
        {"travel", u.travel}};
  }
  return inputs;
}

Json limitsOf(const Summary& summary) {
  Json inputs = Json::object(), outputs = Json::object();
  for (std::size_t i = 0; i < summary.input_names.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    inputs[summary.input_names[i]] = {{"lower", limit(summary.limits.lower[k])},
                                      {"upper", limit(summary.limits.upper[k])},
                                      {"move", limit(summary.limits.move[k])}};
  }
  for (std::size_t i = 0; i < summary.output_names.size(); ++i)
    outputs[summary.output_names[i]] = {{"lower", limit(summary.output_lower[i])},
                                        {"upper", limit(summary.output_upper[i])}};
  return {{"inputs", inputs}, {"outputs", outputs}};
}

/// Columns of a table, filled row by row from the samples of a record.
class Columns {
 public:
  using Value = std::function<double(std::size_t)>;
  void add(const std::string& name, const std::string& unit, Value value) {
    table_.names.push_back(name);
    table_.units.push_back(unit);
    values_.push_back(std::move(value));
  }
  CsvTable fill(std::size_t first, std::size_t end) {
    table_.values.resize(static_cast<Eigen::Index>(end - first),
                         static_cast<Eigen::Index>(values_.size()));
    for (std::size_t c = 0; c < values_.size(); ++c)
      for (std::size_t r = first; r < end; ++r)
        table_.values(static_cast<Eigen::Index>(r - first), static_cast<Eigen::Index>(c)) =
            values_[c](r);
    return table_;
  }

 private:
  CsvTable table_;
  std::vector<Value> values_;
};

void addOutputs(const RunRecord& record, Columns& columns) {
  const auto& samples = record.samples;
  for (std::size_t i = 0; i < record.info.outputs.size(); ++i) {
    const SignalInfo& y = record.info.outputs[i];
    const auto k = static_cast<Eigen::Index>(i);
    columns.add(y.name, y.unit, [&samples, k](std::size_t r) {
      return samples[r].has_measurement ? samples[r].measurement.outputs[k] : kMissing;
    });
  }
}

void addInputs(const RunRecord& record, Columns& columns) {
  const auto& samples = record.samples;
  for (std::size_t i = 0; i < record.info.inputs.size(); ++i) {
    const SignalInfo& u = record.info.inputs[i];
    const auto k = static_cast<Eigen::Index>(i);
    columns.add(u.name, u.unit, [&samples, k](std::size_t r) {
      const bool known = r + 1 < samples.size() && samples[r + 1].has_measurement;
      return known ? samples[r + 1].measurement.input_applied[k] : kMissing;
    });
  }
}

/// The true disturbances where the simulator tells them, else the measured ones.
void addDisturbances(const LoopFile& loop, const RunRecord& record, Columns& columns) {
  const auto& samples = record.samples;
  if (!record.states.empty()) {
    const auto all = makePlant(loop.simulation)->description().disturbances;
    for (std::size_t i = 0; i < all.size(); ++i)
      columns.add(all[i].name, all[i].unit,
                  [&samples, k = static_cast<Eigen::Index>(i)](std::size_t r) {
                    return samples[r].has_state ? samples[r].state.disturbances[k] : kMissing;
                  });
    return;
  }
  for (std::size_t i = 0; i < record.info.disturbances.size(); ++i)
    columns.add(record.info.disturbances[i].name, record.info.disturbances[i].unit,
                [&samples, k = static_cast<Eigen::Index>(i)](std::size_t r) {
                  return samples[r].has_measurement ? samples[r].measurement.disturbances[k]
                                                    : kMissing;
                });
}

void addTracking(const RunRecord& record, Columns& columns) {
  const auto& samples = record.samples;
  for (std::size_t i = 0; i < record.info.outputs.size(); ++i) {
    const SignalInfo& y = record.info.outputs[i];
    const auto k = static_cast<Eigen::Index>(i);
    columns.add(y.name + "_setpoint", y.unit, [&samples, k](std::size_t r) {
      return samples[r].has_tracking ? samples[r].tracking.setpoint[k] : kMissing;
    });
    columns.add(y.name + "_reference", y.unit, [&samples, k](std::size_t r) {
      return samples[r].has_tracking ? samples[r].tracking.reference[k] : kMissing;
    });
    if (record.states.empty()) continue;
    columns.add(y.name + "_true", y.unit, [&samples, k](std::size_t r) {
      return samples[r].has_state ? samples[r].state.outputs[k] : kMissing;
    });
  }
}

void addActions(const LoopFile& loop, const RunRecord& record, Columns& columns) {
  const auto& samples = record.samples;
  for (std::size_t i = 0; i < record.info.inputs.size(); ++i) {
    const SignalInfo& u = record.info.inputs[i];
    const auto k = static_cast<Eigen::Index>(i);
    columns.add(u.name + "_commanded", u.unit, [&samples, k](std::size_t r) {
      return samples[r].has_action ? samples[r].action.input[k] : kMissing;
    });
    columns.add(u.name + "_base", u.unit, [&samples, k](std::size_t r) {
      return samples[r].has_base ? samples[r].base.input[k] : kMissing;
    });
    if (!loop.has_clp) continue;
    columns.add(u.name + "_perturbation", u.unit, [&samples, k](std::size_t r) {
      const Vector& c = samples[r].report.perturbation;
      return samples[r].has_report && k < c.size() ? c[k] : kMissing;
    });
  }
}

void addOtherStates(const RunRecord& record, Columns& columns) {
  const auto& samples = record.samples;
  for (std::size_t i = 0; i < record.states.size(); ++i) {
    bool is_output = false;
    for (const auto& output : record.info.outputs)
      is_output = is_output || output.name == record.states[i];
    if (is_output) continue;
    columns.add(record.states[i], record.state_units[i],
                [&samples, k = static_cast<Eigen::Index>(i)](std::size_t r) {
                  return samples[r].has_state ? samples[r].state.state[k] : kMissing;
                });
  }
}

}  // namespace

std::string toJson(const Summary& summary) {
  Json json;
  json["loop"] = summary.loop;
  json["title"] = summary.title;
  json["complete"] = summary.complete;
  json["failed_samples"] = summary.failed_samples;
  if (!summary.trouble.empty()) json["trouble"] = summary.trouble;
  json["steps"] = summary.steps;
  json["wall_s"] = summary.wall_s;
  json["outputs"] = outputsOf(summary);
  json["inputs"] = inputsOf(summary);
  json["violations"] = {{"input", summary.input_violations},
                        {"move", summary.move_violations},
                        {"output", summary.output_violations}};
  json["actuator_clips"] = summary.actuator_clips;
  if (summary.has_clp)
    json["clp"] = {{"solves", summary.clp_solves},
                   {"infeasible", summary.clp_infeasible},
                   {"failed", summary.clp_failed},
                   {"median_us", summary.clp_median_us},
                   {"p99_us", summary.clp_p99_us}};
  json["sources"] = Json::object();
  for (std::size_t i = 1; i < summary.sources.size(); ++i)
    json["sources"][kSourceNames[i]] = summary.sources[i];
  json["remarks"] = Json::array();
  for (const RunRemark& remark : summary.remarks)
    json["remarks"].push_back(
        {{"words", remark.words}, {"samples", remark.samples}, {"first", remark.first}});
  json["locked"] = Json::array();
  for (const LockUp& lock : summary.locked)
    json["locked"].push_back({{"input", lock.input},
                              {"limit", lock.upper ? "upper" : "lower"},
                              {"samples", lock.samples}});
  for (const auto& [name, value] : summary.consumption) json[name] = value;
  json["repaired_cells"] = summary.repaired_cells;
  json["implausible_cells"] = summary.implausible_cells;
  json["outside_model"] = summary.outside_model;
  json["limits"] = limitsOf(summary);
  return json.dump(2);
}

CsvTable trajectoryOf(const LoopFile& loop, const RunRecord& record) {
  Columns columns;
  const SampleClock clock(loop.plant_info.sample_time_s, loop.simulation.start_time_s);
  columns.add("time", "h",
              [&clock](std::size_t r) { return clock.hoursAt(static_cast<std::uint32_t>(r)); });
  addOutputs(record, columns);
  addInputs(record, columns);
  addDisturbances(loop, record, columns);
  addTracking(record, columns);
  addActions(loop, record, columns);
  addOtherStates(record, columns);
  const double from = std::ceil(loop.report.record_from_h * 3600.0 /
                                loop.plant_info.sample_time_s - 1e-6);
  const std::size_t last = record.samples.empty() ? 0 : record.samples.size() - 1;
  return columns.fill(std::min(static_cast<std::size_t>(std::max(from, 0.0)), last),
                      record.samples.size());
}

void writeRun(const LoopFile& loop, const RunRecord& record, const Summary& summary,
              const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  require(!error, folder, "a folder that can be made (" + error.message() + ")");
  writeCsv(trajectoryOf(loop, record),
           (std::filesystem::path(folder) / "trajectory.csv").string());
  const std::string file = (std::filesystem::path(folder) / "summary.json").string();
  std::ofstream stream(file);
  stream << toJson(summary) << "\n";
  stream.close();
  require(!stream.fail(), file, "a writable file");
}

}  // namespace fpc
