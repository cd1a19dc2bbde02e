// Runs a study: every loop on every case, on all cores; what is done is kept on disk, so that a
// study that was stopped goes on where it was and ends with the same bits.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study/run_judgement.hpp"
#include "study/run_pool.hpp"
#include "study/study_plan.hpp"

namespace fpc {

struct StudyOptions {
  int threads{0};              ///< 0: all cores; the answer does not depend on it
  std::string state;           ///< file of what is done; empty: none. Beside it FILE.runs
  bool resume{false};          ///< begin with what the state file holds
  std::function<bool()> stop;  ///< called from several threads; may be empty
  std::function<void(std::size_t done, std::size_t runs)> progress;  ///< may be empty
  RunPool* pool{nullptr};  ///< where the runs are made; null: `threads` of this process
};

struct StudyResult {
  std::vector<std::optional<RunJudgement>> runs;  ///< in the order of StudyPlan; empty: not done
  std::size_t resumed{};                          ///< taken from the state file
  bool complete{};
};

/// A run that throws or ends early counts as diverged, with its words.
/// @throws InputError: a state file that is not there, or of another study; two seeds of a scenario
/// under which a loop gave the same trajectory.
StudyResult runStudy(const StudyPlan& plan, const StudyOptions& options = {});

}  // namespace fpc
