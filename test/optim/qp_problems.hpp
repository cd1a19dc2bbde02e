// Quadratic programmes for the tests and benchmarks of the solver: random ones whose answer is
// known, and the ones a predictive controller makes.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "optim/qp.hpp"

namespace fpc::testing {

/// min 1/2 |x|^2 over two unknowns with x_1 + x_2 >= 2: x = (1, 1), y_a = 1.
inline QpProblem nearestPointOfHalfPlane() {
  QpProblem p(2, 1);
  p.A << 1.0, 1.0;
  p.a_lower << 2.0;
  return p;
}

/// Draws for the generators below.
class Draw {
 public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  Eigen::Index index(Eigen::Index low, Eigen::Index high) {
    return std::uniform_int_distribution<Eigen::Index>(low, high)(engine_);
  }
  Vector vector(Eigen::Index n, double size = 1.0) {
    Vector v(n);
    for (double& value : v) value = uniform(-size, size);
    return v;
  }
  Matrix matrix(Eigen::Index rows, Eigen::Index columns) {
    Matrix M(rows, columns);
    for (double& value : flat(M)) value = uniform(-1.0, 1.0);
    return M;
  }

 private:
  std::mt19937_64 engine_;
};

struct KnownQp {
  QpProblem problem;
  Vector x, y_x, y_a;
};

/// Sets limits of one constraint with the given value so that the returned multiplier is optimal.
inline double drawLimits(Draw& draw, double value, bool active, double size, double& lower,
                         double& upper) {
  const double room = size * draw.uniform(0.1, 2.0);
  lower = draw.chance(0.3) ? -kInfinity : value - room;
  upper = draw.chance(0.3) ? kInfinity : value + size * draw.uniform(0.1, 2.0);
  if (!active) return 0.0;
  const double y = draw.uniform(0.1, 3.0);
  if (draw.chance(0.15)) {
    lower = upper = value;
    return draw.chance(0.5) ? y : -y;
  }
  if (draw.chance(0.5)) {
    lower = value;
    return y;
  }
  upper = value;
  return -y;
}

/// A random problem with a known optimum: x, multipliers and active constraints are drawn first,
/// then the data that make them optimal. The active normals are independent (at most n of them,
/// rows random), so multipliers are unique.
inline KnownQp knownQp(Draw& draw, Eigen::Index n, Eigen::Index m) {
  KnownQp known{QpProblem(n, m), draw.vector(n, 2.0), Vector::Zero(n), Vector::Zero(m)};
  QpProblem& p = known.problem;
  const Matrix F = draw.matrix(n, n);
  p.H = F * F.transpose() + 0.1 * Matrix::Identity(n, n);
  p.H = (0.5 * (p.H + p.H.transpose())).eval();
  p.A = draw.matrix(m, n);
  Eigen::Index room = (3 * n) / 4;
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool active = room > 0 && draw.chance(0.35);
    known.y_x(i) = drawLimits(draw, known.x(i), active, 1.0, p.x_lower(i), p.x_upper(i));
    room -= active;
  }
  const Vector Ax = p.A * known.x;
  for (Eigen::Index i = 0; i < m; ++i) {
    const bool active = room > 0 && draw.chance(0.3);
    known.y_a(i) = drawLimits(draw, Ax(i), active, 1.0, p.a_lower(i), p.a_upper(i));
    room -= active;
  }
  p.g = known.y_x + p.A.transpose() * known.y_a - p.H * known.x;
  return known;
}

/// Makes the last row a positive combination of finite upper limits, asked to exceed their sum by
/// `gap`.
inline void makeInfeasible(Draw& draw, QpProblem& p, double gap) {
  const Eigen::Index n = p.g.size(), last = p.a_lower.size() - 1;
  p.A.row(last).setZero();
  double reach = 0.0;
  for (int k = 0; k < 8; ++k) {
    const double weight = draw.uniform(0.1, 2.0);
    const Eigen::Index i = draw.index(0, n - 1), row = draw.index(0, last - 1);
    if (draw.chance(0.5) && std::isfinite(p.x_upper(i))) {
      p.A(last, i) += weight;
      reach += weight * p.x_upper(i);
    } else if (std::isfinite(p.a_upper(row))) {
      p.A.row(last) += weight * p.A.row(row);
      reach += weight * p.a_upper(row);
    }
  }
  p.a_lower(last) = reach + gap;
  p.a_upper(last) = kInfinity;
}

