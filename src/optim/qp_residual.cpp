// How good a point is: the scaled KKT residual of a quadratic programme, each error measured
// against the terms that it is the difference of. Complementarity is min(multiplier, distance to
// the limit), both scaled.
#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "optim/qp_kernels.hpp"
#include "optim/qp_sizes.hpp"
#include "optim/qp_workspace.hpp"

namespace fpc {
namespace qp {
namespace {

constexpr double kRowRounding = 1e-14;  // of the largest coefficient

double largest(VectorRef v) { return v.size() > 0 ? v.lpNorm<Eigen::Infinity>() : 0.0; }

/// Feasibility, sign and complementarity errors of one constraint with value and multiplier y.
double constraintError(const QpProblem& p, RowNoise& noise, Index id, VectorRef x, double value,
                       double y, double y_scale) {
  const double lower = lowerOf(p, id), upper = upperOf(p, id);
  double error = 0.0;
  if (value < lower) error = (lower - value) / feasibilityScale(p, id, x, lower);
  if (value > upper) error = (value - upper) / feasibilityScale(p, id, x, upper);
  if (error > kRowRounding && noise.covers(p, id, std::max(lower - value, value - upper), x))
    error = 0.0;
  if (y == 0.0 || lower == upper) return error;
  const double limit = y > 0.0 ? lower : upper;
  const double multiplier = std::abs(y) / y_scale;
  const double distance =
      std::isinf(limit) ? multiplier : std::abs(value - limit) / feasibilityScale(p, id, x, limit);
  return std::max(error, std::min(multiplier, distance));
}

}  // namespace

double feasibilityScale(const QpProblem& p, Index id, VectorRef x, double limit) {
  const Index n = p.g.size();
  double scale = std::abs(limit);
  if (id < n) {
    scale += 1.0 + std::abs(x(id));
  } else {
    for (Index j = 0; j < n; ++j) scale += std::abs(p.A(id - n, j)) * (1.0 + std::abs(x(j)));
  }
  return std::max(scale, std::numeric_limits<double>::min());
}

bool RowNoise::within(const QpProblem& p, Index id, double violation, double tolerance, VectorRef x,
                      double x_largest, double limit) {
  if (id >= p.g.size()) {
    const double bound = std::abs(limit) + rowSum(p, id - p.g.size()) * (1.0 + x_largest);
    if (violation > 2.0 * tolerance * bound) return false;  // the scale is no more than that
  }
  return violation <= tolerance * feasibilityScale(p, id, x, limit);
}

double gradientScale(const QpProblem& p, VectorRef Hx, VectorRef y_x, VectorRef Aty) {
  return 1.0 + std::max({largest(Hx), largest(p.g), largest(y_x), largest(Aty)});
}

double RowNoise::rounding(const QpProblem& p) {
  if (largest_ < 0.0) largest_ = p.A.cwiseAbs().maxCoeff();
  return kRowRounding * largest_;
}

double RowNoise::rowSum(const QpProblem& p, Index row) {
  if (largest_sum_ < 0.0) {
    sum_.setZero(p.A.rows());
    addAbsolute(p.A.data(), p.A.rows(), p.A.cols(), sum_.data());
    largest_sum_ = sum_.maxCoeff();
  }
  return sum_(row);
}

bool RowNoise::covers(const QpProblem& p, Index id, double violation, VectorRef x) {
  const Index n = p.g.size();
  if (id < n) return false;
  // A coefficient is at least the mean of its row, and the largest of A at most a row's sum.
  if (rowSum(p, id - n) > 2.0 * static_cast<double>(n) * kRowRounding * largest_sum_) return false;
  const double limit = rounding(p);
  bool zero = true;
  for (Index j = 0; j < n; ++j) {
    const double coefficient = std::abs(p.A(id - n, j));
    if (!(coefficient <= limit)) return false;
    zero = zero && coefficient == 0.0;
  }
  return (zero && violation <= kRowRounding) || violation <= limit * (1.0 + largest(x));
}

double scaledResidual(const QpProblem& p, RowNoise& noise, VectorRef x, VectorRef y_x,
                      VectorRef y_a, VectorRef Hx, VectorRef Aty, VectorRef Ax) {
  if (!Hx.allFinite() || !Aty.allFinite() || !Ax.allFinite() || !y_x.allFinite() ||
      !y_a.allFinite()) {
    return std::numeric_limits<double>::infinity();
  }
  const Index n = x.size(), m = Ax.size();
  const double gradient = gradientScale(p, Hx, y_x, Aty);
  double error = 0.0;
  for (Index i = 0; i < n; ++i) error = std::max(error, std::abs(Hx(i) + p.g(i) - y_x(i) - Aty(i)));
  error /= gradient;
  for (Index i = 0; i < n; ++i) {
    if (y_x(i) == 0.0 && x(i) >= p.x_lower(i) && x(i) <= p.x_upper(i)) continue;
    error = std::max(error, constraintError(p, noise, i, x, x(i), y_x(i), gradient));
  }
  const double y_scale = 1.0 + largest(y_a);
  for (Index i = 0; i < m; ++i) {
    if (y_a(i) == 0.0 && Ax(i) >= p.a_lower(i) && Ax(i) <= p.a_upper(i)) continue;
    error = std::max(error, constraintError(p, noise, n + i, x, Ax(i), y_a(i), y_scale));
  }
  return error;
}

}  // namespace qp

double kktResidual(const QpProblem& problem, VectorRef x, VectorRef y_x, VectorRef y_a) {
  const Eigen::Index n = problem.g.size(), m = problem.a_lower.size();
  require(x.size() == n && y_x.size() == n && y_a.size() == m, "kktResidual",
          "x, y_x of size n and y_a of size m");
  qp::ScaledProblem scaled;
  scaled.resize(n, m);
  const QpProblem& p = scaled.scale(problem) ? scaled.problem() : problem;
  const Vector v = x.cwiseQuotient(scaled.size()), y_v = y_x.cwiseProduct(scaled.size());
  const Vector Hv = p.H * v;
  Vector Aty = Vector::Zero(n), Av(m);
  if (m > 0) {
    Aty.noalias() = p.A.transpose() * y_a;
    Av.noalias() = p.A * v;
  }
  qp::RowNoise noise;
  return qp::scaledResidual(p, noise, v, y_v, y_a, Hv, Aty, Av);
}

}  // namespace fpc
