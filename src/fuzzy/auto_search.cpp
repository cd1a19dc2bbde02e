#include "fuzzy/auto_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/parallel.hpp"
#include "fuzzy/auto_structures.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kOneStepShare = 0.15;  // of the score of models of the output's past
constexpr std::uint64_t kFirstSeeds = 3, kMoreSeeds = 4;

double squaredError(const AutoData& data, const Vector& predicted, Stretch s, double& n) {
  double sum = 0.0;
  for (Index k = s.first; k < s.last; ++k) {
    const double error = data.data->values(k, data.output) - predicted[k];
    if (std::isfinite(error)) sum += error * error, n += 1.0;
  }
  return sum;
}

/// Akaike's final prediction error, as a factor on the rms.
double penalty(Index parameters, double rows) {
  const double share = std::min(0.9, static_cast<double>(parameters) / rows);
  return std::sqrt((1.0 + share) / (1.0 - share));
}

class Search {
 public:
  Search(const AutoData& data, const std::vector<int>& delay, std::uint64_t seed,
         const SearchLimits& limits)
      : data_(data), delay_(delay), seed_(seed), limits_(limits) {}

  StructureSearch run(bool states) {
    judge(linearCandidates(base(), states), 0.0, 0.12);
    sortAll();
    judge(ruleCandidates(base(), result_.linear), 0.12, 0.38);
    sortAll();
    judge(refinedRules(result_.regressors), 0.38, 0.5);
    if (states) {
      sortAll();
      judgeGroups(stateCandidates(base(), data_.may_be_absolute), kFirstSeeds, 0.5, 0.8);
      sortAll();
      judgeGroups(refinedStates(result_.state), kFirstSeeds, 0.8, 0.93);
      sortAll();
      deepen(3, 0.93, 1.0);
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
  void judgeGroups(const Candidates& structures, std::uint64_t seeds, double from, double to);
  void deepen(std::size_t groups, double from, double to);
  void settleGroup(Group& group) const;
  double rows() const;
  void judgeBlock(Judgement& j, std::size_t block, Vector& free, Vector& one) const;
  void sortAll();
  bool over() const {
    return Clock::now() > limits_.deadline || (limits_.proceed && !limits_.proceed());
  }

  const AutoData& data_;
  const std::vector<int>& delay_;
  std::uint64_t seed_;
  const SearchLimits& limits_;
  StructureSearch result_;
};

void Search::judgeGroups(const Candidates& structures, std::uint64_t seeds, double from,
                         double to) {
  Candidates all;
  for (const auto& s : structures)
    for (std::uint64_t i = 0; i < seeds; ++i) {
      all.push_back(s);
      all.back().seed += i;
    }
  std::vector<Judgement> judged = judgeAll(all, from, to);
  for (std::size_t s = 0; s < structures.size(); ++s) {
    Group group;
    for (std::uint64_t i = 0; i < seeds; ++i) {
      Judgement& j = judged[s * seeds + i];
      if (std::isfinite(j.score)) group.members.push_back(std::move(j));
    }
    if (!group.members.empty()) result_.state.push_back(std::move(group));
  }
  for (auto& group : result_.state) settleGroup(group);
}

/// More seeds for the best structures, behind those they have.
void Search::deepen(std::size_t groups, double from, double to) {
  Candidates more;
  groups = std::min(groups, result_.state.size());
  for (std::size_t g = 0; g < groups; ++g)
    for (std::uint64_t i = 0; i < kMoreSeeds; ++i) {
      more.push_back(result_.state[g].members.front().candidate);
      more.back().seed = seed_ + kFirstSeeds + i;
    }
  std::vector<Judgement> judged = judgeAll(more, from, to);
  for (std::size_t g = 0; g < groups; ++g) {
    for (std::uint64_t i = 0; i < kMoreSeeds; ++i) {
      Judgement& j = judged[g * kMoreSeeds + i];
      if (std::isfinite(j.score)) result_.state[g].members.push_back(std::move(j));
    }
    settleGroup(result_.state[g]);
  }
}

void Search::settleGroup(Group& group) const {
  std::vector<const Judgement*> members;
  for (const auto& j : group.members) members.push_back(&j);
  group.free_run = averaged(members);
  group.rmse = rmseOf(data_, group.free_run);
  group.score = group.rmse * penalty(group.members.front().parameters, rows());
}

double Search::rows() const {
  double n = 0.0;
  for (const auto& w : data_.windows) n += static_cast<double>(w.last - w.first);
  return n;
}

void Search::judgeBlock(Judgement& j, std::size_t block, Vector& free, Vector& one) const {
  const auto training = trainingStretches(data_, static_cast<int>(block));
  const Fitted fitted = fitCandidate(data_, j.candidate, training);
  if (!fitted.finite) return;
  const Stretch w = data_.windows[block];
  free = freeRunOf(data_, fitted, w, limits_.window);
  free.head(std::min<Index>(w.first + limits_.window, free.size())).setConstant(kMissing);
  if (!j.candidate.hidden) one = oneStepOf(data_, fitted, w);
  j.parameters = fitted.shape.parameterCount();
}

/// One judgement per candidate; its score is infinite where a block could not be judged.
std::vector<Judgement> Search::judgeAll(const Candidates& candidates, double from, double to) {
  const std::size_t blocks = data_.windows.size();
  std::vector<Vector> free(candidates.size() * blocks), one(free.size());
  std::vector<Judgement> parts(free.size());
  std::vector<char> tried(free.size(), 0);
  parallelFor(free.size(), limits_.threads, [&](std::size_t task) {
    if (over()) return;
    tried[task] = 1;
    parts[task].candidate = candidates[task / blocks];
    judgeBlock(parts[task], task % blocks, free[task], one[task]);
    if (task % (blocks * 2) == 0 && limits_.progress)
      limits_.progress(from +
                       (to - from) * static_cast<double>(task) / static_cast<double>(free.size()));
  });
  std::vector<Judgement> judged(candidates.size());
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    Judgement& j = judged[i];
    j.candidate = candidates[i];
    j.free_run = Vector::Constant(data_.scaled.rows(), kMissing);
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
      if (one[task].size() > 0)
        j.one_step.segment(w.first, length) = one[task].segment(w.first, length);
    }
    j.rmse = complete ? rmseOf(data_, j.free_run) : kInfinite;
    j.blocks = blockErrors(data_, j.free_run);
    const double one_step = rmseOf(data_, j.one_step);
    const double weight = std::isfinite(one_step) && one_step > 0.0 ? kOneStepShare : 0.0;
    j.score = std::pow(j.rmse, 1.0 - weight) * (weight > 0.0 ? std::pow(one_step, weight) : 1.0) *
              penalty(j.parameters, rows());
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

Vector averaged(const std::vector<const Judgement*>& members) {
  Vector mean = Vector::Constant(members.front()->free_run.size(), kMissing);
  for (Index k = 0; k < mean.size(); ++k) {
    std::vector<double> said;
    for (const auto* m : members)
      if (std::isfinite(m->free_run[k])) said.push_back(m->free_run[k]);
    if (said.size() == members.size()) mean[k] = trimmedMean(said);
  }
  return mean;
}

double rmseOf(const AutoData& data, const Vector& predicted) {
  double sum = 0.0, n = 0.0;
  for (const auto& w : data.windows) sum += squaredError(data, predicted, w, n);
  return n > 0.0 ? std::sqrt(sum / n) : kInfinite;
}

std::vector<double> blockErrors(const AutoData& data, const Vector& predicted) {
  std::vector<double> errors;
  for (const auto& w : data.windows) {
    double n = 0.0;
    const double sum = squaredError(data, predicted, w, n);
    errors.push_back(n > 0.0 ? std::sqrt(sum / n) : kMissing);
  }
  return errors;
}

StructureSearch searchStructures(const AutoData& data, const std::vector<int>& delay, bool states,
                                 std::uint64_t seed, const SearchLimits& limits) {
  return Search(data, delay, seed, limits).run(states);
}

}  // namespace fpc
