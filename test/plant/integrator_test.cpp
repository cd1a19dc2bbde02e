#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "plant/integrator_fixture.hpp"

namespace fpc {
namespace plant_integrator_test {

using namespace integrator_fixture;

class EveryMethod : public ::testing::TestWithParam<IntegrationMethod> {};

// dx/dt = u + d - x per hour: after one hour x = 3 (1 - e^-1) + x0 e^-1.
TEST_P(EveryMethod, FirstOrderLagHasItsExponential) {
  const TestPlant plant(1, 3600.0, firstOrder);
  Integrator cvode(plant, with(GetParam()));
  Vector x = Vector::Constant(1, 5.0);
  const IntegrationResult result =
      cvode.advance(x, Vector::Constant(1, 1.0), Vector::Constant(1, 2.0), 3600.0);
  ASSERT_TRUE(result.ok()) << result.reason;
  EXPECT_GT(result.steps, 0);
  EXPECT_TRUE(result.reason.empty());
  EXPECT_NEAR(x[0], 3.0 * (1.0 - std::exp(-1.0)) + 5.0 * std::exp(-1.0), 1e-6);
}

TEST_P(EveryMethod, TheSameArgumentsGiveTheSameBitsWhateverCameBefore) {
  const auto plant = makePlant("activated_sludge");
  Vector start(6), other(6);
  start << 200.0, 2000.0, 2.0, 80.0, 600.0, 6000.0;
  other << 20.0, 3000.0, 1.0, 800.0, 900.0, 9000.0;
  const Vector u = Vector::Constant(1, 570.0), d = Eigen::Vector2d(1300.0, 366.67);
  Integrator fresh(*plant, with(GetParam())), used(*plant, with(GetParam()));
  Vector a = start, b = start, between = other;
  ASSERT_TRUE(fresh.advance(a, u, d, 720.0).ok());
  ASSERT_TRUE(used.advance(between, 3.0 * u, 2.0 * d, 36000.0).ok());
  ASSERT_TRUE(used.advance(between, 3.0 * u, 2.0 * d, 7.2).ok());
  ASSERT_TRUE(used.advance(b, u, d, 720.0).ok());
  EXPECT_EQ(a, b);
}

TEST_P(EveryMethod, DefaultTolerancesAgreeWithATightReference) {
  const auto plant = makePlant("activated_sludge");
  Vector loose(6);
  loose << 200.0, 2000.0, 2.0, 80.0, 600.0, 6000.0;
  Vector tight = loose;
  Integrator cvode(*plant, with(GetParam())), reference(*plant, with(kBdf, 1e-12));
  for (int k = 0; k < 830; ++k) {
    const Vector u = Vector::Constant(1, 800.0 + 600.0 * std::sin(0.1 * k));
    const Vector d = Eigen::Vector2d(1300.0 + 500.0 * std::sin(0.05 * k), 366.67);
    ASSERT_TRUE(cvode.advance(loose, u, d, 720.0).ok());
    ASSERT_TRUE(reference.advance(tight, u, d, 720.0).ok());
    ASSERT_LT((loose - tight).norm(), 1e-6 * tight.norm()) << "sample " << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Integrator, EveryMethod, ::testing::Values(kBdf, kAdams, kRungeKutta),
                         [](const auto& instance) { return wordOf(instance.param); });

/// Fourth-order Runge-Kutta with many steps: another method, another author.
Vector rungeKutta(const Plant& plant, Vector x, const Vector& u, const Vector& d, double hours) {
  constexpr int kSteps = 20000;
  const double h = hours / kSteps;
  Vector k1(x.size()), k2(x.size()), k3(x.size()), k4(x.size());
  for (int i = 0; i < kSteps; ++i) {
    plant.derivatives(x, u, d, k1);
    plant.derivatives(x + 0.5 * h * k1, u, d, k2);
    plant.derivatives(x + 0.5 * h * k2, u, d, k3);
    plant.derivatives(x + h * k3, u, d, k4);
    x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return x;
}

TEST(Integrator, AgreesWithRungeKutta) {
  const auto plant = makePlant("activated_sludge");
  Vector x(6);
  x << 200.0, 2000.0, 2.0, 80.0, 600.0, 6000.0;
  const Vector u = Vector::Constant(1, 1100.0), d = Eigen::Vector2d(1900.0, 500.0);
  const Vector expected = rungeKutta(*plant, x, u, d, 20.0);
  Integrator cvode(*plant, {});
  for (int k = 0; k < 100; ++k) ASSERT_TRUE(cvode.advance(x, u, d, 720.0).ok());
  EXPECT_LT((x - expected).norm(), 1e-6 * expected.norm());
}

// Robertson's problem (1966), rates 0.04, 1e4, 3e7: too stiff for explicit methods; values at t =
// 40 from the documentation of CVODE (hindmarsh2005).
TEST(Integrator, BdfSolvesRobertsonsStiffProblem) {
  const TestPlant plant(3, 1.0, [](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) {
    dxdt[0] = -0.04 * x[0] + 1e4 * x[1] * x[2];
    dxdt[2] = 3e7 * x[1] * x[1];
    dxdt[1] = -dxdt[0] - dxdt[2];
  });
  Integrator cvode(plant, with(kBdf, 1e-10));
  Vector x(3);
  x << 1.0, 0.0, 0.0;
  ASSERT_TRUE(cvode.advance(x, kZero, kZero, 40.0).ok());
  EXPECT_NEAR(x[0], 7.1583e-1, 1e-4);
  EXPECT_NEAR(x[1], 9.1850e-6, 1e-9);
  EXPECT_NEAR(x[2], 2.8416e-1, 1e-4);
}

/// The status of a sample that fails with these words, in silence and without a move.
IntegrationStatus failureOf(const TestPlant& plant, const IntegratorParams& params,
                            const std::string& words) {
  Integrator cvode(plant, params);
  Vector x = Vector::Constant(1, 1.0);
  ::testing::internal::CaptureStderr();
  const IntegrationResult result = cvode.advance(x, kZero, kZero, 10.0);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_NE(result.reason.find(words), std::string::npos) << result.reason;
  EXPECT_EQ(x[0], 1.0);
  return result.status;
}

void expectFailure(const TestPlant& plant, const IntegratorParams& params, IntegrationStatus status,
                   const std::string& words) {
  EXPECT_EQ(failureOf(plant, params, words), status);
}

TEST_P(EveryMethod, ModelExceptionBecomesStatus) {
  const TestPlant plant(1, 1.0, [](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) {
    if (x[0] > 2.0) throw std::runtime_error("the tank runs over");
    dxdt[0] = 1.0;
  });
  const IntegrationStatus status = failureOf(plant, with(GetParam()), "the tank runs over");
  // Before SUNDIALS 7 the iteration of adams goes on with shorter steps until it has had enough.
  if (GetParam() == kAdams && status == IntegrationStatus::kTooMuchWork) return;
  EXPECT_EQ(status, IntegrationStatus::kModelFailed);
}

TEST_P(EveryMethod, ExceptionsOfAnyTypeStayInside) {
  const TestPlant plant(1, 1.0,
                        [](VectorRef, VectorRef, VectorRef, Eigen::Ref<Vector>) { throw 7; });
  expectFailure(plant, with(GetParam()), IntegrationStatus::kModelFailed, "unknown exception");
}

TEST_P(EveryMethod, DerivativesThatAreNeverFiniteBecomeStatus) {
  const TestPlant plant(1, 1.0, [](VectorRef, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) {
    dxdt[0] = std::numeric_limits<double>::quiet_NaN();
  });
  expectFailure(plant, with(GetParam()), IntegrationStatus::kModelFailed, "not finite");
}

TEST_P(EveryMethod, TooManyStepsBecomeStatus) {
  const TestPlant plant(1, 1.0, [](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) {
    dxdt[0] = -1e3 * (x[0] - std::cos(x[0] * 1e3));
  });
  IntegratorParams params = with(GetParam());
  params.max_steps = 5;
  expectFailure(plant, params, IntegrationStatus::kTooMuchWork, "max_steps");
}

// dx/dt = x^2, x(0) = 1 is infinite at t = 1.
TEST_P(EveryMethod, AnEscapeInFiniteTimeBecomesStatus) {
  const TestPlant plant(1, 1.0, [](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) {
    dxdt[0] = x[0] * x[0];
  });
  Integrator cvode(plant, with(GetParam()));
  Vector x = Vector::Constant(1, 1.0);
  const IntegrationResult result = cvode.advance(x, kZero, kZero, 2.0);
  EXPECT_FALSE(result.ok());
  EXPECT_FALSE(result.reason.empty());
  EXPECT_EQ(x[0], 1.0);
}

TEST_P(EveryMethod, WorksAgainAfterAFailure) {
  bool fail = true;
  const TestPlant plant(1, 1.0,
                        [&](VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) {
                          if (fail) throw std::runtime_error("once");
                          firstOrder(x, u, d, dxdt);
                        });
  Integrator cvode(plant, with(GetParam()));
  Vector x = Vector::Constant(1, 1.0);
  ASSERT_FALSE(cvode.advance(x, kZero, kZero, 1.0).ok());
  fail = false;
  ASSERT_TRUE(cvode.advance(x, kZero, kZero, 1.0).ok());
  EXPECT_NEAR(x[0], std::exp(-1.0), 1e-6);
}

TEST_P(EveryMethod, NotANumberIsRefusedBeforeItReachesThePlant) {
  const TestPlant plant(1, 1.0, firstOrder);
  Integrator cvode(plant, with(GetParam()));
  Vector x = Vector::Constant(1, 1.0);
  const Vector nan = Vector::Constant(1, std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(cvode.advance(x, nan, kZero, 1.0).status, IntegrationStatus::kModelFailed);
  EXPECT_EQ(cvode.advance(x, kZero, nan, 1.0).status, IntegrationStatus::kModelFailed);
  EXPECT_EQ(x[0], 1.0);
}

TEST_P(EveryMethod, NoTimeIsNoMove) {
  const TestPlant plant(1, 1.0, firstOrder);
  Integrator cvode(plant, with(GetParam()));
  Vector x = Vector::Constant(1, 1.0);
  EXPECT_TRUE(cvode.advance(x, kZero, kZero, 0.0).ok());
  EXPECT_EQ(x[0], 1.0);
  EXPECT_THROW(cvode.advance(x, kZero, kZero, -1.0), InputError);
  EXPECT_THROW(cvode.advance(x, Vector::Zero(2), kZero, 1.0), InputError);
}

TEST_P(EveryMethod, MovingItKeepsItWorking) {
  const TestPlant plant(1, 1.0, firstOrder);
  Integrator first(plant, with(GetParam()));
  Integrator second(std::move(first));
  Vector x = Vector::Constant(1, 1.0);
  EXPECT_TRUE(second.advance(x, kZero, kZero, 1.0).ok());
}

TEST(Integrator, ValidateNamesEachBadField) {
  const auto errorOf = [](const std::function<void(IntegratorParams&)>& spoil) -> std::string {
    IntegratorParams params;
    spoil(params);
    try {
      params.validate();
    } catch (const InputError& e) {
      return e.what();
    }
    return "nothing was thrown";
  };
  using P = IntegratorParams;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(errorOf([](P& p) { p.relative_tolerance = 0.0; }).find("relative_tolerance"),
            std::string::npos);
  EXPECT_NE(errorOf([&](P& p) { p.absolute_tolerance = nan; }).find("absolute_tolerance"),
            std::string::npos);
  EXPECT_NE(errorOf([](P& p) { p.max_steps = 0; }).find("max_steps"), std::string::npos);
}

}  // namespace plant_integrator_test
}  // namespace fpc
