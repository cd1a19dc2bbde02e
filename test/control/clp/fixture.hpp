// Predictive actions for tests of the closed-loop paradigm: a first-order lag, a plant like the
// activated sludge, seeded random stable systems, and the textbook computations they are compared
// with.
#pragma once

#include "control/clp/closed_loop_paradigm.hpp"

#include <cstdint>
#include <random>

#include <Eigen/Dense>

namespace fpc::clp_test {

/// Uniform numbers, the same on every machine.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  double operator()(double lower, double upper) {
    return lower + (upper - lower) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  Matrix matrix(Eigen::Index rows, Eigen::Index cols, double size = 1.0) {
    return Matrix::NullaryExpr(rows, cols, [&] { return (*this)(-size, size); });
  }
  Vector vector(Eigen::Index n, double size = 1.0) { return matrix(n, 1, size); }

 private:
  std::mt19937_64 engine_;
};

struct Case {
  PredictiveAction now;
  InputLimits limits;
  ClosedLoopParadigm make(const ClpParams& params) const {
    return ClosedLoopParadigm(params, limits, now.A.rows(), now.C.rows(), now.B.cols());
  }
};

inline Vector baseLaw(const PredictiveAction& now) {
  return now.feedforward.col(0) - now.K * now.state;
}

/// Gain of the infinite-horizon regulator by iterating the Riccati difference equation.
inline Matrix riccatiGain(const Matrix& A, const Matrix& B, const Matrix& Q, const Matrix& R) {
  Matrix P = Q;
  for (double change = 1.0; change > 1e-15;) {
    const Matrix K = (R + B.transpose() * P * B).ldlt().solve(B.transpose() * P * A);
    const Matrix next = Q + A.transpose() * P * (A - B * K);
    change = (next - P).norm() / next.norm();
    P = 0.5 * (next + next.transpose());
  }
  return (R + B.transpose() * P * B).ldlt().solve(B.transpose() * P * A);
}

inline Matrix stableMatrix(Draw& draw, Eigen::Index n, double radius) {
  const Matrix A = draw.matrix(n, n);
  return A * (radius / A.eigenvalues().cwiseAbs().maxCoeff());
}

/// y(k+1) = a y(k) + b u(k), base law u = -K y + feedforward, no offsets.
inline Case firstOrderLag(double a, double b, double K, double feedforward, int n_c, double y) {
  Case made;
  PredictiveAction& now = made.now;
  now.state = Vector::Constant(1, y);
  now.A = Matrix::Constant(1, 1, a);
  now.B = Matrix::Constant(1, 1, b);
  now.C = Matrix::Identity(1, 1);
  now.offset_state = now.offset_output = now.setpoint = now.input_previous = Vector::Zero(1);
  now.K = Matrix::Constant(1, 1, K);
  now.feedforward = Matrix::Constant(1, n_c, feedforward);
  now.reference = Matrix::Zero(1, n_c);
  now.input_base_unclipped = baseLaw(now);
  made.limits = {Vector::Constant(1, -1e3), Vector::Constant(1, 1e3),
                 Vector::Constant(1, kInfinity)};
  return made;
}

/// Substrate, biomass and u(k-1) near the nominal point of the activated-sludge plant; u moves the
/// biomass.
inline Case sludgeLike(int n_c) {
  Case made;
  PredictiveAction& now = made.now;
  now.A = (Matrix(3, 3) << 0.76, -0.004, -0.002, 0.0, 0.97, 0.02, 0.0, 0.0, 0.0).finished();
  now.B = (Matrix(3, 1) << -0.003, 0.03, 1.0).finished();
  now.C = Matrix::Identity(2, 3);
  now.state = (Vector(3) << 57.0, 1960.0, 560.0).finished();
  now.offset_state = (Vector(3) << 24.0, 32.0, 0.0).finished();
  now.offset_output = (Vector(2) << 0.3, -2.0).finished();
  now.K = (Matrix(1, 3) << 0.0, 4.0, 0.1).finished();
  now.feedforward = Matrix::Constant(1, n_c, 8700.0);
  now.reference = (Vector(2) << 55.0, 2000.0).finished().replicate(1, n_c);
  now.setpoint = (Vector(2) << 55.0, 2000.0).finished();
  now.input_previous = Vector::Constant(1, 560.0);
  now.input_base_unclipped = baseLaw(now);
  made.limits = {Vector::Constant(1, 0.0), Vector::Constant(1, 1600.0),
                 Vector::Constant(1, kInfinity)};
  return made;
}

/// A stable system with a regulator of random weights and wide limits; inputs near 100, outputs
/// near 10.
inline Case randomCase(Draw& draw, Eigen::Index n_x, Eigen::Index n_y, Eigen::Index n_u, int n_c) {
  Case made;
  PredictiveAction& now = made.now;
  now.A = stableMatrix(draw, n_x, draw(0.4, 0.95));
  now.B = draw.matrix(n_x, n_u, 0.1);
  now.C = draw.matrix(n_y, n_x);
  now.state = draw.vector(n_x, 10.0);
  now.offset_state = draw.vector(n_x);
  now.offset_output = draw.vector(n_y);
  now.K = riccatiGain(now.A, now.B, now.C.transpose() * now.C,
                      draw(0.001, 0.1) * Matrix::Identity(n_u, n_u));
  now.feedforward = draw.matrix(n_u, n_c, 50.0);
  now.reference = draw.matrix(n_y, n_c, 10.0);
  now.setpoint = draw.vector(n_y, 10.0);
  now.input_previous = draw.vector(n_u, 50.0);
  now.input_base_unclipped = baseLaw(now);
  made.limits = {Vector::Constant(n_u, -1e6), Vector::Constant(n_u, 1e6),
                 Vector::Constant(n_u, kInfinity)};
  return made;
}

/// x(k+1)..x(k+steps) by stepping the model; mode 2 follows `law(i, x)`.
template <typename Law>
Matrix roll(const PredictiveAction& now, int steps, const Law& input) {
  Matrix path(now.state.size(), steps);
  Vector x = now.state;
  for (int i = 0; i < steps; ++i) {
    const Vector u = input(i, x);
    x = now.A * x + now.B * u + now.offset_state;
    path.col(i) = x;
  }
  return path;
}

/// The inputs that the last step decided, n_u n_c.
inline Matrix plannedInputs(const ClosedLoopParadigm& clp, Eigen::Index n_c) {
  const Vector& unit = clp.problem().input_scale;
  return unit.asDiagonal() * Eigen::Map<const Matrix>(clp.solution().x.data(), unit.size(), n_c);
}

/// One step of a fresh paradigm.
struct Outcome {
  ControlAction action;
  SolverReport report;
  Matrix planned;  ///< inputs over mode 1
  double input() const { return action.input[0]; }
};

inline Outcome decide(const Case& made, const ClpParams& params) {
  ClosedLoopParadigm clp = made.make(params);
  Outcome out;
  clp.step(made.now, out.action, out.report);
  out.planned = plannedInputs(clp, params.perturbation_steps);
  return out;
}

inline ClpParams steps(int n_c) {
  ClpParams params;
  params.perturbation_steps = n_c;
  return params;
}

inline Vector one(double value) { return Vector::Constant(1, value); }

/// A base law that asks for 50 at first and decays: a lag of 0.9 under u = -5 y, from y = -10.
inline Case eager(int n_c) { return firstOrderLag(0.9, 0.1, 5.0, 0.0, n_c, -10.0); }

}  // namespace fpc::clp_test
