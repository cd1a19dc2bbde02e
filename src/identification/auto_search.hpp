// The search over structures of one output, judged by free runs over blocks that a fit did not see.
#pragma once

#include <chrono>
#include <vector>

#include "identification/auto_candidate.hpp"
#include "identification/auto_delay.hpp"
#include "identification/auto_identify.hpp"
#include "identification/work_meter.hpp"

namespace fpc {

/// A candidate and what it said about the blocks.
struct Judgement {
  Candidate candidate;
  Vector free_run, one_step;   ///< rows of the record, NaN outside the blocks' judged rows
  std::vector<double> blocks;  ///< free-run rmse of each
  std::vector<double> seen;    ///< free-run rmse over the rows that each block's fit saw
  Vector
      settled;    ///< free_run without blocks whose fit got stuck; empty: not one of several starts
  double rmse{};  ///< of all judged rows
  double score{};  ///< mean of the blocks, blended with one step, times a penalty for parameters
  Eigen::Index parameters{};
};

using Clock = std::chrono::steady_clock;

struct SearchLimits {
  WorkMeter* meter{};  ///< null: work is not limited
  Clock::time_point deadline{Clock::time_point::max()};
  int threads{0};
  int window{5};
  std::function<bool()> proceed;  ///< false: no new fit
  std::function<void(double)> progress;

  bool isLate() const { return Clock::now() > deadline || (proceed && !proceed()); }
  bool isSpent() const { return meter != nullptr && meter->isSpent(); }
  bool isOver() const { return isSpent() || isLate(); }
  void spend(double work) const {
    if (meter != nullptr) meter->spent += work;
  }
};

/// Calls work(i) for i = 0..n-1 on the threads of `limits`, in lots: none is begun once the limits
/// are over. A lot is the same on any number of threads, and so is where the work ends. What
/// `work` returns is spent. @return for each i, whether it was begun
std::vector<char> limitedFor(std::size_t n, const SearchLimits& limits,
                             const std::function<double(std::size_t)>& work);

/// "the work of the search left out ..", or "the time ..".
std::string leftOutWords(const SearchLimits& limits, const std::string& what);

/// One structure from several starts; their free runs are averaged, which tells more of the
/// structure than any single fit. Starts that got stuck far above the others are left out.
struct Group {
  std::vector<Judgement> members;
  Vector free_run;  ///< trimmed mean of the members
  double rmse{}, score{};
};
void settleGroup(const AutoData& data, Group& group);
/// True for fits from several starts whose errors over the rows they saw lie far above those of the
/// better ones.
std::vector<bool> stuckStarts(const std::vector<double>& seen);

/// All judgements of one output, the best first within each kind.
struct StructureSearch {
  std::vector<Judgement> linear, regressors;
  std::vector<Group> state;  ///< own states that are not linear
  int skipped{};             ///< fits that the limits prevented
};
StructureSearch searchStructures(const AutoData& data, const std::vector<int>& delay, bool states,
                                 std::uint64_t seed, const SearchLimits& limits,
                                 const std::vector<int>& second = {});

/// Each candidate over the blocks, in their order; an infinite score: it could not be judged.
std::vector<Judgement> judgeCandidates(const AutoData& data,
                                       const std::vector<Candidate>& candidates,
                                       const SearchLimits& limits);

/// The delays with which simple linear models run best over the blocks: the usual ones unless
/// longer ones do better by 3 %, also where each block is judged with delays that were guessed
/// without it (one guess per block): that of a long list which fits best by chance does not fit the
/// next rows.
std::vector<int> bestDelays(const AutoData& data, const DelayGuess& guess,
                            const std::vector<DelayGuess>& by_block, std::uint64_t seed,
                            const SearchLimits& limits);

/// Trimmed mean of what members say at each row (NaN: nobody).
Vector averaged(const std::vector<const Judgement*>& members);

/// rmse of measured minus predicted over the rows where both are known.
double rmseOf(const AutoData& data, const Vector& predicted);
/// Mean of the blocks' rmse, by which structures are chosen: one block that holds what the others
/// lack does not decide alone, as it does among squares.
double meanBlockError(const AutoData& data, const Vector& predicted);
/// rmse of free runs over the stretches a model was fitted to.
double seenError(const AutoData& data, const Fitted& fitted, const std::vector<Stretch>& stretches,
                 int window);
/// Score of a judgement on the blocks of `data`, all of which it was judged on.
double scoreOf(const AutoData& data, const Judgement& judged);
/// Akaike's final prediction error, as a factor on the rms.
double penalty(Eigen::Index parameters, const AutoData& data);
std::vector<double> blockErrors(const AutoData& data, const Vector& predicted);

}  // namespace fpc
