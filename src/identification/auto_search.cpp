#include "identification/auto_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.hpp"
#include "identification/auto_structures.hpp"
#include "identification/validation.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kOneStepShare = 0.15;  // of the score of models of the output's past
constexpr std::uint64_t kMoreSeeds = 6;

/// The sign of a state that only its size tells of traps many starts.
std::uint64_t firstSeeds(const Candidate& c) { return c.absolute ? 10 : 4; }

/// One-step errors of the best linear model that are correlated in time where a longer past would
/// take that out.
bool asksForMore(const AutoData& data, const std::vector<Judgement>& linear) {
  constexpr double kMuch = 0.3, kShare = 0.3;
  const auto best = std::find_if(linear.begin(), linear.end(),
                                 [](const Judgement& j) { return !j.candidate.hidden; });
  if (best == linear.end()) return false;
  const Vector error = data.data->values.col(data.output) - best->one_step;
  const ValidationParams params;
  const Vector r = autocorrelation(error, params);
  const auto known = static_cast<double>(error.array().isFinite().count());
  const auto outside = (r.array().abs() > 2.58 / std::sqrt(std::max(known, 1.0))).count();
  return r.size() > 0 && r.cwiseAbs().maxCoeff() > kMuch &&
         static_cast<double>(outside) > kShare * static_cast<double>(r.size());
}

class Search {
 public:
  Search(const AutoData& data, const std::vector<int>& delay, std::uint64_t seed,
         const SearchLimits& limits, std::vector<int> second = {})
      : data_(data), delay_(delay), second_(std::move(second)), seed_(seed), limits_(limits) {}

  /// The lowest score of a few linear models.
  double lowestOfLines(const std::vector<std::vector<int>>& block_delay) {
    Candidate c = base();
    c.block_delay = block_delay;
    judge(delayCandidates(c), 0.0, 0.0);
    sortAll();
    return result_.linear.empty() ? kInfinity : result_.linear.front().score;
  }

  std::vector<Judgement> judgeOnly(const Candidates& candidates) {
    return judgeAll(candidates, 0.0, 0.0);
  }

  StructureSearch run(bool states) {
    judge(linearCandidates(base(), states), 0.0, 0.06);
    sortAll();
    if (!second_.empty()) judge(laterLines(base(), second_), 0.06, 0.07);
    if (asksForMore(data_, result_.linear)) judge(longerLines(base()), 0.07, 0.08);
    sortAll();
    judge(shiftedLines(result_.linear), 0.08, 0.1);
    sortAll();
    judge(ruleCandidates(base(), result_.linear), 0.1, 0.3);
    sortAll();
    judge(refinedRules(result_.regressors), 0.3, 0.4);
    if (states) {
      sortAll();
      judgeGroups(stateCandidates(base(), data_.may_be_absolute), 0.4, 0.7);
      sortAll();
      judgeGroups(shiftedStates(result_.state), 0.7, 0.8);
      sortAll();
      judgeGroups(refinedStates(result_.state), 0.8, 0.9);
      sortAll();
      deepen(3, 0.9, 1.0);
    }
    sortAll();
    return std::move(result_);
  }

 private:
  Candidate base() const {
    Candidate c;
    c.delay = delay_;
    c.seed = seed_;
    return c;
  }
  std::vector<Judgement> judgeAll(const Candidates& candidates, double from, double to);
  void judge(const Candidates& candidates, double from, double to);
  void judgeGroups(const Candidates& structures, double from, double to);
  void deepen(std::size_t groups, double from, double to);
  double judgeBlock(Judgement& j, std::size_t block, Vector& free, Vector& one) const;
  void sortAll();

  const AutoData& data_;
  const std::vector<int>& delay_;
  std::vector<int> second_;
  std::uint64_t seed_;
  const SearchLimits& limits_;
  StructureSearch result_;
};

