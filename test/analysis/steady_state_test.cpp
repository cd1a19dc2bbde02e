#include "analysis/steady_state.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace analysis_steady_state_test {

const Vector kNone;

Vector one(double value) { return Vector::Constant(1, value); }

TEST(SteadyState, OfALinearSystemIsFoundAtOnce) {
  constexpr unsigned kSeed = 4;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 generator(kSeed);
  std::uniform_real_distribution<double> entry(-1.0, 1.0);
  const Matrix A =
      Matrix::NullaryExpr(5, 5, [&] { return entry(generator); }) - 4.0 * Matrix::Identity(5, 5);
  const Vector answer = Vector::NullaryExpr(5, [&] { return entry(generator); });
  const auto f = [&](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) {
    dxdt = A * (x - answer);
  };
  const SteadyState rest = findSteadyState(f, Vector::Ones(5), kNone, kNone);
  ASSERT_TRUE(rest.ok());
  EXPECT_LT((rest.x - answer).norm(), 1e-12);
  EXPECT_LE(rest.iterations, 3);
}

// A tank: dh/dt = u - sqrt(h) d, so h = (u/d)^2.
TEST(SteadyState, FollowsInputAndDisturbance) {
  const auto f = [](VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) {
    dxdt[0] = u[0] - std::sqrt(x[0]) * d[0];
  };
  const SteadyState rest = findSteadyState(f, one(1.0), one(3.0), one(2.0));
  ASSERT_TRUE(rest.ok());
  EXPECT_NEAR(rest.x[0], 2.25, 1e-9);
  EXPECT_LT(rest.residual, 1e-9);
}

// Newton on atan diverges from |x| > 1.392; damping makes it converge.
TEST(SteadyState, DampingBringsFarStartsHome) {
  const auto f = [](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) {
    dxdt[0] = -std::atan(x[0] - 7.0);
  };
  for (const double start : {-100.0, 3.0, 12.0, 500.0}) {
    const SteadyState rest = findSteadyState(f, one(start), kNone, kNone);
    ASSERT_TRUE(rest.ok()) << "start " << start;
    EXPECT_NEAR(rest.x[0], 7.0, 1e-8) << "start " << start;
  }
}

TEST(SteadyState, DoesNotDependOnTheUnitsOfTheEquations) {
  for (const double unit : {1e-12, 1.0, 1e12}) {
    const auto f = [unit](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) {
      dxdt[0] = unit * (x[0] * x[1] - 6.0);
      dxdt[1] = x[0] + x[1] - 5.0;
    };
    const SteadyState rest = findSteadyState(f, Eigen::Vector2d(1.0, 5.0), kNone, kNone);
    ASSERT_TRUE(rest.ok()) << "unit " << unit;
    EXPECT_NEAR(rest.x[0], 2.0, 1e-9) << "unit " << unit;
    EXPECT_NEAR(rest.x[1], 3.0, 1e-9) << "unit " << unit;
  }
}

TEST(SteadyState, UnstableStatesAreFoundToo) {
  const auto f = [](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) {
    dxdt[0] = x[0] * (x[0] - 1.0) * (3.0 - x[0]);  // rests at 0, 1 and 3; 1 is unstable
  };
  const SteadyState rest = findSteadyState(f, one(0.9), kNone, kNone);
  ASSERT_TRUE(rest.ok());
  EXPECT_NEAR(rest.x[0], 1.0, 1e-10);
}

TEST(SteadyState, AWholeLineOfRestsIsSingular) {
  const auto f = [](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) {
    dxdt[0] = x[0] - x[1];
    dxdt[1] = 2.0 * (x[1] - x[0]);
  };
  EXPECT_EQ(findSteadyState(f, Eigen::Vector2d(1.0, 2.0), kNone, kNone).status,
            SteadyStateStatus::kSingular);
}

TEST(SteadyState, AnIntegratorHasNoIsolatedRest) {
  const auto f = [](VectorRef, VectorRef u, VectorRef, Eigen::Ref<Vector> dxdt) { dxdt = u; };
  EXPECT_EQ(findSteadyState(f, one(1.0), one(1.0), kNone).status, SteadyStateStatus::kSingular);
}

TEST(SteadyState, NoRestAtAllIsAStatus) {
  const auto f = [](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) {
    dxdt[0] = 1.0 + x[0] * x[0];
  };
  const SteadyState rest = findSteadyState(f, one(2.0), kNone, kNone);
  EXPECT_FALSE(rest.ok());
  EXPECT_GE(rest.residual, 1.0);
}

TEST(SteadyState, AModelThatFailsIsAStatus) {
  const auto throws = [](VectorRef, VectorRef, VectorRef, Eigen::Ref<Vector>) {
    throw std::runtime_error("no");
  };
  const auto nan = [](VectorRef, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) {
    dxdt[0] = std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_EQ(findSteadyState(throws, one(1.0), kNone, kNone).status,
            SteadyStateStatus::kModelFailed);
  EXPECT_EQ(findSteadyState(nan, one(1.0), kNone, kNone).status, SteadyStateStatus::kModelFailed);
}

// sqrt is not a number below 0: Newton from 100 lands at -100 first and must be shortened.
TEST(SteadyState, StepsOutOfTheModelsRangeAreShortened) {
  const auto f = [](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) {
    dxdt[0] = 0.1 - std::sqrt(x[0]);
  };
  const SteadyState rest = findSteadyState(f, one(100.0), kNone, kNone);
  ASSERT_TRUE(rest.ok());
  EXPECT_NEAR(rest.x[0], 0.01, 1e-9);
}

TEST(SteadyState, TheIterationLimitIsAStatus) {
  SteadyStateParams params;
  params.max_iterations = 1;
  const auto f = [](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) {
    dxdt[0] = std::exp(x[0]) - 1.0;
  };
  EXPECT_EQ(findSteadyState(f, one(3.0), kNone, kNone, params).status,
            SteadyStateStatus::kIterationLimit);
}

TEST(SteadyState, BadArgumentsAreErrors) {
  const auto f = [](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) { dxdt = x; };
  EXPECT_THROW(findSteadyState(f, kNone, kNone, kNone), InputError);
  EXPECT_THROW(findSteadyState(f, one(NAN), kNone, kNone), InputError);
  for (const auto& params : {SteadyStateParams{0.0, 1e-3, 10}, SteadyStateParams{1e-9, 0.0, 10},
                             SteadyStateParams{1e-9, 1e-3, 0}})
    EXPECT_THROW(findSteadyState(f, one(1.0), kNone, kNone, params), InputError);
}

}  // namespace analysis_steady_state_test
}  // namespace fpc
