// Files and tables of a run: trajectory.csv, summary.json, the table a person reads.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "analysis/performance.hpp"
#include "base/csv.hpp"
#include "config/loop_file.hpp"
#include "fmbpc/base/input_limits.hpp"
#include "runtime/record.hpp"

namespace fpc {

/// One output over one stretch of the run, on the measured values. No samples: NaN.
struct WindowIndices {
  ReportWindow window;
  std::string output;
  double rmse{}, mean_error{};  ///< of y - setpoint
  std::uint64_t samples{};
};

/// "base", "constrained", ...: as in summary.json.
const char* nameOf(ActionSource source);

struct Summary {
  std::string loop;
  std::string title;
  std::uint64_t run_id{};      ///< 0: of no plant that was recorded
  std::uint32_t first_step{};  ///< not 0: a part of an endless run
  bool complete{};        ///< the final sample came, nothing is missing, the plant moved as asked
  std::uint32_t steps{};  ///< number of actions
  double wall_s{};
  double slowest_step_s{};  ///< wall time of law and optimizer; 0: not measured
  std::vector<std::string> output_names, input_names;
  std::vector<std::string> output_units, input_units;  ///< empty: not known
  std::vector<OutputIndices> outputs;
  std::vector<bool> controlled;  ///< outputs that the controller follows; empty: not known
  std::vector<InputIndices> inputs;
  std::vector<WindowIndices> windows;  ///< per output, the windows of the loop file
  std::vector<std::pair<std::string, double>> consumption;
  std::uint64_t input_violations{}, move_violations{}, output_violations{}, actuator_clips{};
  std::uint64_t outside_model{};  ///< samples below guard.trust_low of the loop's model
  bool has_clp{};
  std::uint64_t clp_solves{}, clp_infeasible{};
  std::uint64_t clp_failed{};  ///< solves without a usable result for another reason
  double clp_median_us{}, clp_p99_us{};
  std::vector<std::uint64_t> sources;  ///< count of actions per ActionSource (index = value)
  std::uint32_t failed_samples{};      ///< samples over which the plant could not be moved
  std::string trouble;                 ///< of the first of them, with its number
  std::vector<Event> events;           ///< what went otherwise than asked
  InputLimits limits;                  ///< of the inputs
  std::vector<double> output_lower, output_upper;  ///< limits behind output_violations
};

Summary summarize(const LoopFile& loop, const RunRecord& record, double wall_s);
/// Samples (with an action) whose measurement and input lie where the loop's model has no data; 0
/// for a law without a model.
std::uint64_t samplesOutsideModel(const LoopFile& loop, const RunRecord& record);
std::string toJson(const Summary& summary);  ///< keys of README, one object
/// What toTable() needs of a summary.json. @throws InputError naming the file.
Summary readSummary(const std::string& file);
/// One line about a plant that could not be moved, empty if it could at every sample.
std::string troubleOf(const Summary& summary);
/// True if every action was held or the fallback.
bool neverControlled(const Summary& summary);
/// Its events, a line each, beginning with the loop's name.
std::vector<std::string> eventLines(const Summary& summary);
std::string toTable(const std::vector<Summary>& summaries);
/// Of runs of one experiment: a line each with what its title adds to the others', the error of
/// what all of them control, and the movement.
std::string shortTable(const std::vector<Summary>& summaries);
/// Who follows the outputs that all of them control best, by how much and at which movement: one
/// sentence, computed from the ISE. Empty for one run, and where runs cannot be compared.
std::string verdictOf(const std::vector<Summary>& summaries);
/// What trajectory.csv holds: a row for each sample from `report.record_from_h` on.
CsvTable trajectoryOf(const LoopFile& loop, const RunRecord& record);
/// trajectory.csv and summary.json in `folder` (made if missing). @throws InputError if it cannot
/// be written.
void writeRun(const LoopFile& loop, const RunRecord& record, const Summary& summary,
              const std::string& folder);

}  // namespace fpc
