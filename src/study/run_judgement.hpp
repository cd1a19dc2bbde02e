// What a study counts of one run: its cost, its moves, and in which ways it failed.
#pragma once

#include <string>
#include <vector>

#include "config/study_file.hpp"
#include "runtime/record.hpp"

namespace fpc {

/// Ways to fail; a run may show several.
enum class RunFailure {
  kDiverged,    ///< it ended early, or something was not finite
  kLocked,      ///< an input stayed at its bound while an output did not come nearer its setpoint
  kViolated,    ///< an input, a move or an output beyond its limits
  kHeld,        ///< an action was held
  kOutOfModel,  ///< the law said that it was outside its model's data
};
constexpr int kRunFailures = 5;
const char* wordOf(RunFailure failure);

struct RunJudgement {
  double cost{};          ///< infinite if the run diverged
  double move{};          ///< mean |move| of all inputs, each in parts of its range
  double least{};         ///< least of the output that is judged first
  double largest_move{};  ///< of any input, in its unit
  std::vector<std::uint64_t> failures = std::vector<std::uint64_t>(kRunFailures, 0);  ///< samples
  std::uint64_t trajectory{};  ///< hash of what was measured, applied and true
  std::string trouble;         ///< of a run without a finite cost, in words
};

/// The record as the plant had it: noise-free outputs in the place of the measured ones.
RunRecord withoutNoise(RunRecord record);

/// Longest stretch in which an input stood at a bound (1e-6 of its range) for at least
/// `locked_samples` and the error of some output, averaged over a quarter of the stretch, was no
/// smaller at its end than at its begin and at its end larger than `kLockedError` of the setpoint.
/// 0: none. An input that never moved in the run is none that a law has driven there.
std::uint64_t lockedSamples(const LoopFile& loop, const RunRecord& record, int locked_samples);

RunJudgement judgeRun(const StudyFile& study, const LoopFile& loop, RunRecord record);

}  // namespace fpc
