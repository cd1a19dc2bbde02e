#include "runtime/report.hpp"

#include <algorithm>
#include <utility>

#include "base/files.hpp"
#include "base/finite_json.hpp"
#include "base/ordered_json.hpp"
#include "runtime/run_summary.hpp"
#include "runtime/trajectory.hpp"

namespace fpc {
namespace {

using Json = OrderedJson;

/// As much of a layout as a trajectory needs.
RecordLayout layoutOf(const RunRecord& record) {
  RecordLayout layout;
  layout.info = record.info;
  layout.states = record.states;
  layout.state_units = record.state_units;
  return layout;
}

constexpr const char* kSourceNames[] = {"",     "base",   "constrained", "clipped",
                                        "held", "manual", "fallback",    "guarded"};

}  // namespace

const char* nameOf(ActionSource source) { return kSourceNames[static_cast<std::size_t>(source)]; }

namespace {

/// JSON has no infinity: an absent limit is null.
Json outputsOf(const Summary& summary) {
  Json outputs = Json::object();
  for (std::size_t i = 0; i < summary.outputs.size(); ++i) {
    const OutputIndices& y = summary.outputs[i];
    Json& output = outputs[summary.output_names[i]];
    output = {{"unit", i < summary.output_units.size() ? summary.output_units[i] : ""},
              {"controlled", i < summary.controlled.size() && summary.controlled[i]},
              {"ise", y.ise},
              {"iae", y.iae},
              {"itae", y.itae},
              {"itse", y.itse},
              {"rmse", y.rmse},
              {"ise_reference", y.ise_reference}};
    if (y.rejected > 0) output["rejected"] = y.rejected;
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
    inputs[summary.input_names[i]] = {{"lower", numberOrNull(summary.limits.lower[k])},
                                      {"upper", numberOrNull(summary.limits.upper[k])},
                                      {"move", numberOrNull(summary.limits.move[k])}};
  }
  for (std::size_t i = 0; i < summary.output_names.size(); ++i)
    outputs[summary.output_names[i]] = {{"lower", numberOrNull(summary.output_lower[i])},
                                        {"upper", numberOrNull(summary.output_upper[i])}};
  return {{"inputs", inputs}, {"outputs", outputs}};
}

Json eventsOf(const std::vector<Event>& events) {
  Json list = Json::array();
  for (const Event& event : events)
    list.push_back({{"code", kindOf(event.code).name},
                    {"severity", nameOf(event.severity())},
                    {"signal", event.signal},
                    {"first", event.first},
                    {"last", event.last},
                    {"count", event.count},
                    {"text", event.text}});
  return list;
}

}  // namespace

std::string toJson(const Summary& summary) {
  Json json;
  json["loop"] = summary.loop;
  json["title"] = summary.title;
  if (summary.run_id != 0) json["run_id"] = summary.run_id;
  if (summary.first_step != 0) json["first_step"] = summary.first_step;
  json["complete"] = summary.complete;
  json["failed_samples"] = summary.failed_samples;
  if (!summary.trouble.empty()) json["trouble"] = summary.trouble;
  json["steps"] = summary.steps;
  json["wall_s"] = summary.wall_s;
  if (summary.slowest_step_s > 0.0) json["slowest_step_s"] = summary.slowest_step_s;
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
  json["events"] = eventsOf(summary.events);
  for (const auto& [name, value] : summary.consumption) json[name] = value;
  json["outside_model"] = summary.outside_model;
  json["limits"] = limitsOf(summary);
  return json.dump(2);
}

CsvTable trajectoryOf(const LoopFile& loop, const RunRecord& record) {
  std::vector<double> cells;
  Trajectory rows(loop, layoutOf(record), [&](const std::vector<double>& row) {
    cells.insert(cells.end(), row.begin(), row.end());
  });
  for (const SampleRecord& sample : record.samples) rows.add(sample);
  rows.close();
  CsvTable table;
  table.names = rows.names();
  table.units = rows.units();
  const auto columns = static_cast<Eigen::Index>(table.names.size());
  table.values =
      Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
          cells.data(), static_cast<Eigen::Index>(cells.size()) / columns, columns);
  return table;
}

void writeSummary(const Summary& summary, const std::string& file) {
  writeText(toJson(summary) + "\n", file);
}

void writeRun(const LoopFile& loop, const RunRecord& record, const Summary& summary,
              const std::string& folder) {
  makeFolder(folder);
  TrajectoryFile file(loop, layoutOf(record), inFolder(folder, "trajectory.csv"));
  for (const SampleRecord& sample : record.samples) file.add(sample);
  file.close();
  writeSummary(summary, inFolder(folder, "summary.json"));
}

Summary summarize(const LoopFile& loop, const RunRecord& record, double wall_s) {
  RunSummary sums(loop);
  for (const SampleRecord& sample : record.samples) sums.add(sample);
  Summary summary = sums.finish(wall_s, record.complete);
  summary.complete = record.complete;
  summary.failed_samples = record.failed_samples;
  summary.trouble = record.trouble;
  summary.events.insert(summary.events.end(), record.events.begin(), record.events.end());
  return summary;
}

}  // namespace fpc
