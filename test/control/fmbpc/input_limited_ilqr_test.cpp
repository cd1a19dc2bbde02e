// Plans along a fuzzy model against what a quadratic programme says where both must agree.
#include "control/fmbpc/input_limited_ilqr.hpp"

#include <gtest/gtest.h>

#include <string>

#include "control/fmbpc/law_fixture.hpp"
#include "optim/qp.hpp"

namespace fpc {
namespace control_fmbpc_input_limited_ilqr_test {

constexpr int kHorizon = 12;

/// A planner, the same model to judge its plans by, and a task for it.
struct Task {
  Task(const TsModel& model, InputLimits limits_, std::uint64_t seed)
      : generator(seed),
        limits(std::move(limits_)),
        local(model),
        params{kHorizon,
               60,
               Vector::Ones(count(model.outputs)),
               Vector::Constant(count(model.inputs), 0.1),
               Vector::Constant(count(model.inputs), seed % 2 == 0 ? 0.05 : 0.0),
               Vector::Constant(count(model.inputs), 0.3)},
        planner(local, params, limits),
        state(test::randomVector(generator, local.stateSize())),
        correction(Vector::Zero(local.stateSize())),
        offset(test::randomVector(generator, count(model.outputs), 0.2)),
        previous(count(model.inputs)),
        loads(test::randomVector(generator, count(model.disturbances)).replicate(1, kHorizon)),
        reference(test::randomVector(generator, count(model.outputs), 2.0).replicate(1, kHorizon)) {
    for (Eigen::Index a = 0; a < previous.size(); ++a)
      previous[a] = state[local.inputState(a, 1)] = 0.5 * state[local.inputState(a, 1)];
  }
  static Eigen::Index count(const std::vector<SignalInfo>& signals) {
    return static_cast<Eigen::Index>(signals.size());
  }
  bool plan() { return planner.plan(state, correction, offset, loads, reference, previous); }

  /// Square roots of the terms of the cost under these inputs (n_u kHorizon), stacked.
  Vector residuals(const Matrix& inputs) {
    const Eigen::Index n_y = offset.size(), n_u = previous.size();
    Vector r((n_y + 2 * n_u) * kHorizon), xi = state, before = previous;
    for (Eigen::Index i = 0; i < kHorizon; ++i) {
      local.blend(xi, inputs.col(i), loads.col(i));
      const AffineModel& m = local.affine();
      xi = (m.A * xi + m.B * inputs.col(i) + m.g).eval();
      const Eigen::Index row = i * (n_y + 2 * n_u);
      r.segment(row, n_y) = m.C * xi + offset - reference.col(i);
      r.segment(row + n_y, n_u) = std::sqrt(0.1) * (inputs.col(i) - before);
      r.segment(row + n_y + n_u, n_u) =
          params.weight_input.cwiseSqrt().cwiseProduct(inputs.col(i) - params.input_target);
      before = inputs.col(i);
    }
    return r;
  }

  std::mt19937_64 generator;
  InputLimits limits;
  LocalModel local;
  IlqrParams params;
  InputLimitedIlqr planner;
  Vector state, correction, offset, previous;
  Matrix loads, reference;
};

/// One rule; of even seeds with dead times, one input's longer at one output.
TsModel linear(std::mt19937_64& generator, std::uint64_t seed = 1) {
  const int delay = seed % 2 == 0 ? 5 : 1;
  TsModel model = test::randomModel(generator, {2, 2, 1, 1, 2, delay, 2, 1});
  OutputModel& second = model.submodels[1];
  for (std::size_t k = 0; k < second.regressors.size() && delay > 1; ++k) {
    const Regressor& r = second.regressors[k];
    if (r.kind == SignalKind::kInput && r.index == 1 && r.lag == delay)
      second.rules[0].coefficients[static_cast<Eigen::Index>(k)] = 0.0;
  }
  return model;
}

/// The same task as a programme over all inputs: residuals are affine in them.
QpResult solveAsProgramme(Task& task) {
  const Eigen::Index n_u = task.previous.size(), n = n_u * kHorizon;
  Matrix inputs = Matrix::Zero(n_u, kHorizon);
  const Vector r = task.residuals(inputs);
  Matrix J(r.size(), n);
  for (Eigen::Index j = 0; j < n; ++j) {
    inputs(j % n_u, j / n_u) = 1.0;
    J.col(j) = task.residuals(inputs) - r;
    inputs(j % n_u, j / n_u) = 0.0;
  }
  QpProblem problem(n, n);  // rows: moves
  problem.A.setIdentity();
  problem.A.bottomRows(n - n_u).leftCols(n - n_u).diagonal().array() -= 1.0;
  problem.a_upper = task.limits.move.replicate(kHorizon, 1);
  problem.a_lower = -problem.a_upper;
  problem.a_upper.head(n_u) += task.previous;
  problem.a_lower.head(n_u) += task.previous;
  problem.H = J.transpose() * J;
  problem.g = J.transpose() * r;
  problem.x_lower = task.limits.lower.replicate(kHorizon, 1);
  problem.x_upper = task.limits.upper.replicate(kHorizon, 1);
  return QpSolver(n, n).solve(problem);
}

class PlanOfALinearModel : public ::testing::TestWithParam<double> {};

TEST_P(PlanOfALinearModel, IsTheSolutionOfTheQuadraticProgramme) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    Task task(linear(generator, seed), test::wideLimits(2, GetParam()), seed);
    ASSERT_TRUE(task.plan());
    const QpResult answer = solveAsProgramme(task);
    ASSERT_TRUE(answer.usable());
    const Matrix best = Eigen::Map<const Matrix>(answer.x.data(), 2, kHorizon);
    const double least = task.residuals(best).squaredNorm();
    EXPECT_NEAR(task.planner.cost(), task.residuals(task.planner.inputs()).squaredNorm(),
                1e-9 * (1.0 + least));
    EXPECT_LE(task.planner.cost(), (1.0 + 1e-3) * least);
    EXPECT_GE(task.planner.cost(), (1.0 - 1e-9) * least);
    EXPECT_LE(task.planner.inputs().cwiseAbs().maxCoeff(), GetParam());
  }
}

