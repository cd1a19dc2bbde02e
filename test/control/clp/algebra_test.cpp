// The algebra of the closed-loop paradigm against textbook computations: vallejo2021b, eqs. 9-14.
#include "control/clp/fixture.hpp"

#include <gtest/gtest.h>

namespace fpc::clp_test {
namespace control_clp_algebra_test {

struct Solved {
  Case made;
  ClosedLoopParadigm clp;
  ControlAction action;
  SolverReport report;
  Solved(Case given, const ClpParams& params) : made(std::move(given)), clp(made.make(params)) {
    clp.step(made.now, action, report);
  }
};

ClpParams lqParams(int n_c, double weight_input) {
  ClpParams params;
  params.perturbation_steps = n_c;
  params.cost = ClpCostKind::kLq;
  params.weight_input = Vector::Constant(1, weight_input);
  return params;
}

// H in the unscaled inputs.
Matrix inputHessian(const ClpProblem& p, Eigen::Index n) {
  const Vector unit = p.input_scale.replicate(n / p.input_scale.size(), 1);
  return p.cost_scale * (unit.cwiseInverse().asDiagonal() * p.qp.H.topLeftCorner(n, n) *
                         unit.cwiseInverse().asDiagonal());
}

double costOf(const ClpProblem& p, const Matrix& U) {
  const Vector v = flat(U).cwiseQuotient(p.input_scale.replicate(U.cols(), 1));
  const Eigen::Index n = v.size();
  return p.cost_constant +
         2.0 * p.cost_scale * (0.5 * v.dot(p.qp.H.topLeftCorner(n, n) * v) + p.qp.g.head(n).dot(v));
}

// S_c and S_cx of eq. 13 from powers of Phi, with I on the diagonal of H_cu.
struct Textbook {
  Matrix P_cl, H_c, P_clu, H_cu, S_c, S_cx;
};

Textbook textbook(const PredictiveAction& now, int n_c, const Matrix& Q, const Matrix& R) {
  const Eigen::Index n_x = now.A.rows(), n_u = now.B.cols();
  const Matrix Phi = now.A - now.B * now.K;
  Textbook m{Matrix(n_x * n_c, n_x),
             Matrix::Zero(n_x * n_c, n_u * n_c),
             Matrix(n_u * n_c, n_x),
             Matrix::Identity(n_u * n_c, n_u * n_c),
             {},
             {}};
  Matrix power = Matrix::Identity(n_x, n_x);
  for (int i = 0; i < n_c; ++i) {
    m.P_clu.middleRows(i * n_u, n_u) = -now.K * power;
    for (int j = 0; i + j < n_c; ++j) {
      m.H_c.block((i + j) * n_x, j * n_u, n_x, n_u) = power * now.B;
      if (i + j + 1 < n_c) {
        m.H_cu.block((i + j + 1) * n_u, j * n_u, n_u, n_u) = -now.K * power * now.B;
      }
    }
    power = Phi * power;
    m.P_cl.middleRows(i * n_x, n_x) = power;
  }
  Matrix P;
  EXPECT_TRUE(terminalWeight(Phi, Q, now.K.transpose() * R * now.K, P));
  Matrix Q_seq = Matrix::Zero(n_x * n_c, n_x * n_c), R_seq = Matrix::Zero(n_u * n_c, n_u * n_c);
  for (int i = 0; i < n_c; ++i) {
    Q_seq.block(i * n_x, i * n_x, n_x, n_x) = Q;
    R_seq.block(i * n_u, i * n_u, n_u, n_u) = R;
  }
  Q_seq.bottomRightCorner(n_x, n_x) += P;
  m.S_c = m.H_c.transpose() * Q_seq * m.H_c + m.H_cu.transpose() * R_seq * m.H_cu;
  m.S_cx = m.H_c.transpose() * Q_seq * m.P_cl + m.H_cu.transpose() * R_seq * m.P_clu;
  return m;
}

// A pure regulator: no offsets, setpoint 0, so that the incremental coordinates are the absolute
// ones.
Case regulator(Draw& draw, Eigen::Index n_x, Eigen::Index n_u, int n_c) {
  Case made = randomCase(draw, n_x, n_u, n_u, n_c);
  PredictiveAction& now = made.now;
  for (Vector* zero : {&now.offset_state, &now.offset_output, &now.setpoint}) zero->setZero();
  now.feedforward.setZero();
  now.reference.setZero();
  now.input_base_unclipped = baseLaw(now);
  return made;
}

TEST(TerminalWeight, SolvesItsEquationAndEqualsTheScalarSeries) {
  Matrix P;
  const auto scalar = [](double value) { return Matrix::Constant(1, 1, value); };
  ASSERT_TRUE(terminalWeight(scalar(0.5), scalar(3.0), scalar(1.0), P));
  EXPECT_DOUBLE_EQ(P(0, 0), (0.25 * 3.0 + 1.0) / (1.0 - 0.25));
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const Matrix Phi = stableMatrix(draw, 4, draw(0.1, 0.999));
    const Matrix root = draw.matrix(4, 4), Q = root * root.transpose(), KRK = Q.transpose() * Q;
    ASSERT_TRUE(terminalWeight(Phi, Q, KRK, P));
    const Matrix residual = Phi.transpose() * P * Phi - P + Phi.transpose() * Q * Phi + KRK;
    ASSERT_LE(residual.norm(), 1e-12 * P.norm());
  }
}

TEST(TerminalWeight, RefusesWhatIsNotStable) {
  Matrix P;
  const Matrix I = Matrix::Identity(2, 2);
  EXPECT_FALSE(terminalWeight(I, I, I, P));
  EXPECT_FALSE(terminalWeight(1.01 * I, I, I, P));
  const Matrix turn = (Matrix(2, 2) << 0.6, -0.8, 0.8, 0.6).finished();
  EXPECT_FALSE(terminalWeight(turn, I, I, P));
  EXPECT_TRUE(terminalWeight(0.9999999 * I, I, I, P));
}

TEST(ClpAlgebra, HessianAndGradientAreTheTextbooksInThePerturbations) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const int n_c = 2 + static_cast<int>(seed % 9);
    const Eigen::Index n_u = 1 + static_cast<Eigen::Index>(seed % 2);
    Case made = regulator(draw, 4, n_u, n_c);
    ClpParams params = lqParams(n_c, 1.0);
    params.weight_input = Vector::Constant(n_u, 0.003);
    params.weight_state_output = Vector::Constant(n_u, 2.0);
    const Solved solved(made, params);
    const PredictiveAction& now = made.now;
    const Matrix Q = 2.0 * now.C.transpose() * now.C, R = 0.003 * Matrix::Identity(n_u, n_u);
    const Textbook book = textbook(now, n_c, Q, R);
    const ClpProblem& p = solved.clp.problem();
    const Matrix to_c = p.perturbation_from_input.inverse();
    ASSERT_LE((to_c - book.H_cu).norm(), 1e-10 * book.H_cu.norm());
    const Matrix S_c = to_c.transpose() * inputHessian(p, n_u * n_c) * to_c;
    ASSERT_LE((S_c - book.S_c).norm(), 1e-9 * book.S_c.norm());
    const Vector c = draw.vector(n_u * n_c, 10.0);
    const auto inputs = [&](const Vector& perturbation) -> Matrix {
      const Vector u = to_c * (perturbation - p.perturbation_free);
      return Eigen::Map<const Matrix>(u.data(), n_u, n_c);
    };
    const double change = costOf(p, inputs(c)) - costOf(p, inputs(Vector::Zero(c.size())));
    const double expected = c.dot(book.S_c * c) + 2.0 * c.dot(book.S_cx * now.state);
    ASSERT_NEAR(change, expected, 1e-9 * (c.dot(book.S_c * c) + costOf(p, inputs(c))));
  }
}

