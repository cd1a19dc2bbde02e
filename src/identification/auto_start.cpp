#include "identification/auto_start.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include "base/random.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr int kMeansSteps = 30;
constexpr double kSetWidth = 1.2;

/// Ordinary least squares of y(k+1) on what `fill` writes into a row.
template <typename Fill>
Vector leastSquares(Index q, const RecurrentData& data, const std::vector<Stretch>& stretches,
                    Index longest, double ridge, Fill&& fill) {
  Matrix H = ridge * Matrix::Identity(q, q);
  Vector g = Vector::Zero(q), x(q);
  for (const auto& s : stretches)
    for (Index k = s.first + longest; k + 1 < s.last; ++k) {
      fill(k, x);
      if (!x.allFinite() || !std::isfinite(data.y[k + 1])) continue;
      H.selfadjointView<Eigen::Lower>().rankUpdate(x);
      g += x * data.y[k + 1];
    }
  return H.selfadjointView<Eigen::Lower>().ldlt().solve(g);
}

/// Centres of the antecedents' columns (samples) by k-means, in deviations `spread`.
Matrix kMeans(const Matrix& z, const Vector& spread, Index rules, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Matrix centres(z.rows(), rules);
  for (Index r = 0; r < rules; ++r)
    centres.col(r) = z.col(static_cast<Index>(random() % static_cast<std::uint64_t>(z.cols())));
  for (int step = 0; step < kMeansSteps; ++step) {
    Matrix sum = Matrix::Zero(z.rows(), rules);
    Vector count = Vector::Zero(rules);
    for (Index k = 0; k < z.cols(); ++k) {
      Index nearest = 0;
      ((centres.colwise() - z.col(k)).array().colwise() / spread.array())
          .square()
          .colwise()
          .sum()
          .minCoeff(&nearest);
      sum.col(nearest) += z.col(k);
      count[nearest] += 1.0;
    }
    for (Index r = 0; r < rules; ++r)
      if (count[r] > 0.0) centres.col(r) = sum.col(r) / count[r];
  }
  return centres;
}

}  // namespace

Vector arxStart(const RecurrentShape& shape, const RecurrentData& data,
                const std::vector<Stretch>& stretches) {
  const Index n = shape.states, m = shape.exogenous;
  return leastSquares(shape.terms(), data, stretches, n, 1e-4, [&](Index k, Vector& x) {
    for (Index i = 0; i < n; ++i) x[i] = data.y[k - i];
    x.segment(n, m) = data.v.col(k);
    x[n + m] = 1.0;
  });
}

Vector observerStart(const RecurrentShape& shape, const RecurrentData& data,
                     const std::vector<Stretch>& stretches) {
  const Index n = shape.states, m = shape.exogenous, q = n + m * n + 1;
  const Vector theta = leastSquares(q, data, stretches, n, 1e-3, [&](Index k, Vector& x) {
    for (Index i = 0; i < n; ++i) x[i] = data.y[k - i];
    for (Index j = 0; j < m; ++j)
      for (Index i = 0; i < n; ++i) x[n + j * n + i] = data.v(j, k - i);
    x[q - 1] = 1.0;
  });
  Vector p = Vector::Zero(shape.parameterCount());
  for (Index r = 0; r < n; ++r) {
    p[shape.at(0, r)] = theta[r];
    if (r + 1 < n) p[shape.at(0, r) + r + 1] = 1.0;
    for (Index j = 0; j < m; ++j) p[shape.at(0, r) + n + j] = theta[n + j * n + r];
  }
  p[shape.at(0, 0) + shape.terms() - 1] = theta[q - 1];
  return p;
}

Vector chainStart(const RecurrentShape& shape, double samples) {
  Vector p = Vector::Zero(shape.parameterCount());
  const Index n = shape.states;
  for (Index r = 0; r < n; ++r) {
    const double rate = std::min(0.9, (1.0 + 0.3 * static_cast<double>(r)) / samples);
    const Index at = shape.at(0, r);
    p[at + r] = 1.0 - rate;
    if (r + 1 < n) p[at + r + 1] = rate;
    for (Index j = 0; r + 1 == n && j < shape.exogenous; ++j)
      p[at + n + j] = rate / static_cast<double>(shape.exogenous);
  }
  return p;
}

Vector randomStart(const RecurrentShape& shape, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Vector p(shape.parameterCount());
  const double size = 0.3 / std::sqrt(static_cast<double>(shape.states));
  for (Index i = 0; i < p.size(); ++i) p[i] = size * standardNormal(random);
  for (Index r = 0; r < shape.states; ++r) p[shape.at(0, r) + r] += 0.7;
  return p;
}

Vector ruleStart(const RecurrentShape& shape, const Matrix& z, const Vector& linear, double jitter,
                 std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const Index n_z = z.rows(), each = linear.size();
  const Vector mean = z.rowwise().mean();
  Vector spread = ((z.colwise() - mean).array().square().rowwise().mean()).sqrt();
  spread = spread.cwiseMax(1e-6);
  const Matrix centres = kMeans(z, spread, shape.rules, seed);
  const double width =
      kSetWidth / std::pow(static_cast<double>(shape.rules), 1.0 / static_cast<double>(n_z));
  Vector p(shape.parameterCount());
  for (Index r = 0; r < shape.rules; ++r) {
    for (Index i = 0; i < each; ++i) p[r * each + i] = linear[i] + jitter * standardNormal(random);
    p.segment(shape.centre(r), n_z) = centres.col(r);
    p.segment(shape.logWidth(r), n_z) = (width * spread.array()).log().matrix();
  }
  return p;
}

}  // namespace fpc