void Search::judgeGroups(const Candidates& structures, double from, double to) {
  Candidates all;
  for (const auto& s : structures)
    for (std::uint64_t i = 0; i < firstSeeds(s); ++i) {
      all.push_back(s);
      all.back().seed += i;
    }
  std::vector<Judgement> judged = judgeAll(all, from, to);
  auto next = judged.begin();
  for (const auto& s : structures) {
    Group group;
    for (std::uint64_t i = 0; i < firstSeeds(s); ++i, ++next)
      if (std::isfinite(next->score)) group.members.push_back(std::move(*next));
    if (!group.members.empty()) result_.state.push_back(std::move(group));
  }
  for (auto& group : result_.state) settleGroup(data_, group);
}

/// More seeds for the best structures, behind those they have.
void Search::deepen(std::size_t groups, double from, double to) {
  Candidates more;
  groups = std::min(groups, result_.state.size());
  for (std::size_t g = 0; g < groups; ++g)
    for (std::uint64_t i = 0; i < kMoreSeeds; ++i) {
      more.push_back(result_.state[g].members.front().candidate);
      more.back().seed = seed_ + firstSeeds(more.back()) + i;
    }
  std::vector<Judgement> judged = judgeAll(more, from, to);
  for (std::size_t g = 0; g < groups; ++g) {
    for (std::uint64_t i = 0; i < kMoreSeeds; ++i) {
      Judgement& j = judged[g * kMoreSeeds + i];
      if (std::isfinite(j.score)) result_.state[g].members.push_back(std::move(j));
    }
    settleGroup(data_, result_.state[g]);
  }
}

/// @return the work that it took
double Search::judgeBlock(Judgement& j, std::size_t block, Vector& free, Vector& one) const {
  const auto training = trainingStretches(data_, static_cast<int>(block));
  Candidate c = j.candidate;
  if (!c.block_delay.empty()) c.delay = c.block_delay[block];
  const Fitted fitted = fitCandidate(data_, c, training);
  if (!fitted.finite) return fitted.work;
  const Stretch w = data_.windows[block];
  free = freeRunOf(data_, fitted, w, limits_.window);
  free.head(std::min<Index>(w.first + limits_.window, free.size())).setConstant(kNaN);
  if (!j.candidate.hidden) one = oneStepOf(data_, fitted, w);
  j.parameters = fitted.shape.parameterCount();
  if (j.candidate.hidden) j.seen.assign(1, seenError(data_, fitted, training, limits_.window));
  return fitted.work;
}

/// One judgement per candidate; its score is infinite where a block could not be judged.
std::vector<Judgement> Search::judgeAll(const Candidates& candidates, double from, double to) {
  const std::size_t blocks = data_.windows.size();
  std::vector<Vector> free(candidates.size() * blocks), one(free.size());
  std::vector<Judgement> parts(free.size());
  const auto tried = limitedFor(free.size(), limits_, [&](std::size_t task) {
    parts[task].candidate = candidates[task / blocks];
    const double work = judgeBlock(parts[task], task % blocks, free[task], one[task]);
    if (task % (blocks * 2) == 0 && limits_.progress)
      limits_.progress(from +
                       (to - from) * static_cast<double>(task) / static_cast<double>(free.size()));
    return work;
  });
  std::vector<Judgement> judged(candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    Judgement& j = judged[i];
    j.candidate = candidates[i];
    j.free_run = Vector::Constant(data_.scaled.rows(), kNaN);
    j.one_step = j.free_run;
    bool complete = true;
    for (std::size_t b = 0; b < blocks; ++b) {
      const std::size_t task = i * blocks + b;
      const Stretch w = data_.windows[b];
      const Index length = w.last - w.first;
      complete = complete && free[task].size() > 0;
      if (tried[task] == 0) ++result_.skipped;
      if (free[task].size() == 0) continue;
      j.free_run.segment(w.first, length) = free[task].segment(w.first, length);
      j.parameters = parts[task].parameters;
      j.seen.insert(j.seen.end(), parts[task].seen.begin(), parts[task].seen.end());
      if (one[task].size() > 0)
        j.one_step.segment(w.first, length) = one[task].segment(w.first, length);
    }
    j.rmse = complete ? rmseOf(data_, j.free_run) : kInfinity;
    j.blocks = blockErrors(data_, j.free_run);
    j.score = complete ? scoreOf(data_, j) : kInfinity;
  }
  return judged;
}

