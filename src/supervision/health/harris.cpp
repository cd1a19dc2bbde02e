#include "supervision/health/harris.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "supervision/health/finite_runs.hpp"

namespace fpc {
namespace {

constexpr int kMostLags = 30;
constexpr Eigen::Index kFewestPerLag = 8;

/// Sums over t of x(t - lag i) x(t - lag j), lags 0, d, d + 1, .., d + m - 1. Lags that follow each
/// other need no sum of their own but at the ends.
void addLagProducts(const double* x, Eigen::Index n, int d, int m, Matrix& products) {
  const Eigen::Index first = d + m - 1, count = n - first;
  const auto lagged = [&](Eigen::Index lag) {
    return Eigen::Map<const Vector>(x + first - lag, count);
  };
  products(0, 0) += lagged(0).squaredNorm();
  Vector row(m);
  for (int j = 0; j < m; ++j) {
    products(0, j + 1) += lagged(0).dot(lagged(d + j));
    row[j] = lagged(d).dot(lagged(d + j));
  }
  Matrix own(m, m);
  own.row(0) = row.transpose();
  for (int i = 1; i < m; ++i)
    for (int j = i; j < m; ++j)
      own(i, j) =
          own(i - 1, j - 1) + x[first - d - i] * x[first - d - j] - x[n - d - i] * x[n - d - j];
  products.bottomRightCorner(m, m) += Matrix(own.triangularView<Eigen::Upper>());
}

}  // namespace

MinimumVariance minimumVariance(const std::vector<double>& error, int dead_time) {
  require(dead_time >= 1, "dead time", "at least one sample");
  const auto usable = [&](int lags) {
    Eigen::Index sum = 0;
    for (const FiniteRun& s : finiteRuns(error))
      sum += std::max<Eigen::Index>(0, s.count - dead_time - lags + 1);
    return sum;
  };
  int lags = kMostLags;
  while (lags > 2 && usable(lags) < kFewestPerLag * lags) lags /= 2;
  MinimumVariance result;
  const Eigen::Index n = usable(lags);
  if (n < kFewestPerLag * lags) return result;
  std::vector<double> x = error;
  const double mean = meanOf(x);
  for (double& value : x) value -= mean;
  Matrix products = Matrix::Zero(lags + 1, lags + 1);
  for (const FiniteRun& s : finiteRuns(x))
    if (s.count >= dead_time + lags)
      addLagProducts(x.data() + s.first, s.count, dead_time, lags, products);
  Matrix normal = products.bottomRightCorner(lags, lags).selfadjointView<Eigen::Upper>();
  const double total = products(0, 0);
  normal.diagonal().array() += 1e-12 * normal.trace() / lags + 1e-300;
  const Vector cross = products.row(0).tail(lags).transpose();
  const double left = std::max(0.0, total - cross.dot(normal.ldlt().solve(cross)));
  result.samples = n;
  result.std_error = std::sqrt(total / static_cast<double>(n));
  result.std_least = std::sqrt(left / static_cast<double>(n - lags));
  if (total > 0.0)
    result.index =
        std::min(1.0, left / static_cast<double>(n - lags) * static_cast<double>(n) / total);
  return result;
}

}  // namespace fpc
