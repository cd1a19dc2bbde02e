#include "plant/actuator.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace plant_actuator_test {

Vector one(double value) { return Vector::Constant(1, value); }

ActuatorParams params(double move = kInfinity, int hold_samples = -1) {
  return {{one(0.0), one(1600.0), one(move)}, one(570.0), one(300.0), {}, hold_samples};
}

TEST(Actuator, StartsAtItsInitialInput) {
  const Actuator actuator(params());
  EXPECT_EQ(actuator.applied()[0], 570.0);
  EXPECT_EQ(actuator.clips(), 0U);
  EXPECT_FALSE(actuator.missing());
}

TEST(Actuator, AppliesWhatIsInsideItsLimits) {
  Actuator actuator(params(100.0));
  actuator.apply(one(600.0));
  EXPECT_EQ(actuator.applied()[0], 600.0);
  EXPECT_EQ(actuator.clips(), 0U);
}

TEST(Actuator, ClipsAndCountsWhatIsBeyondBoundsOrMove) {
  Actuator actuator(params(100.0));
  actuator.apply(one(900.0));
  EXPECT_EQ(actuator.applied()[0], 670.0);
  EXPECT_EQ(actuator.clips(), 1U);
  Actuator free(params());
  free.apply(one(1700.0));
  EXPECT_EQ(free.applied()[0], 1600.0);
  EXPECT_EQ(free.clips(), 1U);
  free.apply(one(-5.0));
  EXPECT_EQ(free.applied()[0], 0.0);
}

TEST(Actuator, RoundingIsClippedButNotCounted) {
  Actuator actuator(params());
  actuator.apply(one(1600.0 + 1e-7));
  EXPECT_EQ(actuator.applied()[0], 1600.0);
  EXPECT_EQ(actuator.clips(), 0U);
  actuator.apply(one(1600.0 + 1e-5));
  EXPECT_EQ(actuator.clips(), 1U);
}

TEST(Actuator, EachElementCounts) {
  ActuatorParams p{{Vector::Zero(3), Vector::Ones(3), Vector::Constant(3, kInfinity)},
                   Vector::Zero(3),
                   Vector::Zero(3),
                   {},
                   -1};
  Actuator actuator(p);
  actuator.apply(Eigen::Vector3d(2.0, 0.5, -1.0));
  EXPECT_EQ(actuator.clips(), 2U);
  EXPECT_EQ(actuator.applied(), Eigen::Vector3d(1.0, 0.5, 0.0));
}

TEST(Actuator, MissingOrUnusableActionsAreHeldForEver) {
  Actuator actuator(params());
  actuator.apply(one(700.0));
  actuator.miss();
  EXPECT_TRUE(actuator.missing());
  actuator.apply(one(kNaN));
  actuator.apply(one(kInfinity));
  actuator.apply(Vector::Zero(2));
  actuator.apply(Vector());
  EXPECT_EQ(actuator.applied()[0], 700.0);
  EXPECT_TRUE(actuator.missing());
  actuator.apply(one(800.0));
  EXPECT_FALSE(actuator.missing());
  EXPECT_EQ(actuator.applied()[0], 800.0);
}

TEST(Actuator, FallsBackAfterTheHoldInsideItsMoveLimit) {
  Actuator actuator(params(200.0, 2));
  actuator.apply(one(700.0));
  for (const double expected : {700.0, 700.0, 500.0, 300.0, 300.0}) {
    actuator.miss();
    EXPECT_EQ(actuator.applied()[0], expected);
    EXPECT_EQ(actuator.clips(), 0U);
  }
  actuator.apply(one(350.0));
  actuator.miss();
  EXPECT_EQ(actuator.applied()[0], 350.0) << "an action starts the hold anew";
}

TEST(Actuator, AFaultIsClampedAndMovesAreLimitedFromThere) {
  Actuator actuator(params(100.0));
  actuator.disturb(0, -50.0);
  EXPECT_EQ(actuator.applied()[0], 0.0);
  actuator.apply(one(570.0));
  EXPECT_EQ(actuator.applied()[0], 100.0);
  actuator.disturb(0, kInfinity);
  EXPECT_EQ(actuator.applied()[0], 1600.0);
  actuator.disturb(0, kNaN);
  EXPECT_EQ(actuator.applied()[0], 1600.0);
}

TEST(Actuator, HoldingReturnsToTheInputWithoutTheFault) {
  Actuator actuator(params());
  actuator.apply(one(700.0));
  for (int i = 0; i < 5; ++i) {
    actuator.miss();
    actuator.disturb(0, actuator.applied()[0] + 50.0);
    EXPECT_EQ(actuator.applied()[0], 750.0) << "an offset does not add up";
  }
  actuator.miss();
  EXPECT_EQ(actuator.applied()[0], 700.0);
}

TEST(Actuator, NeverLeavesItsLimitsWhateverArrives) {
  constexpr unsigned kSeed = 9;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 generator(kSeed);
  std::normal_distribution<double> wild(800.0, 2000.0);
  Actuator actuator(params(150.0, 3));
  for (int i = 0; i < 5000; ++i) {
    const double before = actuator.applied()[0];
    switch (generator() % 4) {
      case 0:
        actuator.miss();
        break;
      case 1:
        actuator.apply(one(i % 3 == 0 ? kNaN : -kInfinity));
        break;
      default:
        actuator.apply(one(wild(generator)));
    }
    const double now = actuator.applied()[0];
    ASSERT_TRUE(now >= 0.0 && now <= 1600.0) << now;
    ASSERT_LE(std::abs(now - before), 150.0 * (1.0 + 1e-12));
  }
}

TEST(Actuator, ResetForgetsEverything) {
  Actuator actuator(params(100.0, 1));
  actuator.apply(one(2000.0));
  actuator.miss();
  actuator.reset();
  EXPECT_EQ(actuator.applied()[0], 570.0);
  EXPECT_EQ(actuator.clips(), 0U);
  EXPECT_FALSE(actuator.missing());
}

TEST(Actuator, ValidateNamesEachBadField) {
  const auto errorOf = [](const std::function<void(ActuatorParams&)>& spoil) -> std::string {
    ActuatorParams p = params();
    spoil(p);
    try {
      Actuator{p};
    } catch (const InputError& e) {
      return e.what();
    }
    return "nothing was thrown";
  };
  using P = ActuatorParams;
  EXPECT_NE(errorOf([](P& p) { p.limits.upper[0] = kNaN; }).find("input_upper"), std::string::npos);
  EXPECT_NE(errorOf([](P& p) { p.initial[0] = 1601.0; }).find("initial"), std::string::npos);
  EXPECT_NE(errorOf([](P& p) { p.fallback[0] = kNaN; }).find("fallback"), std::string::npos);
  EXPECT_NE(errorOf([](P& p) { p.fallback.resize(2); }).find("fallback"), std::string::npos);
  EXPECT_NE(errorOf([](P& p) { p.hold_samples = -2; }).find("hold_samples"), std::string::npos);
}

}  // namespace plant_actuator_test
}  // namespace fpc