TEST(ClpAlgebra, LqCostIsTheSumOfStageCostsOverALongRollOut) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    constexpr int kSteps = 8;
    const Case made = randomCase(draw, 3, 2, 2, kSteps);
    const PredictiveAction& now = made.now;
    ClpParams params = lqParams(kSteps, 1.0);
    params.weight_input = Vector::Constant(2, 0.005);
    const Solved solved(made, params);
    const Vector x_ss = solved.clp.steadyState(), u_ss = solved.clp.steadyInput();
    const Matrix U = draw.matrix(2, kSteps, 50.0);
    double stages = 0.0;
    Vector u;
    const Matrix path = roll(now, kSteps + 5000, [&](int i, const Vector& x) -> Vector {
      u = i < kSteps ? Vector(U.col(i)) : Vector(u_ss - now.K * (x - x_ss));
      stages += 0.005 * (u - u_ss).squaredNorm();
      return u;
    });
    stages += (now.C * (path.colwise() - x_ss)).squaredNorm();
    ASSERT_NEAR(costOf(solved.clp.problem(), U), stages, 1e-9 * stages);
  }
}

TEST(ClpAlgebra, LeastPerturbationCostIsTheSumOfItsStages) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    constexpr int kSteps = 9;
    const Case made = randomCase(draw, 4, 3, 2, kSteps);
    const PredictiveAction& now = made.now;
    ClpParams params;
    params.perturbation_steps = kSteps;
    params.weight_perturbation = (Vector(2) << 0.5, 3.0).finished();
    params.weight_tracking = (Vector(3) << 2.0, 0.0, 0.1).finished();
    const Solved solved(made, params);
    const Matrix U = draw.matrix(2, kSteps, 50.0);
    double stages = 0.0;
    const Matrix path = roll(now, kSteps, [&](int i, const Vector& x) -> Vector {
      const Vector c = U.col(i) + now.K * x - now.feedforward.col(i);
      stages += params.weight_perturbation.dot(c.cwiseAbs2());
      return U.col(i);
    });
    const Matrix miss = ((now.C * path).colwise() + now.offset_output) - now.reference;
    stages += params.weight_tracking.dot(miss.cwiseAbs2().rowwise().sum());
    ASSERT_NEAR(costOf(solved.clp.problem(), U), stages, 1e-9 * stages);
  }
}

