// Runs that several numbers share: each is made once in a call of the program.
//
// A run is named by its loop and what is changed in it: "asp_case1", "column_pso+gains_max+fitted"
// (settings of papers/KEY.yaml), "asp_case1*" for seeds() runs, from the seed of the loop on.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "papers/values.hpp"
#include "runtime/report.hpp"

namespace fpc::papers {

std::size_t seeds();  ///< of the disturbance pattern behind every ratio that depends on it: 24
void setSeeds(std::size_t count);

/// What stays of a run of which there are many.
struct RunFigures {
  Summary summary;
  double active{};  ///< share of the samples in which a bound of the optimizer is active [%]
};
using OfRun = std::function<double(const RunFigures&)>;

/// The record of one run; kept until the program ends. A run that fails throws each time it is
/// asked for and leaves nothing behind.
/// @throws std::exception if it cannot be run, did not go as asked, or if it is more than one.
const RunRecord& recordOf(const std::string& run);
const RunRecord& recordOf(const std::string& loop, const Overrides& overrides);
LoopFile loopOf(const std::string& run);  ///< as it would be run
LoopFile loopOf(const std::string& loop, const Overrides& overrides);
/// Run anew and not kept: for searches.
Summary freshSummaryOf(const std::string& loop, const Overrides& overrides);
/// One figure of each run, of several on all cores: NaN where one failed. @throws as recordOf() of
/// a single one
Values overRuns(const std::string& run, const OfRun& what);
/// @throws InputError if the loop has no such signal.
Eigen::Index indexOf(const std::vector<std::string>& names, const std::string& name,
                     const std::string& loop);
Eigen::Index indexOf(const std::vector<SignalInfo>& signals, const std::string& name,
                     const std::string& loop);
/// What went wrong in one of several runs: "asp_case1, seed 3: ...".
const std::vector<std::string>& failedRuns();
/// A change of every loop from now on, for perturbed(): see papers/perturbations.yaml.
void perturbEachLoop(std::function<Overrides(const LoopFile&)> change);

}  // namespace fpc::papers
