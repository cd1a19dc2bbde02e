// What the optimizer sends after another hand had the inputs, and inside what a guard leaves.
#include <gtest/gtest.h>

#include "runtime/optimizer_fixture.hpp"

namespace fpc {
namespace control_optimizer_limits_test {

using namespace optimizer_test;

TEST(OptimizerSession, TheFirstActionAfterAnotherHandIsTheAppliedInput) {
  OptimizerSession session = make();
  std::uint32_t step = 0;
  for (const ActionSource source : {ActionSource::kManual, ActionSource::kFallback}) {
    ASSERT_TRUE(session.receive(base(header(step), 584.0, source)));
    double applied = 584.0, before = 1016.0;
    for (int i = 0; i < 3; ++i) {  // what the optimizer asks for is the bound, 1600
      PredictiveAction p = prediction(header(++step), 2000.0);
      p.input_previous[0] = applied;
      session.receive(base(header(step), 1600.0, ActionSource::kClipped));
      ASSERT_TRUE(session.receive(p));
      const double left = 1600.0 - session.action().input[0];
      EXPECT_NEAR(left, i == 0 ? 1016.0 : kTransferDecay * before, 1e-6) << i;
      EXPECT_NEAR(session.report().perturbation[0], session.action().input[0] - 2804.0, 1e-6);
      applied = session.action().input[0];
      before = left;
    }
    ++step;
  }
}

// One sample that was held is no hand-over, nor is the one after it.
TEST(OptimizerSession, WhatWasHeldOfOursGoesOn) {
  OptimizerSession session = make();
  session.receive(base(header(0), 1600.0, ActionSource::kClipped));
  ASSERT_TRUE(session.receive(prediction(header(0), 2000.0)));
  const double sent = session.action().input[0] - 1e-7;  // within 1e-9 of the range
  ASSERT_TRUE(session.receive(base(header(1), sent, ActionSource::kHeld)));
  session.receive(base(header(2)));
  ASSERT_TRUE(session.receive(prediction(header(2))));
  EXPECT_NEAR(session.action().input[0], 804.0, 1e-6);
  ASSERT_TRUE(session.receive(base(header(3), 300.0, ActionSource::kHeld)));  // the plant's own
  PredictiveAction p = prediction(header(4));
  p.input_previous[0] = 300.0;
  session.receive(base(header(4)));
  ASSERT_TRUE(session.receive(p));
  EXPECT_NEAR(session.action().input[0], 300.0, 1e-9);
}

TEST(OptimizerSession, WhatTheGuardLeavesHoldsForTheOptimizerAsWell) {
  OptimizerSession session = make();
  PredictiveAction p = prediction(header(0), 2000.0);
  p.input_lower = Vector::Constant(1, 400.0);
  p.input_upper = Vector::Constant(1, 700.0);
  session.receive(base(header(0), 700.0, ActionSource::kGuarded));
  ASSERT_TRUE(session.receive(p));
  EXPECT_EQ(session.report().status, SolveStatus::kSolved);
  EXPECT_NEAR(session.action().input[0], 700.0, 1e-6);
  EXPECT_LE(session.action().input[0], 700.0);
  EXPECT_EQ(session.action().source, ActionSource::kGuarded);
  EXPECT_GT(session.report().active_rows, 0U);
}

}  // namespace control_optimizer_limits_test
}  // namespace fpc
