#include "study/study_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics.hpp"

namespace fpc {
namespace {

std::vector<double> sorted(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values;
}

LoopStatistics statisticsOfLoop(const StudyPlan& plan, const StudyResult& result,
                                std::size_t loop) {
  LoopStatistics s;
  s.name = plan.study().loops[loop].name;
  s.failures.assign(kRunFailures, 0);
  s.worst = -std::numeric_limits<double>::infinity();
  std::vector<double> costs, moves;
  for (std::size_t c = 0; c < plan.cases().size(); ++c) {
    const auto& run = result.runs[loop * plan.cases().size() + c];
    if (!run) continue;
    ++s.runs;
    costs.push_back(run->cost);
    moves.push_back(run->move);
    s.largest_move = std::max(s.largest_move, run->largest_move);
    s.least = s.runs == 1 ? run->least : std::min(s.least, run->least);
    if (run->cost > s.worst) {
      s.worst = run->cost;
      s.worst_case = plan.cases()[c].name;
    }
    bool any = false;
    for (std::size_t f = 0; f < s.failures.size(); ++f) {
      s.failures[f] += run->failures[f] > 0;
      any = any || run->failures[f] > 0;
    }
    if (any) s.failing_cases.push_back(plan.cases()[c].name);
    if (s.trouble.empty()) s.trouble = run->trouble;
  }
  s.median = median(costs);
  s.lower_quartile = quantile(costs, 0.25);
  s.upper_quartile = quantile(costs, 0.75);
  s.median_move = median(std::move(moves));
  return s;
}

PairStatistics statisticsOfPair(const StudyPlan& plan, const StudyResult& result, std::size_t loop,
                                std::size_t other) {
  PairStatistics p;
  p.name = plan.study().loops[loop].name;
  p.against = plan.study().loops[other].name;
  std::vector<double> ratios;
  const std::size_t n = plan.cases().size();
  for (std::size_t c = 0; c < n; ++c) {
    const auto &mine = result.runs[loop * n + c], &theirs = result.runs[other * n + c];
    if (!mine || !theirs) continue;
    ++p.pairs;
    const bool equal = mine->cost == theirs->cost;
    p.wins += equal ? 0.5 : static_cast<double>(mine->cost < theirs->cost);
    ratios.push_back(equal ? 1.0 : mine->cost / theirs->cost);
  }
  if (p.pairs == 0) return p;
  const double confidence = 0.01 * plan.study().confidence_percent;
  p.share = p.wins / static_cast<double>(p.pairs);
  const Interval share = wilsonInterval(p.wins, p.pairs, confidence);
  p.lower = share.lower;
  p.upper = share.upper;
  ratios = sorted(std::move(ratios));
  p.median_ratio = median(ratios);
  const Interval ratio = medianInterval(ratios, confidence);
  p.ratio_lower = ratio.lower;
  p.ratio_upper = ratio.upper;
  return p;
}

}  // namespace

bool noneSucceeded(const LoopStatistics& loop) {
  return loop.runs > 0 &&
         loop.failures[static_cast<std::size_t>(RunFailure::kDiverged)] == loop.runs;
}

Interval wilsonInterval(double wins, std::size_t n, double confidence) {
  const double z = normalBound(confidence), count = static_cast<double>(n), share = wins / count;
  const double scale = 1.0 + z * z / count;
  const double centre = (share + z * z / (2.0 * count)) / scale;
  const double half =
      z / scale * std::sqrt(share * (1.0 - share) / count + z * z / (4.0 * count * count));
  return {wins > 0.0 ? centre - half : 0.0, wins < count ? centre + half : 1.0};
}

std::size_t casesForMedianInterval(double confidence) {
  return static_cast<std::size_t>(std::ceil(1.0 - std::log2(1.0 - confidence)));
}

Interval medianInterval(const std::vector<double>& sorted, double confidence) {
  const std::size_t n = sorted.size();
  if (n < casesForMedianInterval(confidence)) return {kNaN, kNaN};
  // Largest j with P(B < j) <= (1 - confidence) / 2, B binomial(n, 1/2).
  std::size_t j = 0;
  while (j < n / 2 && binomialAtMost(j, n, 0.5) <= 0.5 * (1.0 - confidence)) ++j;
  const std::size_t low = j > 0 ? j - 1 : 0;
  return {sorted[low], sorted[n - 1 - low]};
}

StudyStatistics statisticsOf(const StudyPlan& plan, const StudyResult& result) {
  StudyStatistics statistics;
  const auto& loops = plan.study().loops;
  std::size_t other = 0;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    statistics.loops.push_back(statisticsOfLoop(plan, result, i));
    if (loops[i].name == plan.study().against) other = i;
  }
  for (std::size_t i = 0; i < loops.size(); ++i)
    if (i != other) statistics.pairs.push_back(statisticsOfPair(plan, result, i, other));
  return statistics;
}

}  // namespace fpc