TEST(ClpAlgebra, FreeLqOptimumIsTheRegulatorWhateverTheBaseGain) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    constexpr int kSteps = 60;
    Case made = randomCase(draw, 3, 2, 2, kSteps);
    PredictiveAction& now = made.now;
    now.A *= 0.7 / now.A.eigenvalues().cwiseAbs().maxCoeff();
    const Matrix Q = now.C.transpose() * now.C, R = 0.002 * Matrix::Identity(2, 2);
    const Matrix K_lq = riccatiGain(now.A, now.B, Q, R);
    if (seed % 2 == 0) now.K.setZero();
    now.input_base_unclipped = baseLaw(now);
    ClpParams params = lqParams(kSteps, 1.0);
    params.weight_input = Vector::Constant(2, 0.002);
    const Solved solved(made, params);
    const Vector x_ss = solved.clp.steadyState(), u_ss = solved.clp.steadyInput();
    const Vector expected = u_ss - K_lq * (now.state - x_ss);
    ASSERT_EQ(solved.report.status, SolveStatus::kSolved);
    ASSERT_LE((solved.action.input - expected).norm(), 1e-8 * std::max(1.0, expected.norm()));
  }
}

TEST(ClpAlgebra, AtTheLqOptimalGainTheHessianIsBlockDiagonalAndThePerturbationZero) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    constexpr int kSteps = 42;
    Case made = randomCase(draw, 3, 2, 2, kSteps);
    PredictiveAction& now = made.now;
    const Matrix Q = now.C.transpose() * now.C, R = 0.002 * Matrix::Identity(2, 2);
    now.K = riccatiGain(now.A, now.B, Q, R);
    now.input_base_unclipped = baseLaw(now);
    ClpParams params = lqParams(kSteps, 1.0);
    params.weight_input = Vector::Constant(2, 0.002);
    const Solved solved(made, params);
    const ClpProblem& p = solved.clp.problem();
    const Matrix to_c = p.perturbation_from_input.inverse();
    const Matrix S_c = to_c.transpose() * inputHessian(p, 2 * kSteps) * to_c;
    Matrix off = S_c, block = S_c.topLeftCorner(2, 2);
    for (int i = 0; i < kSteps; ++i) {
      ASSERT_LE((S_c.block(2 * i, 2 * i, 2, 2) - block).norm(), 1e-9 * block.norm());
      off.block(2 * i, 2 * i, 2, 2).setZero();
    }
    ASSERT_LE(off.norm(), 1e-9 * S_c.norm());
    const Matrix U = plannedInputs(solved.clp, kSteps);
    const Vector c = p.perturbation_from_input * flat(U) + p.perturbation_free;
    ASSERT_LE(c.cwiseAbs().maxCoeff(), 1e-9 * std::max(1.0, U.norm()));
  }
}

TEST(ClpAlgebra, SteadyStateHoldsTheTargetOutputsAtTheirSetpoint) {
  Case made = sludgeLike(10);
  ClpParams params = lqParams(10, 1.0);
  params.target_outputs = {1};
  const Solved solved(made, params);
  const PredictiveAction& now = made.now;
  const Vector x = solved.clp.steadyState(), u = solved.clp.steadyInput();
  EXPECT_LE((now.A * x + now.B * u + now.offset_state - x).norm(), 1e-9);
  EXPECT_NEAR((now.C * x + now.offset_output)[1], 2000.0, 1e-9);
  EXPECT_NEAR(u[0], x[2], 1e-9);
}

TEST(ClpAlgebra, AnIntegratorHasASteadyStateToo) {
  Case made = firstOrderLag(1.0, 0.5, 0.8, 0.0, 6, 3.0);
  made.now.setpoint[0] = 7.0;
  made.now.offset_state[0] = 0.25;
  const Solved solved(made, lqParams(6, 1.0));
  EXPECT_NEAR(solved.clp.steadyState()[0], 7.0, 1e-12);
  EXPECT_NEAR(solved.clp.steadyInput()[0], -0.5, 1e-12);
  EXPECT_EQ(solved.report.status, SolveStatus::kSolved);
}

}  // namespace control_clp_algebra_test
}  // namespace fpc::clp_test
