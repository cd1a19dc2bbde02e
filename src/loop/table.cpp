// The table that a person reads after a run: one line per loop and output, one per loop and input.
#include "fmbpc/base/text.hpp"
#include "fmbpc/loop/report.hpp"

namespace fpc {
namespace {

using Row = std::vector<std::string>;

void addOutputRows(const Summary& s, std::vector<Row>& rows) {
  for (std::size_t i = 0; i < s.outputs.size(); ++i) {
    const OutputIndices& y = s.outputs[i];
    rows.push_back({i == 0 ? s.loop : "", s.output_names[i], shortText(y.ise), shortText(y.iae),
                    shortText(y.itae), shortText(y.itse), shortText(y.rmse),
                    shortText(y.ise_reference), i == 0 ? std::to_string(s.output_violations) : ""});
  }
}

void addInputRows(const Summary& s, std::vector<Row>& rows) {
  for (std::size_t i = 0; i < s.inputs.size(); ++i) {
    const InputIndices& u = s.inputs[i];
    const bool first = i == 0;
    rows.push_back({first ? s.loop : "", s.input_names[i], shortText(u.min), shortText(u.max),
                    shortText(u.mean_abs_move), std::to_string(u.switches), shortText(u.travel),
                    first ? std::to_string(s.input_violations) : "",
                    first ? std::to_string(s.move_violations) : "",
                    first ? std::to_string(s.actuator_clips) : "",
                    first ? std::to_string(s.steps) : "", first ? shortText(s.wall_s) : ""});
  }
}

void addWindowRows(const Summary& s, std::vector<Row>& rows) {
  for (const WindowIndices& w : s.windows)
    rows.push_back({s.loop, w.output, w.window.name, shortText(w.window.from_h),
                    shortText(w.window.to_h), shortText(w.rmse), shortText(w.mean_error)});
}

}  // namespace

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
  std::string text = alignedTable(outputs) + "\n" + alignedTable(inputs);
  if (solves.size() > 1) text += "\n" + alignedTable(solves);
  if (windows.size() > 1) text += "\n" + alignedTable(windows);
  for (const auto& summary : summaries)
    for (const auto& [name, value] : summary.consumption)
      text += summary.loop + ": " + name + " " + shortText(value) + "\n";
  std::string remarks;
  for (const auto& summary : summaries)
    for (const auto& remark : remarksOf(summary)) remarks += remark + "\n";
  return text + (remarks.empty() ? "" : "\n" + remarks);
}

}  // namespace fpc
