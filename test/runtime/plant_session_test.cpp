#include "runtime/plant_session.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "runtime/factory.hpp"
#include "runtime/loop_fixture.hpp"

namespace fpc {
namespace loop_plant_session_test {

/// A plant of 5 samples with an input inside [0, 1600].
PlantSession session(Pace pace, const Overrides& more = {}) {
  Overrides overrides{{"sampling.duration_h", "1"}};
  overrides.insert(overrides.end(), more.begin(), more.end());
  PlantPolicy policy;
  policy.pace = pace;
  policy.period_s = 0.2;
  policy.action_timeout_s = 5.0;
  PlantSession plant(makeSimulation(readLoop("asp_case1_pi_x", overrides)), policy);
  plant.begin(7);
  return plant;
}

ControlAction action(std::uint32_t step, double input = 600.0, std::uint64_t run = 7) {
  ControlAction a;
  a.header.run_id = run;
  a.header.step = step;
  a.input = Vector::Constant(1, input);
  a.source = ActionSource::kBase;
  return a;
}

std::uint32_t stepOf(const PlantSession& plant) {
  return plant.process().measurement().header.step;
}

TEST(PlantSession, HoldsSampleZeroUntilItStarts) {
  PlantSession plant = session(Pace::kLockstep);
  EXPECT_FALSE(plant.receive(action(0)));
  EXPECT_FALSE(plant.advance(0.0));
  EXPECT_FALSE(plant.mustResend(100.0));
  plant.start(1.0);
  EXPECT_TRUE(plant.receive(action(0)));
  EXPECT_TRUE(plant.advance(1.0));
  EXPECT_EQ(stepOf(plant), 1U);
}

TEST(PlantSession, CountsEveryActionThatItDoesNotTakeApart) {
  PlantSession plant = session(Pace::kLockstep);
  plant.start(0.0);
  ControlAction wrong = action(0);
  wrong.input = Vector::Zero(2);
  EXPECT_FALSE(plant.receive(wrong));
  EXPECT_FALSE(plant.receive(action(0, std::numeric_limits<double>::quiet_NaN())));
  EXPECT_FALSE(plant.receive(action(3)));
  EXPECT_FALSE(plant.receive(action(0, 600.0, 1ULL << 63)));
  ASSERT_TRUE(plant.receive(action(0)));
  EXPECT_FALSE(plant.receive(action(0, 900.0)));  // the first valid answer wins
  plant.advance(0.0);
  EXPECT_EQ(plant.process().measurement().input_applied[0], 600.0);
  plant.receive(action(1));
  plant.advance(0.0);
  EXPECT_FALSE(plant.receive(action(0)));
  const ActionCounts& c = plant.counts();
  EXPECT_EQ(c.accepted, 2U);
  EXPECT_EQ(c.wrong_size, 1U);
  EXPECT_EQ(c.not_finite, 1U);
  EXPECT_EQ(c.later, 1U);
  EXPECT_EQ(c.other_run, 1U);
  EXPECT_EQ(c.repeated, 1U);
  EXPECT_EQ(c.old, 1U);
}

/// Looks every half second; when the plant has moved on.
double movesOn(PlantSession& plant, double from_s) {
  for (double now_s = from_s; now_s < from_s + 100.0; now_s += 0.5)
    if (plant.advance(now_s)) return now_s;
  return kInfinity;
}

PlantSession recordedSession(Pace pace) {
  PlantPolicy policy;
  policy.pace = pace;
  policy.record_timeout_s = 5.0;
  PlantSession plant(makeSimulation(readLoop("asp_case1_pi_x", {{"sampling.duration_h", "1"}})),
                     policy);
  plant.begin(7);
  plant.start(0.0);
  return plant;
}

TEST(PlantSession, WaitsForItsRecorderAtAnyPaceAndSendsAgain) {
  for (const Pace pace : {Pace::kLockstep, Pace::kPaced, Pace::kRealtime}) {
    PlantSession plant = recordedSession(pace);
    EXPECT_FALSE(plant.recorded({0, 7, 0}));  // not waited for yet
    ASSERT_TRUE(plant.receive(action(0)));
    EXPECT_TRUE(plant.advance(0.1));
    ASSERT_TRUE(plant.receive(action(1)));
    EXPECT_FALSE(plant.advance(0.2));
    EXPECT_TRUE(plant.mustResend(0.3));
    for (const StepHeader& other : {StepHeader{0, 7, 0}, {0, 7, 2}, {0, 8, 1}})
      EXPECT_FALSE(plant.recorded(other));
    EXPECT_FALSE(plant.advance(5.1));
    EXPECT_TRUE(plant.recorded({0, 7, 1}));
    EXPECT_TRUE(plant.advance(5.1));
    EXPECT_EQ(stepOf(plant), 2U);
  }
}

TEST(PlantSession, GoesOnWithoutARecorderThatStaysAwayUntilItIsBack) {
  PlantSession plant = recordedSession(Pace::kLockstep);
  ASSERT_TRUE(plant.receive(action(0)));
  EXPECT_FALSE(plant.advance(1.0));
  EXPECT_EQ(plant.unrecordedFor(3.0), 2.0);
  EXPECT_EQ(movesOn(plant, 1.5), 6.0);
  ASSERT_TRUE(plant.receive(action(1)));
  EXPECT_TRUE(plant.advance(6.1));
  ASSERT_TRUE(plant.receive(action(2)));
  EXPECT_FALSE(plant.recorded({0, 7, 2}));  // heard of again
  EXPECT_TRUE(plant.advance(6.2));
  ASSERT_TRUE(plant.receive(action(3)));
  EXPECT_FALSE(plant.advance(6.3));
}

TEST(PlantSession, ASampleWithoutAnActionWaitsForNoRecorder) {
  PlantSession plant = recordedSession(Pace::kPaced);
  EXPECT_EQ(movesOn(plant, 0.5), 5.0);
}

// A machine that stands still holds up whoever is waited for as well.
TEST(PlantSession, TimeInWhichThePlantItselfStoodStillIsNoSilenceOfOthers) {
  PlantSession controlled = session(Pace::kPaced);
  controlled.start(0.0);
  EXPECT_FALSE(controlled.advance(100.0));
  EXPECT_EQ(movesOn(controlled, 100.5), 104.5);

  PlantSession recorded = recordedSession(Pace::kPaced);
  ASSERT_TRUE(recorded.receive(action(0)));
  EXPECT_FALSE(recorded.advance(0.0));
  EXPECT_FALSE(recorded.advance(100.0));
  EXPECT_EQ(movesOn(recorded, 100.5), 104.5);
}

TEST(PlantSession, LockstepWaitsForEverAndSendsAgain) {
  PlantSession plant = session(Pace::kLockstep);
  plant.start(0.0);
  EXPECT_FALSE(plant.mustResend(0.04));
  EXPECT_TRUE(plant.mustResend(0.05));
  plant.resent(0.05);
  EXPECT_FALSE(plant.mustResend(0.09));
  EXPECT_FALSE(plant.advance(1e6));
  EXPECT_EQ(plant.unansweredFor(1e6), 1e6);
  EXPECT_EQ(plant.nextDue(), std::numeric_limits<double>::infinity());
}

TEST(PlantSession, PacedGoesOnWithoutAnActionAfterTheStatedTimeAndReturns) {
  PlantSession plant = session(Pace::kPaced);
  plant.start(0.0);
  EXPECT_EQ(plant.nextDue(), 0.5);
  EXPECT_EQ(movesOn(plant, 0.5), 5.0);
  EXPECT_TRUE(plant.starving());
  EXPECT_EQ(plant.missingInputs(), 1U);
  EXPECT_FALSE(plant.advance(5.1));
  EXPECT_TRUE(plant.advance(5.21));  // goes on at its period
  EXPECT_TRUE(plant.receive(action(2)));
  EXPECT_FALSE(plant.starving());
  EXPECT_TRUE(plant.advance(5.5));
  EXPECT_FALSE(plant.advance(9.0));  // waits again
  EXPECT_EQ(plant.missingInputs(), 2U);
}

TEST(PlantSession, WithoutActionsTheActuatorHoldsAndThenFallsBackInPacedAndRealtime) {
  for (const Pace pace : {Pace::kPaced, Pace::kRealtime}) {
    PlantSession plant =
        session(pace, {{"actuator.hold_samples", "2"}, {"actuator.fallback", "{q_r: 300}"}});
    plant.start(0.0);
    plant.receive(action(0, 900.0));
    double now = 0.2 + 1e-9;
    std::vector<double> applied;
    for (; plant.phase() == PlantPhase::kRunning; now += 5.0)
      if (plant.advance(now)) applied.push_back(plant.process().measurement().input_applied[0]);
    EXPECT_EQ(applied, (std::vector<double>{900, 900, 900, 300, 300}));
  }
}

TEST(PlantSession, RealtimeGoesOnAtItsPeriod) {
  PlantSession plant = session(Pace::kRealtime);
  plant.start(0.0);
  EXPECT_FALSE(plant.advance(0.19));
  EXPECT_TRUE(plant.advance(0.2));
  EXPECT_EQ(plant.missingInputs(), 1U);
}

TEST(PlantSession, TheFinalSampleIsSentAgainUntilItHasArrived) {
  PlantSession plant = session(Pace::kLockstep);
  plant.start(0.0);
  for (std::uint32_t k = 0; k < 5; ++k) {
    plant.receive(action(k));
    plant.advance(0.0);
  }
  ASSERT_EQ(plant.phase(), PlantPhase::kFinished);
  EXPECT_TRUE(plant.mustResend(0.06));
  plant.finish();
  EXPECT_FALSE(plant.mustResend(1.0));
}

TEST(PlantSession, PausedOnlyStepsAreTaken) {
  PlantSession plant = session(Pace::kPaced);
  EXPECT_FALSE(plant.step());
  plant.start(0.0);
  plant.pause(true, 0.0);
  plant.receive(action(0));
  EXPECT_FALSE(plant.advance(100.0));
  EXPECT_TRUE(plant.step());
  EXPECT_TRUE(plant.advance(100.0));
  EXPECT_FALSE(plant.advance(200.0));
  plant.pause(false, 200.0);
  plant.receive(action(1));
  EXPECT_FALSE(plant.advance(200.1));
  EXPECT_TRUE(plant.advance(200.2 + 1e-9));
}

TEST(PlantSession, ANewRunMayHaveASmallerNumber) {
  PlantSession plant = session(Pace::kLockstep);
  plant.start(0.0);
  plant.receive(action(0));
  plant.advance(0.0);
  plant.begin(3);
  plant.start(0.0);
  EXPECT_FALSE(plant.receive(action(0)));
  EXPECT_TRUE(plant.receive(action(0, 600.0, 3)));
}

}  // namespace loop_plant_session_test
}  // namespace fpc
