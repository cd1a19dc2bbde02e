// Setpoints that follow what is measured: the affine law on paper, its lag, and who stands over it.
#include "fmbpc/control/setpoint_plan.hpp"

#include <cmath>

#include "control/session_fixture.hpp"

namespace fpc::test_session {
namespace {

/// s follows the load x q_i / 2.6e6, gain 4.
SetpointPlanTerm load(double lag_h = 0.0) { return {0, {1}, {0}, 2.6e6, 4.0, lag_h}; }

SetpointParams planned(std::vector<SetpointPlanTerm> plan) {
  SetpointParams p = setpoints();
  p.plan = std::move(plan);
  return p;
}

SetpointSource sourceOf(std::vector<SetpointPlanTerm> plan) {
  return {planned(std::move(plan)), {"s", "x"}, SampleClock(720.0, 1234.5)};
}

TEST(SetpointPlan, AddsGainTimesTheRelativeProduct) {
  SetpointPlan plan({load(), {1, {0}, {}, 50.0, -100.0, 0.0}}, 2, 0.2);
  const Vector& sum = plan.follow(of({60.0, 2000.0}), of({1950.0}), 0);
  EXPECT_NEAR(sum[0], 4.0 * (2000.0 * 1950.0 / 2.6e6 - 1.0), 1e-12);
  EXPECT_NEAR(sum[1], -100.0 * 0.2, 1e-12);
}

TEST(SetpointPlan, AStepPassesItsLagAsAnExponential) {
  SetpointPlan plan({load(3.0)}, 2, 0.2);
  EXPECT_EQ(plan.follow(of({55.0, 2000.0}), of({1300.0}), 0)[0], 0.0) << "rests at its first value";
  for (std::uint32_t k = 1; k <= 15; ++k) plan.follow(of({55.0, 2000.0}), of({2600.0}), k);
  const double value = plan.follow(of({55.0, 2000.0}), of({2600.0}), 16)[0];
  EXPECT_NEAR(value, 4.0 * (1.0 - std::exp(-16 * 0.2 / 3.0)), 1e-12);
  SetpointPlan gap({load(3.0)}, 2, 0.2);  // the same in one step over missing samples
  gap.follow(of({55.0, 2000.0}), of({1300.0}), 0);
  EXPECT_NEAR(gap.follow(of({55.0, 2000.0}), of({2600.0}), 16)[0], value, 1e-12);
}

TEST(SetpointPlan, WhatIsNotFiniteLeavesItAsItWas) {
  SetpointPlan plan({load()}, 2, 0.2);
  const double before = plan.follow(of({55.0, 2000.0}), of({2600.0}), 0)[0];
  EXPECT_NEAR(before, 4.0, 1e-12);
  EXPECT_EQ(plan.follow(of({55.0, 2000.0}), of({kNaN}), 1)[0], before);
}

TEST(SetpointPlan, APersonStandsOverItAndLimitsHold) {
  SetpointParams params = planned({load()});
  params.upper = of({57.0, 5000.0});
  SetpointSource source(params, {"s", "x"}, SampleClock(720.0, 1234.5));
  source.follow(of({55.0, 2000.0}), of({1300.0}), 0);
  EXPECT_EQ(source.advance(0)[0], 55.0);
  source.follow(of({55.0, 2000.0}), of({1950.0}), 1);
  EXPECT_NEAR(source.advance(1)[0], 57.0, 1e-12) << "55 + 2";
  source.follow(of({55.0, 2000.0}), of({2600.0}), 2);
  EXPECT_EQ(source.advance(2)[0], 57.0) << "the upper limit";
  source.command({0, {"s"}, {52.0}, CommandMode::kOverride});
  source.follow(of({55.0, 2000.0}), of({1950.0}), 3);
  EXPECT_EQ(source.advance(3)[0], 52.0);
  source.command({0, {"s"}, {}, CommandMode::kRelease});
  source.follow(of({55.0, 2000.0}), of({1950.0}), 4);
  EXPECT_NEAR(source.advance(4)[0], 57.0, 1e-12);
}

TEST(SetpointPlan, TheSessionFollowsBeforeTheLaw) {
  auto owned = std::make_unique<FakeLaw>();
  FakeLaw* law = owned.get();
  law->needs_model = false;
  ControllerSession session(std::move(owned), planned({load()}), limits(), of({570.0}), plant());
  session.receive(sample(0));
  const double asked = 55.0 + 4.0 * (1990.0 * 1300.0 / 2.6e6 - 1.0);
  EXPECT_NEAR(law->seen_setpoint[0], asked, 1e-12);
  EXPECT_NEAR(session.answer().tracking.setpoint[0], asked, 1e-12);
}

TEST(SetpointPlan, MistakesAreNamed) {
  const auto words = [](SetpointPlanTerm term) -> std::string {
    try {
      sourceOf({term});
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing thrown";
  };
  EXPECT_NE(words({0, {1}, {}, 0.0, 1.0, 0.0}).find("setpoint.plan[0].about"), std::string::npos);
  EXPECT_NE(words({0, {}, {}, 1.0, 1.0, 0.0}).find("setpoint.plan[0].of"), std::string::npos);
  EXPECT_NE(words({2, {1}, {}, 1.0, 1.0, 0.0}).find("output"), std::string::npos);
  EXPECT_NE(words({0, {1}, {}, 1.0, kNaN, 0.0}).find("gain"), std::string::npos);
  EXPECT_NE(words({0, {1}, {}, 1.0, 1.0, -1.0}).find("lag_h"), std::string::npos);
}

}  // namespace
}  // namespace fpc::test_session
