// Runs that several rows of `fmbpc reproduce` share: each loop runs once in a call of the tool.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "papers/experiment.hpp"
#include "runtime/report.hpp"

namespace fpc::tool {

constexpr int kSeeds = 24;  ///< of the disturbance pattern behind every ratio that depends on it

/// The run of a shipped loop in process; kept until the tool ends, nothing is stored. A run that
/// fails throws each time it is asked for and leaves nothing behind.
/// @throws std::exception if it cannot be run, or did not go as asked.
const RunRecord& recordOf(const std::string& loop, const Overrides& overrides = {});
const Summary& summaryOf(const std::string& loop, const Overrides& overrides = {});
/// The same, run anew and not kept: for searches.
Summary freshSummaryOf(const std::string& loop, const Overrides& overrides);
/// @throws InputError if the loop has no such output.
const OutputIndices& indicesOf(const Summary& summary, const std::string& output);

using OfSummary = std::function<double(const Summary&)>;
/// One figure of each of kSeeds runs on all cores: seeds from that of the loop file on. NaN where a
/// run failed.
Values overSeeds(const std::string& loop, const OfSummary& what);
/// ISE of one output over the seeds.
Values iseOver(const std::string& loop, const std::string& output);
/// Share of the samples in which a bound of the optimizer is active [%].
Values activeOver(const std::string& loop);
/// Seed by seed. @throws InputError if there are not equally many.
Values ratio(const Values& above, const Values& below);
Values difference(const Values& from, const Values& subtracted);  ///< likewise
/// What went wrong in runs over seeds: "asp_case1, seed 3: ...".
const std::vector<std::string>& failedRuns();

}  // namespace fpc::tool