void Search::judge(const Candidates& candidates, double from, double to) {
  for (auto& j : judgeAll(candidates, from, to)) {
    if (!std::isfinite(j.score)) continue;
    auto& kind = j.candidate.rules == 1 ? result_.linear : result_.regressors;
    kind.push_back(std::move(j));
  }
}

void Search::sortAll() {
  const auto better = [](const auto& a, const auto& b) { return a.score < b.score; };
  std::stable_sort(result_.linear.begin(), result_.linear.end(), better);
  std::stable_sort(result_.regressors.begin(), result_.regressors.end(), better);
  std::stable_sort(result_.state.begin(), result_.state.end(), better);
}

}  // namespace

std::vector<char> limitedFor(std::size_t n, const SearchLimits& limits,
                             const std::function<double(std::size_t)>& work) {
  constexpr std::size_t kLot = 32;
  std::vector<char> begun(n, 0);
  std::vector<double> spent(kLot);
  for (std::size_t first = 0; first < n && !limits.isSpent(); first += kLot) {
    const std::size_t count = std::min(kLot, n - first);
    std::fill(spent.begin(), spent.end(), 0.0);
    parallelFor(count, limits.threads, [&](std::size_t i) {
      if (limits.isLate()) return;
      begun[first + i] = 1;
      spent[i] = work(first + i);
    });
    for (std::size_t i = 0; i < count; ++i) limits.spend(spent[i]);
  }
  return begun;
}

std::string leftOutWords(const SearchLimits& limits, const std::string& what) {
  if (limits.proceed && !limits.proceed()) return "the search was stopped before " + what;
  return limits.isSpent()
             ? "the limit of work left out " + what + "; more --work may find better ones"
             : "the time that was asked for (--budget) left out " + what +
                   ": on another machine the same command may find another model";
}

double scoreOf(const AutoData& data, const Judgement& judged) {
  const double one_step = rmseOf(data, judged.one_step);
  const double weight = std::isfinite(one_step) && one_step > 0.0 ? kOneStepShare : 0.0;
  return std::pow(meanBlockError(data, judged.free_run), 1.0 - weight) *
         (weight > 0.0 ? std::pow(one_step, weight) : 1.0) * penalty(judged.parameters, data);
}

StructureSearch searchStructures(const AutoData& data, const std::vector<int>& delay, bool states,
                                 std::uint64_t seed, const SearchLimits& limits,
                                 const std::vector<int>& second) {
  return Search(data, delay, seed, limits, second).run(states);
}

std::vector<Judgement> judgeCandidates(const AutoData& data, const Candidates& candidates,
                                       const SearchLimits& limits) {
  const std::vector<int> none;
  return Search(data, none, 1, limits).judgeOnly(candidates);
}

std::vector<int> bestDelays(const AutoData& data, const DelayGuess& guess,
                            const std::vector<DelayGuess>& by_block, std::uint64_t seed,
                            const SearchLimits& limits) {
  constexpr double kWorth = 0.97;
  struct Scores {
    double all, apart;  // with delays guessed from all rows, and without each block
  };
  const auto scoresOf = [&](const std::vector<int>& delay, auto&& of_block) {
    std::vector<std::vector<int>> blocks;
    for (const auto& g : by_block) blocks.push_back(of_block(g));
    return Scores{Search(data, delay, seed, limits).lowestOfLines({}),
                  Search(data, delay, seed, limits).lowestOfLines(blocks)};
  };
  std::vector<int> best = guess.delay;
  Scores lowest = scoresOf(guess.delay, [](const auto& g) { return g.delay; });
  lowest = {kWorth * lowest.all, kWorth * lowest.apart};
  for (std::size_t i = 0; i < guess.longer.size(); ++i) {
    if (guess.longer[i] == guess.delay) continue;
    const Scores scores = scoresOf(guess.longer[i], [i](const auto& g) { return g.longer[i]; });
    if (!(scores.all < lowest.all && scores.apart < lowest.apart)) continue;
    lowest = scores;
    best = guess.longer[i];
  }
  return best;
}

}  // namespace fpc
