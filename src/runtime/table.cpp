// The table that a person reads after a run: one line per loop and output, one per loop and input.
#include <algorithm>
#include <numeric>
#include <utility>

#include "fmbpc/base/text.hpp"
#include "runtime/report.hpp"
#include "runtime/with_unit.hpp"

namespace fpc {
namespace {

using Row = std::vector<std::string>;

/// As a person reads it: no "-0", and nothing for rounding errors beside the other figures.
std::string cell(double value) {
  const std::string text = shortText(value);
  return text == "-0" ? "0" : text;
}

/// Moves are switches only of an input that rests more often than it moves, and then jumps: over
/// half of its range on the average. A continuous valve at rest at a limit creeps there.
std::string switches(const InputIndices& u, std::uint32_t steps) {
  const bool rests = 2 * u.switches <= steps;
  const bool jumps = u.travel >= 0.5 * static_cast<double>(u.switches) * (u.max - u.min);
  return rests && jumps ? std::to_string(u.switches) : "-";
}

bool isControlled(const Summary& s, std::size_t i) {
  return s.controlled.size() != s.outputs.size() || s.controlled[i];
}

/// What is controlled first.
std::vector<std::size_t> orderOfOutputs(const Summary& s) {
  std::vector<std::size_t> order(s.outputs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_partition(order.begin(), order.end(),
                        [&](std::size_t i) { return isControlled(s, i); });
  return order;
}

void addOutputRows(const Summary& s, std::vector<Row>& rows) {
  const bool all = std::all_of(s.controlled.begin(), s.controlled.end(), [](bool c) { return c; });
  const bool none =
      std::none_of(s.controlled.begin(), s.controlled.end(), [](bool c) { return c; });
  const char* const mark = all || none ? "" : " (not controlled)";
  bool first = true;
  for (const std::size_t i : orderOfOutputs(s)) {
    const OutputIndices& y = s.outputs[i];
    const std::string name =
        withUnit(s.output_names, s.output_units, i) + (isControlled(s, i) ? "" : mark);
    rows.push_back({std::exchange(first, false) ? s.loop : "", name, cell(y.ise), cell(y.iae),
                    cell(y.itae), cell(y.itse), cell(y.rmse), cell(y.ise_reference),
                    s.outputs.size() == 1 ? std::to_string(s.output_violations) : ""});
  }
  if (s.outputs.size() > 1)
    rows.push_back(
        {"", "all outputs", "", "", "", "", "", "", std::to_string(s.output_violations)});
}

void addInputRows(const Summary& s, std::vector<Row>& rows) {
  for (std::size_t i = 0; i < s.inputs.size(); ++i) {
    const InputIndices& u = s.inputs[i];
    rows.push_back({i == 0 ? s.loop : "", withUnit(s.input_names, s.input_units, i), cell(u.min),
                    cell(u.max), cell(u.mean_abs_move), switches(u, s.steps), cell(u.travel), "",
                    "", "", "", ""});
  }
  if (s.inputs.size() > 1)
    rows.push_back({"", "all inputs", "", "", "", "", "", "", "", "", "", ""});
  if (s.inputs.empty()) return;
  const std::vector<std::string> counts{
      std::to_string(s.input_violations), std::to_string(s.move_violations),
      std::to_string(s.actuator_clips), std::to_string(s.steps), cell(s.wall_s)};
  std::copy(counts.begin(), counts.end(), rows.back().end() - 5);
}

constexpr char kLegend[] =
    "e: setpoint - measured. ISE, IAE: sums of e^2, |e| over the samples; ITAE, ITSE: with the "
    "time\n"
    "in h; rmse: root mean square of e; ISE ref: sum of (reference - measured)^2; beyond: samples\n"
    "outside the limits of the loop file (outputs: report.output_lower, .output_upper), for "
    "several\n"
    "signals the sum of theirs; travel: sum of moves; switches: moves of an input that rests more\n"
    "often than it moves, and jumps; clips: inputs that the actuator had to cut, summed up "
    "alike.\n";

/// "T [degC]", by the output's name.
std::string outputWithUnit(const Summary& s, const std::string& name) {
  const auto& names = s.output_names;
  const auto at =
      static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  return at < names.size() ? withUnit(names, s.output_units, at) : name;
}

void addWindowRows(const Summary& s, std::vector<Row>& rows) {
  for (const WindowIndices& w : s.windows)
    rows.push_back({s.loop, outputWithUnit(s, w.output), w.window.name, shortText(w.window.from_h),
                    shortText(w.window.to_h), cell(w.rmse), cell(w.mean_error)});
}

}  // namespace

std::string troubleOf(const Summary& summary) {
  if (summary.failed_samples == 0) return "";
  return summary.loop + ": the plant could not be moved over " +
         std::to_string(summary.failed_samples) + " of " + std::to_string(summary.steps) +
         " samples and was held; first " + summary.trouble;
}

bool neverControlled(const Summary& summary) {
  return contains(summary.events, EventCode::kNeverControlled);
}

std::vector<std::string> eventLines(const Summary& summary) {
  std::vector<std::string> lines;
  for (const Event& event : summary.events) {
    std::string line = summary.loop + ": " + kindOf(event.code).name + ": " + event.text;
    if (!event.signal.empty() && event.text.find(event.signal) == std::string::npos)
      line += " (" + event.signal + ")";
    if (event.count > 0)
      line += ", " + std::to_string(event.count) + " of " + std::to_string(summary.steps) +
              " samples from " + std::to_string(event.first) + " on";
    lines.push_back(line);
  }
  return lines;
}

std::string toTable(const std::vector<Summary>& summaries) {
  std::vector<Row> outputs{
      {"loop", "output", "ISE", "IAE", "ITAE", "ITSE", "rmse", "ISE ref", "beyond"}};
  std::vector<Row> inputs{{"loop", "input", "min", "max", "mean move", "switches", "travel",
                           "beyond", "moves beyond", "clips", "steps", "wall s"}};
  std::vector<Row> solves{
      {"optimizer of", "solves", "infeasible", "failed", "median us", "p99 us"}};
  std::vector<Row> windows{{"loop", "output", "window", "from h", "to h", "rmse", "mean error"}};
  for (const auto& summary : summaries) {
    addWindowRows(summary, windows);
    addOutputRows(summary, outputs);
    addInputRows(summary, inputs);
    if (summary.has_clp)
      solves.push_back({summary.loop, std::to_string(summary.clp_solves),
                        std::to_string(summary.clp_infeasible), std::to_string(summary.clp_failed),
                        shortText(summary.clp_median_us), shortText(summary.clp_p99_us)});
  }
  std::string text;
  if (summaries.size() > 1)
    for (const auto& summary : summaries)
      if (!summary.title.empty()) text += summary.loop + ": " + summary.title + "\n";
  if (!text.empty()) text += "\n";
  text += alignedTable(outputs) + "\n" + alignedTable(inputs);
  if (solves.size() > 1) text += "\n" + alignedTable(solves);
  if (windows.size() > 1)
    text += "\n" + alignedTable(windows) + "mean error: of measured - setpoint in the window.\n";
  for (const auto& summary : summaries)
    for (const auto& [name, value] : summary.consumption)
      text += summary.loop + ": " + name + " " + shortText(value) + "\n";
  std::string events;
  for (const auto& summary : summaries)
    for (const auto& line : eventLines(summary)) events += line + "\n";
  text += std::string("\n") + kLegend;
  return text + (events.empty() ? "" : "\n" + events);
}

}  // namespace fpc
