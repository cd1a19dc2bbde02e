#include "identification/interval_coverage.hpp"

#include <algorithm>
#include <cmath>

#include "base/statistics.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kRare = 1e-3;       // share of records in which chance alone holds fewer
constexpr Index kLongestLag = 1000;  // of correlations

/// Sum of e(k) e(k - lag), and over how many pairs.
double product(const Vector& e, Index lag, double& pairs) {
  double sum = 0.0;
  pairs = 0.0;
  for (Index k = lag; k < e.size(); ++k) {
    const double both = e[k] * e[k - lag];
    if (std::isfinite(both)) sum += both, pairs += 1.0;
  }
  return sum;
}

}  // namespace

double independentCount(VectorRef errors) {
  double n = 0.0, mean = 0.0;
  for (const double e : errors)
    if (std::isfinite(e)) n += 1.0, mean += e;
  if (n == 0.0) return 0.0;
  const Vector centred = errors.array() - mean / n;
  double pairs = 0.0;
  const double square = product(centred, 0, pairs);
  if (!(square > 0.0)) return n;
  double sum = 0.0;
  for (Index lag = 1; lag <= std::min(kLongestLag, errors.size() / 2); ++lag) {
    const double together = product(centred, lag, pairs);
    if (!(together > 0.0)) break;
    sum += together / square;
  }
  return std::clamp(n / (1.0 + 2.0 * sum), 1.0, n);
}

double leastCoverage(double n, double stated) {
  const double count = std::floor(n), inside = stated / 100.0;
  if (!(count >= 1.0)) return 0.0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
    if (binomialAtMost(k, static_cast<std::size_t>(count), inside) >= kRare)
      return 100.0 * static_cast<double>(k) / count;
  return 100.0;
}

}  // namespace fpc
