// Tunes a loop: search, history, state on disk. A tuning that was stopped goes on where it was and
// ends with the same bits as one that was not.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/tuning_objective.hpp"

namespace fpc {

/// One judged point.
struct TuningStep {
  Vector shares;               ///< of the ranges, 0..1
  std::vector<double> values;  ///< in the loop's units
  double cost{};
  std::vector<double> scenarios;
  int failures{};
};

struct TuneOptions {
  std::string state;           ///< file that is written after each generation; empty: none
  bool resume{false};          ///< begin with what the state file holds
  std::function<bool()> stop;  ///< called from several threads; may be empty
  std::function<void(int evaluations, double best)> progress;  ///< may be empty
};

struct TuneResult {
  SearchParams search;
  std::vector<TuningStep> history;  ///< in the order asked
  int generations{};
  int best{-1};  ///< index into the history, -1: no finite cost
  bool stopped{false};
  int resumed{};        ///< evaluations taken from the state file
  double seconds{};     ///< wall time of the search, earlier sessions included
  int failures{};       ///< runs that failed
  std::string trouble;  ///< of the first failed run of this session
};

/// @throws InputError: search params; a state file that is not there, or of another tuning.
TuneResult tune(const TuningObjective& objective, const SearchParams& search,
                const TuneOptions& options = {});

/// history.csv: evaluation, cost, best so far, values by key, cost of each scenario; exact numbers.
/// @throws InputError if it cannot be written.
void writeHistory(const TuningFile& tuning, const TuneResult& result, const std::string& file);

}  // namespace fpc
