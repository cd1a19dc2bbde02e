#include "identification/feedback_share.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/decompositions.hpp"
#include "base/order_statistics.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr Index kMostLags = 40;  // of the input's own past
constexpr Index kRowsPerLag = 8;
constexpr Index kOutputLags = 4;
constexpr Index kFewestShareRows = 50;
constexpr Index kMostCompared = 4000;
constexpr double kFromPast = 1e-8;       // an input whose past tells it to this share is periodic
constexpr double kSureOfFeedback = 7.0;  // of F
constexpr double kLeast = 0.02;          // of what is new in u
constexpr double kTrim = 4.0;            // robust deviations
constexpr int kTrims = 3;

Vector scaled(VectorRef values) {
  double n = 0.0, sum = 0.0, square = 0.0;
  for (const double v : values)
    if (std::isfinite(v)) n += 1.0, sum += v;
  const double mean = n > 0.0 ? sum / n : 0.0;
  for (const double v : values)
    if (std::isfinite(v)) square += (v - mean) * (v - mean);
  const double deviation = n > 0.0 && square > 0.0 ? std::sqrt(square / n) : 1.0;
  return (values.array() - mean) / deviation;
}

/// RegressionRows of [u(k-1)..u(k-p), 1, y(k-d)..y(k-d-3)] and u(k), where all are known.
struct RegressionRows {
  Matrix regressors;
  Vector target;
  bool mostly_moving{};
};

RegressionRows rowsOf(const Vector& u, const Vector& y, Index lags, Index delay) {
  std::vector<Index> known;
  double moves = 0.0;
  const Index first = std::max(lags, kOutputLags + delay);
  for (Index k = first; k < u.size(); ++k) {
    if (!u.segment(k - lags, lags + 1).allFinite()) continue;
    if (!y.segment(k - delay - kOutputLags + 1, kOutputLags).allFinite()) continue;
    known.push_back(k);
    if (u[k] != u[k - 1]) moves += 1.0;
  }
  const auto n = static_cast<Index>(known.size());
  RegressionRows rows{Matrix(n, lags + 1 + kOutputLags), Vector(n),
                      2.0 * moves > static_cast<double>(n)};
  for (Index i = 0; i < n; ++i) {
    const Index k = known[static_cast<std::size_t>(i)];
    rows.target[i] = u[k];
    rows.regressors.row(i) << u.segment(k - lags, lags).transpose(), 1.0,
        y.segment(k - delay - kOutputLags + 1, kOutputLags).transpose();
  }
  return rows;
}

/// What the first `columns` regressors leave of all targets, fitted to the rows that are `kept`.
Vector leftOver(const RegressionRows& rows, Index columns, const std::vector<Index>& kept) {
  Matrix a(static_cast<Index>(kept.size()), columns);
  Vector b(a.rows());
  for (Index i = 0; i < a.rows(); ++i) {
    a.row(i) = rows.regressors.row(kept[static_cast<std::size_t>(i)]).head(columns);
    b[i] = rows.target[kept[static_cast<std::size_t>(i)]];
  }
  const Vector theta = solvedByPivotedQr(a, b);
  return rows.target - rows.regressors.leftCols(columns) * theta;
}

double squares(const Vector& errors, const std::vector<Index>& kept) {
  double sum = 0.0;
  for (const Index i : kept) sum += errors[i] * errors[i];
  return sum;
}

/// RegressionRows whose error is a usual one; none where most errors vanish.
std::vector<Index> usual(const Vector& errors) {
  const Vector sizes = errors.cwiseAbs();
  const double most = kTrim * 1.4826 * upperMedian({sizes.data(), sizes.data() + sizes.size()});
  std::vector<Index> kept;
  for (Index i = 0; most > 1e-9 && i < errors.size(); ++i)
    if (std::abs(errors[i]) < most) kept.push_back(i);
  return kept;
}

}  // namespace

double feedbackShare(VectorRef u_all, VectorRef y_all, int delay) {
  const Index n_all = std::min(u_all.size(), kMostCompared);
  const Vector u = scaled(u_all.head(n_all)), y = scaled(y_all.head(n_all));
  const Index lags = std::min(kMostLags, n_all / kRowsPerLag);
  const RegressionRows rows = rowsOf(u, y, lags, delay);
  const Index own = lags + 1, all = own + kOutputLags;
  std::vector<Index> kept;
  for (Index i = 0; i < rows.target.size(); ++i) kept.push_back(i);
  const auto enough = [&] {
    return static_cast<Index>(kept.size()) >= std::max(kFewestShareRows, 2 * all);
  };
  if (lags < 1 || !enough()) return 0.0;
  Vector past = leftOver(rows, own, kept);
  if (squares(past, kept) < kFromPast * static_cast<double>(kept.size())) return 0.0;
  for (int i = 0; rows.mostly_moving && i < kTrims; ++i) {
    kept = usual(past);
    if (!enough()) return 0.0;
    past = leftOver(rows, own, kept);
  }
  const double before = squares(past, kept), after = squares(leftOver(rows, all, kept), kept);
  const double freedom = static_cast<double>(static_cast<Index>(kept.size()) - all);
  if (!(before > 0.0)) return 0.0;
  const double share = 1.0 - after / before;
  const double f = (before - after) / static_cast<double>(kOutputLags) / (after / freedom);
  return f > kSureOfFeedback && share > kLeast ? std::min(share, 1.0) : 0.0;
}

}  // namespace fpc
