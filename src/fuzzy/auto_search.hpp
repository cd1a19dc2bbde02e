// The search over structures of one output, judged by free runs over blocks that a fit did not see.
#pragma once

#include <chrono>
#include <vector>

#include "fmbpc/fuzzy/auto_identify.hpp"
#include "fuzzy/auto_candidate.hpp"

namespace fpc {

/// A candidate and what it said about the blocks.
struct Judgement {
  Candidate candidate;
  Vector free_run, one_step;   ///< rows of the record, NaN outside the blocks' judged rows
  std::vector<double> blocks;  ///< free-run rmse of each
  double rmse{};               ///< of all judged rows
  double score{};  ///< rmse, blended with that one step ahead, times a penalty for parameters
  Eigen::Index parameters{};
};

using Clock = std::chrono::steady_clock;

struct SearchLimits {
  Clock::time_point deadline;
  int threads{0};
  int window{5};
  std::function<bool()> proceed;  ///< false: no new fit
  std::function<void(double)> progress;
};

/// One structure from several starts; their free runs are averaged, which tells more of the
/// structure than any single fit.
struct Group {
  std::vector<Judgement> members;
  Vector free_run;  ///< trimmed mean of the members
  double rmse{}, score{};
};

/// All judgements of one output, the best first within each kind.
struct StructureSearch {
  std::vector<Judgement> linear, regressors;
  std::vector<Group> state;  ///< own states that are not linear
  int skipped{};             ///< fits that the deadline prevented
};
StructureSearch searchStructures(const AutoData& data, const std::vector<int>& delay, bool states,
                                 std::uint64_t seed, const SearchLimits& limits);

/// Trimmed mean of what all members say at each row.
Vector averaged(const std::vector<const Judgement*>& members);

/// rmse of measured minus predicted over the rows where both are known.
double rmseOf(const AutoData& data, const Vector& predicted);
std::vector<double> blockErrors(const AutoData& data, const Vector& predicted);

}  // namespace fpc
