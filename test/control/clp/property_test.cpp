// Seeded properties of the closed-loop paradigm: nothing happens without need, limits hold with it.
#include "control/clp/fixture.hpp"

#include <gtest/gtest.h>

namespace fpc::clp_test {
namespace control_clp_property_test {

constexpr int kCases = 1000;

// Limits around the rolled-out base law; spare > 0 leaves room, spare < 0 cuts into it.
InputLimits limitsAround(const PredictiveAction& now, int n_c, double spare, bool moves) {
  const Eigen::Index n_u = now.K.rows();
  Matrix u(n_u, n_c);
  roll(now, n_c, [&](int i, const Vector& x) -> Vector {
    return u.col(i) = now.feedforward.col(i) - now.K * x;
  });
  InputLimits limits;
  const Vector high = u.rowwise().maxCoeff(), low = u.rowwise().minCoeff();
  const Vector margin = spare * (high - low).array() + spare * 1e-3;
  limits.lower = low - margin;
  limits.upper = high + margin;
  Vector step = (u.col(0) - now.input_previous).cwiseAbs();
  for (int i = 1; i < n_c; ++i) step = step.cwiseMax((u.col(i) - u.col(i - 1)).cwiseAbs());
  limits.move = moves ? Vector((1.0 + spare) * step) : Vector::Constant(n_u, kInfinity);
  return limits;
}

struct Sizes {
  Eigen::Index n_x, n_y, n_u;
  int n_c;
};

Sizes randomSizes(Draw& draw) {
  const auto pick = [&](double least, double most) { return static_cast<int>(draw(least, most)); };
  const Eigen::Index n_u = pick(1, 4);
  return {n_u + pick(0, 4), n_u, n_u, pick(2, 13)};  // n_x < n_u would have no single steady state
}

double overshoot(const Vector& u, const Vector& lower, const Vector& upper) {
  return std::max((lower - u).maxCoeff(), (u - upper).maxCoeff());
}

TEST(ClosedLoopParadigmProperty, InactiveLimitsLeaveTheBaseLawBitwiseAlone) {
  for (std::uint64_t seed = 1; seed <= kCases; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const Sizes s = randomSizes(draw);
    Case made = randomCase(draw, s.n_x, s.n_y, s.n_u, s.n_c);
    made.limits = limitsAround(made.now, s.n_c, 0.1, draw(0.0, 1.0) < 0.5);
    ClpParams params;
    params.perturbation_steps = s.n_c;
    ClosedLoopParadigm clp = made.make(params);
    ControlAction action;
    SolverReport report;
    clp.step(made.now, action, report);
    ASSERT_TRUE(action.input == made.now.input_base_unclipped);
    ASSERT_TRUE(report.perturbation.isZero(0.0));
    ASSERT_EQ(report.status, SolveStatus::kSolved);
    ASSERT_EQ(action.source, ActionSource::kBase);
    ASSERT_EQ(report.iterations, 0u);
  }
}

TEST(ClosedLoopParadigmProperty, TheProgrammeItselfFindsNoPerturbationWhenInactive) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const Sizes s = randomSizes(draw);
    Case made = randomCase(draw, s.n_x, s.n_y, s.n_u, s.n_c);
    made.limits = limitsAround(made.now, s.n_c, 0.1, false);
    ClpParams params;
    params.perturbation_steps = s.n_c;
    ClosedLoopParadigm clp = made.make(params);
    ControlAction action;
    SolverReport report;
    clp.step(made.now, action, report);
    const QpProblem& qp = clp.problem().qp;
    const Vector free = qp.H.ldlt().solve(-qp.g);
    const Matrix planned = plannedInputs(clp, s.n_c);
    const Vector unit = clp.problem().input_scale.replicate(s.n_c, 1);
    ASSERT_LE((free.cwiseProduct(unit) - flat(planned)).norm(), 1e-8 * planned.norm());
  }
}