/// Farkas: y_x + A'y_a must vanish while the limits that y stands for add up to more than zero. Own
/// arithmetic (long double): no x with |x_j| <= radius can be inside all limits.
inline bool provesInfeasible(const QpProblem& p, const Vector& y_x, const Vector& y_a,
                             double radius) {
  using Long = long double;
  Long support = 0.0L, error = 0.0L;
  const auto add = [&](double y, double lower, double upper) {
    if (y != 0.0) support += static_cast<Long>(y) * static_cast<Long>(y > 0.0 ? lower : upper);
  };
  for (Eigen::Index i = 0; i < y_x.size(); ++i) add(y_x(i), p.x_lower(i), p.x_upper(i));
  for (Eigen::Index i = 0; i < y_a.size(); ++i) add(y_a(i), p.a_lower(i), p.a_upper(i));
  for (Eigen::Index j = 0; j < y_x.size(); ++j) {
    Long sum = y_x(j);
    for (Eigen::Index i = 0; i < y_a.size(); ++i)
      sum += static_cast<Long>(p.A(i, j)) * static_cast<Long>(y_a(i));
    error += std::abs(sum);
  }
  return std::isfinite(support) && support > static_cast<Long>(radius) * error;
}

/// What a predictive controller asks for over 42 samples: inputs near those of a base law (least
/// perturbation), inside bounds, with move limits and soft limits on two outputs that share a slack
/// each.
struct ControllerQp {
  static constexpr Eigen::Index kSteps = 42;
  enum class Kind { kBounds, kMoves, kOutputs };

  explicit ControllerQp(Kind k) : kind(k), problem(unknowns(k), rows(k)) {}
  static Eigen::Index unknowns(Kind k) { return k == Kind::kOutputs ? kSteps + 2 : kSteps; }
  static Eigen::Index rows(Kind k) {
    return k == Kind::kBounds ? 0 : k == Kind::kMoves ? kSteps - 1 : kSteps - 1 + 2 * kSteps;
  }

  /// The problem at time t: model, state and disturbance drift slowly with it.
  void update(double t) {
    const Eigen::Index n = problem.g.size();
    Eigen::Matrix2d A;
    A << 0.90 + 0.02 * std::sin(0.7 * t), 0.12, -0.08, 0.85 + 0.02 * std::cos(0.3 * t);
    const Eigen::Vector2d B(0.4 + 0.02 * std::sin(t), 0.25);
    const Eigen::RowVector2d K(0.9, 0.5 + 0.1 * std::cos(0.5 * t));
    Eigen::Vector2d free(900.0 * std::sin(0.9 * t), 700.0 * std::cos(1.3 * t));
    Matrix T = Matrix::Identity(kSteps, kSteps);
    Vector offset(kSteps);
    Matrix effect = Matrix::Zero(2, kSteps);  // of the inputs on the state after step i
    const Eigen::Index outputs_at = kSteps - 1;
    for (Eigen::Index i = 0; i < kSteps; ++i) {
      const double feedforward = 700.0 + 1000.0 * std::sin(t + 0.15 * static_cast<double>(i));
      T.row(i) += K * effect;
      offset(i) = K * free - feedforward;
      effect = (A * effect).eval();
      effect.col(i) += B;
      free = (A * free).eval();
      if (kind != Kind::kOutputs) continue;
      for (Eigen::Index y = 0; y < 2; ++y) {
        const Eigen::Index row = outputs_at + 2 * i + y;
        problem.A.row(row).head(kSteps) = effect.row(y);
        problem.A(row, kSteps + y) = -1.0;
        problem.a_upper(row) = (y == 0 ? 2900.0 : 400.0) - free(y);
      }
    }
    problem.H.setIdentity();
    problem.H.topLeftCorner(kSteps, kSteps) = T.transpose() * T;
    problem.g.setZero();
    problem.g.head(kSteps) = T.transpose() * offset;
    problem.x_lower.head(kSteps).setZero();
    problem.x_upper.head(kSteps).setConstant(1600.0);
    for (Eigen::Index s = kSteps; s < n; ++s) {
      problem.H(s, s) = 1e4;
      problem.x_lower(s) = 0.0;
    }
    if (kind == Kind::kBounds) return;
    for (Eigen::Index i = 0; i + 1 < kSteps; ++i) {
      problem.A(i, i) = -1.0;
      problem.A(i, i + 1) = 1.0;
      problem.a_lower(i) = -120.0;
      problem.a_upper(i) = 120.0;
    }
  }

  Kind kind;
  QpProblem problem;
};

}  // namespace fpc::testing