// An input at its move limit follows the one before. Where a bound and a move limit change places
// along the horizon, the sweep stops short of the least: by 0.0085 at most of the 180 plans here,
// and by 1.4e-5 where the bounds are wide. It was 0.17 when such an input stood still.
TEST_P(PlanOfALinearModel, IsTheSolutionWithMoveLimitsAsWell) {
  double dearest = 0.0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    InputLimits limits = test::wideLimits(2, GetParam());
    const double move = seed % 3 == 0 ? 0.05 : 0.15;
    limits.move = test::pair(move, seed % 2 == 0 ? kInfinity : 2.0 * move);
    Task task(linear(generator, seed), limits, seed);
    ASSERT_TRUE(task.plan());
    const QpResult answer = solveAsProgramme(task);
    ASSERT_TRUE(answer.usable());
    const Matrix best = Eigen::Map<const Matrix>(answer.x.data(), 2, kHorizon);
    const double least = task.residuals(best).squaredNorm();
    dearest = std::max(dearest, task.planner.cost() / least - 1.0);
    EXPECT_GE(task.planner.cost(), (1.0 - 1e-9) * least);
  }
  EXPECT_LE(dearest, GetParam() < 1.0 ? 0.01 : 1e-4);
}

// Where only five errors count, the plan is that of a horizon of five, and holds its last input.
TEST(InputLimitedIlqr, ErrorsThatDoNotCountShortenTheHorizon) {
  for (std::uint64_t seed = 1; seed <= 19; seed += 2) {  // no weight_input, which counts to the end
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    Task task(linear(generator), test::wideLimits(2, 1.0), seed);
    task.planner.countErrors(5);
    ASSERT_TRUE(task.plan());
    IlqrParams params = task.params;
    params.horizon_steps = 5;
    InputLimitedIlqr near(task.local, params, task.limits);
    ASSERT_TRUE(near.plan(task.state, task.correction, task.offset, task.loads, task.reference,
                          task.previous));
    EXPECT_NEAR(task.planner.cost(), near.cost(), 1e-9 * (1.0 + near.cost()));
    for (Eigen::Index i = 0; i < kHorizon; ++i) {
      const Vector expected = near.inputs().col(std::min<Eigen::Index>(i, 4));
      EXPECT_LE((task.planner.inputs().col(i) - expected).cwiseAbs().maxCoeff(), 1e-6) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(FreeAndBound, PlanOfALinearModel, ::testing::Values(1e6, 2.0, 0.6));

TEST(InputLimitedIlqr, KeepsBoundsAndMovesOnEveryModel) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    InputLimits limits = test::wideLimits(2, 1.0);
    limits.move = test::pair(0.2, 0.3);
    Task task(test::randomModel(generator, {}), limits, seed);
    ASSERT_TRUE(task.plan());
    Vector before = task.previous;
    for (Eigen::Index i = 0; i < kHorizon; ++i) {
      const Vector u = task.planner.inputs().col(i);
      EXPECT_TRUE(((u - before).cwiseAbs().array() <= limits.move.array() + 1e-12).all());
      EXPECT_TRUE((u.array().abs() <= 1.0).all());
      before = u;
    }
  }
}

TEST(InputLimitedIlqr, IsNoWorseThanHoldingTheInputOnEveryModel) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    Task task(test::randomModel(generator, {}), test::wideLimits(2, 1.0), seed);
    ASSERT_TRUE(task.plan());
    const double held = task.residuals(task.previous.replicate(1, kHorizon)).squaredNorm();
    EXPECT_LT(task.planner.cost(), held);
  }
}

TEST(InputLimitedIlqr, NotANumberIsReportedAndForgotten) {
  std::mt19937_64 generator(1);
  Task task(test::randomModel(generator, {}), test::wideLimits(2, 1.0), 1);
  ASSERT_TRUE(task.plan());
  const Matrix first = task.planner.inputs();
  const double good = task.offset[0];
  task.offset[0] = std::nan("");
  EXPECT_FALSE(task.plan());
  task.offset[0] = good;
  ASSERT_TRUE(task.plan());
  EXPECT_EQ(task.planner.inputs(), first);
}

}  // namespace control_fmbpc_input_limited_ilqr_test
}  // namespace fpc
