// What a study says: per loop the distribution of its costs and its failures, per pair who won.
#pragma once

#include <string>
#include <vector>

#include "study/study.hpp"

namespace fpc {

/// Of one loop over all cases that are done.
struct LoopStatistics {
  std::string name;
  std::size_t runs{};
  double median{}, lower_quartile{}, upper_quartile{}, worst{};
  std::string worst_case;  ///< its name, with the seed
  double median_move{}, largest_move{};
  double least{};                          ///< of all runs, of the output that is judged first
  std::vector<std::size_t> failures;       ///< runs that show each RunFailure
  std::vector<std::string> failing_cases;  ///< of runs that show any
  std::string trouble;                     ///< of the first run without a finite cost
};

/// Of one loop against the one that the study pairs with. Equal costs count as half a win.
struct PairStatistics {
  std::string name, against;
  std::size_t pairs{};
  double wins{};
  double share{};                       ///< wins / pairs
  double lower{}, upper{};              ///< confidence interval of the share (wilson1927)
  double median_ratio{};                ///< of cost / cost of the other
  double ratio_lower{}, ratio_upper{};  ///< its confidence interval (order statistics); or NaN
};

/// True if there are runs and none of them has a finite cost.
bool noneSucceeded(const LoopStatistics& loop);

struct StudyStatistics {
  std::vector<LoopStatistics> loops;
  std::vector<PairStatistics> pairs;
};

StudyStatistics statisticsOf(const StudyPlan& plan, const StudyResult& result);

struct Interval {
  double lower{}, upper{};
};
/// Of the share wins / n, score method. confidence: 0.95. @pre n >= 1
Interval wilsonInterval(double wins, std::size_t n, double confidence);
/// Least n for which the values of n cases can hold the median with that confidence: 6 at 0.95.
std::size_t casesForMedianInterval(double confidence);
/// Of the median of n sorted values, by the binomial distribution: at least the confidence asked;
/// NaN where n is too small for that.
Interval medianInterval(const std::vector<double>& sorted, double confidence);

}  // namespace fpc
