#include "optim/gauss_newton.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace optim_gauss_newton_test {

Vector two(double a, double b) { return (Vector(2) << a, b).finished(); }

LinearLimits box(const Vector& lower, const Vector& upper) {
  return {lower, upper, Matrix::Zero(0, lower.size()), Vector(0), Vector(0)};
}

GaussNewtonSettings patient() {
  GaussNewtonSettings settings;
  settings.max_iterations = 300;
  return settings;
}

/// |r|^2 is Rosenbrock's function.
bool valley(VectorRef x, Eigen::Ref<Vector> r) {
  r[0] = 10.0 * (x[1] - x[0] * x[0]);
  r[1] = 1.0 - x[0];
  return true;
}

TEST(GaussNewton, FindsTheEndOfRosenbrocksValley) {
  GaussNewton solver(2, 2, 0, patient());
  const auto& found = solver.solve(valley, two(-1.2, 1.0), box(two(-5, -5), two(5, 5)));
  EXPECT_EQ(found.status, SolveStatus::kSolved);
  EXPECT_NEAR(found.x[0], 1.0, 1e-8);
  EXPECT_NEAR(found.x[1], 1.0, 1e-8);
}

// With x1 <= 1/2 the least is at x1 = 1/2, x2 = 1/4, cost 1/4.
TEST(GaussNewton, StopsAtABoundWhereTheCostStillFalls) {
  GaussNewton solver(2, 2, 0);
  const auto& found = solver.solve(valley, two(-1.2, 1.0), box(two(-5, -5), two(0.5, 5)));
  EXPECT_EQ(found.status, SolveStatus::kSolved);
  EXPECT_EQ(found.x[0], 0.5);
  EXPECT_NEAR(found.x[1], 0.25, 1e-8);
  EXPECT_NEAR(found.cost, 0.25, 1e-12);
}

// x1^2 + x2^2 = 2 within x2 - x1 >= 1: the point of the circle of least radius on the line.
TEST(GaussNewton, KeepsLinearRows) {
  const Residuals distance = [](VectorRef x, Eigen::Ref<Vector> r) {
    r = x;
    return true;
  };
  LinearLimits limits = box(two(-9, -9), two(9, 9));
  limits.A = (Matrix(1, 2) << -1.0, 1.0).finished();
  limits.a_lower = Vector::Constant(1, 1.0);
  limits.a_upper = Vector::Constant(1, kInfinity);
  GaussNewton solver(2, 2, 1);
  const auto& found = solver.solve(distance, two(-3.0, 4.0), limits);
  EXPECT_EQ(found.status, SolveStatus::kSolved);
  EXPECT_NEAR(found.x[0], -0.5, 1e-9);
  EXPECT_NEAR(found.x[1], 0.5, 1e-9);
}

TEST(GaussNewton, LinearResidualsGiveTheQuadraticProgrammesAnswer) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> draw;
    const Matrix J = Matrix::NullaryExpr(6, 3, [&] { return draw(generator); });
    const Vector c = Vector::NullaryExpr(6, [&] { return draw(generator); });
    const LinearLimits limits = box(Vector::Constant(3, -0.3), Vector::Constant(3, 0.3));
    QpProblem qp(3, 0);
    qp.H = J.transpose() * J;
    qp.g = J.transpose() * c;
    qp.x_lower = limits.x_lower;
    qp.x_upper = limits.x_upper;
    QpSolver reference(3, 0);
    const Vector expected = reference.solve(qp).x;
    GaussNewton solver(3, 6, 0);
    const auto& found = solver.solve(
        [&](VectorRef x, Eigen::Ref<Vector> r) {
          r = J * x + c;
          return true;
        },
        Vector::Zero(3), limits);
    EXPECT_EQ(found.status, SolveStatus::kSolved);
    EXPECT_LE((found.x - expected).lpNorm<Eigen::Infinity>(), 1e-7);
  }
}

TEST(GaussNewton, ReachedIterationsLeaveAPointThatIsNoWorseThanTheStart) {
  GaussNewtonSettings settings;
  settings.max_iterations = 2;
  GaussNewton solver(2, 2, 0, settings);
  const auto& found = solver.solve(valley, two(-1.2, 1.0), box(two(-5, -5), two(5, 5)));
  EXPECT_EQ(found.status, SolveStatus::kIterationLimit);
  EXPECT_TRUE(found.usable());
  EXPECT_LE(found.cost, 24.2);
  EXPECT_GT(found.cost, 1e-6);
}

TEST(GaussNewton, AFunctionThatIsNotDefinedIsAStatusAtTheStartAndAWallLater) {
  const Residuals logarithm = [](VectorRef x, Eigen::Ref<Vector> r) {
    r[0] = std::log(x[0]) + 3.0;
    return std::isfinite(r[0]);
  };
  GaussNewton solver(1, 1, 0, patient());
  const LinearLimits limits = box(Vector::Constant(1, -9.0), Vector::Constant(1, 9.0));
  EXPECT_EQ(solver.solve(logarithm, Vector::Constant(1, -1.0), limits).status,
            SolveStatus::kInvalidProblem);
  EXPECT_FALSE(solver.solve(logarithm, Vector::Constant(1, std::nan("")), limits).usable());
  const auto& found = solver.solve(logarithm, Vector::Constant(1, 8.0), limits);
  EXPECT_TRUE(found.usable());  // the full step goes below 0
  EXPECT_NEAR(found.x[0], std::exp(-3.0), 1e-9);
}

TEST(GaussNewton, TheAnswerDoesNotDependOnWhatWasSolvedBefore) {
  GaussNewton fresh(2, 2, 0), used(2, 2, 0);
  used.solve(valley, two(4.0, -4.0), box(two(-5, -5), two(0.3, 5)));
  const LinearLimits limits = box(two(-5, -5), two(5, 5));
  const Vector expected = fresh.solve(valley, two(-1.2, 1.0), limits).x;
  const Vector found = used.solve(valley, two(-1.2, 1.0), limits).x;
  EXPECT_EQ(found[0], expected[0]);
  EXPECT_EQ(found[1], expected[1]);
}

TEST(GaussNewton, SettingsAreCheckedByName) {
  const auto refuses = [](const GaussNewtonSettings& settings, const std::string& field) {
    try {
      settings.validate();
      FAIL() << field;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(field), std::string::npos);
    }
  };
  GaussNewtonSettings a, b, c;
  a.max_iterations = 0;
  b.tolerance = 0.0;
  c.difference = std::nan("");
  refuses(a, "max_iterations");
  refuses(b, "tolerance");
  refuses(c, "difference");
}

}  // namespace optim_gauss_newton_test
}  // namespace fpc