TEST(ClosedLoopParadigmProperty, ActiveLimitsAreNeverViolated) {
  int active = 0;
  for (std::uint64_t seed = 1; seed <= kCases; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const Sizes s = randomSizes(draw);
    Case made = randomCase(draw, s.n_x, s.n_y, s.n_u, s.n_c);
    made.limits = limitsAround(made.now, s.n_c, -0.3, false);
    if (draw(0.0, 1.0) < 0.5) {
      made.limits.move = 0.2 * (made.limits.upper - made.limits.lower);
      made.now.input_previous = 0.5 * (made.limits.upper + made.limits.lower);
    }
    ClpParams params;
    params.perturbation_steps = s.n_c;
    params.cost = seed % 3 == 0 ? ClpCostKind::kLq : ClpCostKind::kLeastPerturbation;
    if (seed % 3 == 1) params.weight_tracking = Vector::Constant(s.n_y, 0.5);
    ClosedLoopParadigm clp = made.make(params);
    ControlAction action;
    SolverReport report;
    clp.step(made.now, action, report);
    ASSERT_EQ(report.status, SolveStatus::kSolved);
    ASSERT_LE(report.kkt_residual, 1e-9);
    const QpResult& found = clp.solution();
    ASSERT_LE(kktResidual(clp.problem().qp, found.x, found.y_x, found.y_a), 1e-9);
    const InputLimits& limits = made.limits;
    ASSERT_LE(overshoot(action.input, limits.lower, limits.upper), 0.0);
    const Vector range = limits.upper - limits.lower;
    Vector before = made.now.input_previous;
    const Matrix planned = plannedInputs(clp, s.n_c);
    for (int i = 0; i < s.n_c; ++i) {
      const Vector u = planned.col(i);
      ASSERT_LE(overshoot(u, limits.lower - 1e-9 * range, limits.upper + 1e-9 * range), 0.0) << i;
      ASSERT_LE(((u - before).cwiseAbs() - limits.move - 1e-9 * range).maxCoeff(), 0.0) << i;
      before = u;
    }
    active += report.active_rows > 0;
  }
  EXPECT_GE(active, kCases * 9 / 10);
}

// The plant differs from the model; the law chases setpoints that its inputs cannot reach.
void runClosedLoop(std::uint64_t seed, Eigen::Index n_io, const ClpParams& params) {
  Draw draw(seed);
  const int n_c = params.perturbation_steps;
  Case made = randomCase(draw, n_io + 1, n_io, n_io, n_c);
  PredictiveAction& now = made.now;
  made.limits = {Vector::Constant(n_io, -20.0), Vector::Constant(n_io, 30.0),
                 Vector::Constant(n_io, 7.0)};
  const Matrix A = now.A + draw.matrix(n_io + 1, n_io + 1, 0.02);
  const Matrix B = now.B * draw(0.8, 1.2);
  ClosedLoopParadigm clp = made.make(params);
  ControlAction action;
  SolverReport report;
  now.input_previous.setZero();
  int active = 0;
  for (int k = 0; k < 150; ++k) {
    if (k % 30 == 0) {
      const Matrix asked = draw.vector(n_io, 80.0);
      now.feedforward = asked.replicate(1, n_c);
    }
    now.input_base_unclipped = baseLaw(now);
    clp.step(now, action, report);
    ASSERT_EQ(report.status, SolveStatus::kSolved) << k;
    ASSERT_LE(report.kkt_residual, 1e-9) << k;
    ASSERT_LE(overshoot(action.input, made.limits.lower, made.limits.upper), 0.0) << k;
    const Vector move = (action.input - now.input_previous).cwiseAbs();
    ASSERT_LE((move - made.limits.move).maxCoeff(), 1e-12) << k;
    active += report.active_rows > 0;
    now.state = A * now.state + B * action.input + now.offset_state;
    now.input_previous = action.input;
  }
  EXPECT_GT(active, 5);
}

TEST(ClosedLoopParadigmProperty, LimitsHoldInClosedLoopWithAWrongModel) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    ClpParams params;
    params.perturbation_steps = 12;
    runClosedLoop(seed, 1, params);
    runClosedLoop(seed, 2, params);
  }
}

TEST(ClosedLoopParadigmProperty, LimitsHoldWithSoftOutputs) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    ClpParams params;
    params.perturbation_steps = 10;
    params.output_upper = Vector::Constant(2, 3.0);
    params.output_lower = Vector::Constant(2, -5.0);
    runClosedLoop(seed, 2, params);
  }
}

TEST(ClosedLoopParadigmProperty, StackedPredictionEqualsSteppingTheModel) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const Sizes s = randomSizes(draw);
    const Case made = randomCase(draw, s.n_x, s.n_y, s.n_u, s.n_c);
    const PredictiveAction& now = made.now;
    ClpParams params;
    params.perturbation_steps = s.n_c;
    ClosedLoopParadigm clp = made.make(params);
    ControlAction action;
    SolverReport report;
    clp.step(now, action, report);
    const Matrix U = draw.matrix(s.n_u, s.n_c, 100.0);
    Matrix c(s.n_u, s.n_c);
    const Matrix stepped = roll(now, s.n_c, [&](int i, const Vector& x) -> Vector {
      c.col(i) = U.col(i) + now.K * x - now.feedforward.col(i);
      return U.col(i);
    });
    const ClpProblem& p = clp.problem();
    const Vector X = p.state_free + p.state_from_input * flat(U);
    const Vector T_U = p.perturbation_from_input * flat(U) + p.perturbation_free;
    ASSERT_LE((X - flat(stepped)).norm(), 1e-10 * stepped.norm());
    ASSERT_LE((T_U - flat(c)).norm(), 1e-10 * c.norm());
    ASSERT_TRUE(p.perturbation_from_input.isLowerTriangular(0.0));
    ASSERT_TRUE((p.perturbation_from_input.diagonal().array() == 1.0).all());
  }
}

}  // namespace control_clp_property_test
}  // namespace fpc::clp_test
