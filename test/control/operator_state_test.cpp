// What was asked of a controller before its first sample, and what becomes of it when the plant's
// end of the exchange comes back.
#include "runtime/session_fixture.hpp"

namespace fpc {
namespace control_operator_state_test {

using namespace test_session;

struct TunableLaw final : FakeLaw {
  bool retune(const Settings&) override { return true; }
};

std::unique_ptr<ControllerSession> newSession(const SetpointParams& setpoint = setpoints()) {
  auto session = std::make_unique<ControllerSession>(std::make_unique<TunableLaw>(), setpoint,
                                                     limits(), of({570.0}), plant());
  TsModel model;
  model.name = "first";
  session->setModel(model);
  return session;
}

OperatorState automatic() { return newSession()->operator_state(); }

TEST(SessionOperatorState, ManualAskedOfAControllerThatCameBackIsNotUndoneByWhatWasKept) {
  const auto session = newSession();
  session->manual(true);
  session->manualInput(of({650.0}));
  session->restore(automatic());
  ASSERT_EQ(session->receive(sample(7)), Receipt::kAnswered);
  EXPECT_EQ(session->answer().base.source, ActionSource::kManual);
  EXPECT_EQ(session->answer().base.input, of({650.0}));
}

TEST(SessionOperatorState, AutomaticAskedOfItWinsOverAManualThatWasKept) {
  OperatorState kept = automatic();
  kept.manual = kept.manual_given = true;
  kept.manual_input = of({900.0});
  const auto session = newSession(), untold = newSession();
  session->manual(false);
  session->restore(kept);
  untold->restore(kept);
  session->receive(sample(7));
  untold->receive(sample(7));
  EXPECT_EQ(session->answer().base.source, ActionSource::kBase);
  EXPECT_EQ(untold->answer().base.input, of({900.0}));
}

TEST(SessionOperatorState, WhoHasBeenToldManualIsNotHeldForWantOfWhatWasKept) {
  const auto session = newSession();
  session->manual(true);
  session->holdUntilReleased();
  EXPECT_FALSE(session->unreleased());
  session->receive(sample(7, 1, 612.0));
  EXPECT_EQ(session->answer().base.source, ActionSource::kManual);
  EXPECT_EQ(session->answer().base.input, of({612.0}));
}

TEST(SessionOperatorState, HoldSetpointsAndSettingsAskedOfItAreNewerThanThoseKept) {
  OperatorState kept = automatic();
  kept.recipe = {true, 3, 0};
  kept.setpoints = {{0, {"x"}, {1800.0}, CommandMode::kOverride},
                    {0, {"s"}, {60.0}, CommandMode::kOverride}};
  kept.settings = {{"weight_move", "1"}, {"horizon_steps", "9"}};
  const auto session = newSession();
  session->holdRecipe(false);
  session->command({0, {"x"}, {2100.0}, CommandMode::kOverride});
  session->retune({{"weight_move", "2"}});
  session->restore(kept);
  session->receive(sample(7));
  EXPECT_FALSE(session->setpoint().held());
  EXPECT_EQ(session->answer().tracking.setpoint, of({60.0, 2100.0}));
  EXPECT_EQ(session->operator_state().settings,
            (Settings{{"weight_move", "2"}, {"horizon_steps", "9"}}));
}

TEST(SessionOperatorState, APlantThatGoesOnUnderANewRunKeepsSetpointAndPlaceOfTheSchedule) {
  SetpointParams scheduled = setpoints();
  scheduled.schedule = {{1.0, of({70.0, 2000.0})}};  // sample 5
  const auto session = newSession(scheduled);
  session->command({0, {"x"}, {1900.0}, CommandMode::kOverride});
  for (std::uint32_t k = 0; k < 4; ++k) session->receive(sample(k));
  session->carryOver();
  session->announce(2);
  for (std::uint32_t k = 0; k < 3; ++k) {  // what would have been samples 4, 5, 6
    ASSERT_EQ(session->receive(sample(k, 2)), Receipt::kAnswered);
    EXPECT_EQ(session->answer().tracking.setpoint, of({k < 1 ? 55.0 : 70.0, 1900.0})) << k;
  }
  session->announce(3);  // an ordinary beginning
  session->receive(sample(0, 3));
  EXPECT_EQ(session->answer().tracking.setpoint, of({55.0, 2000.0}));
}

TEST(SessionOperatorState, AHeldScheduleAndAPendingCommandGoOnToo) {
  SetpointParams scheduled = setpoints();
  scheduled.schedule = {{1.0, of({70.0, 2000.0})}};
  const auto session = newSession(scheduled);
  session->receive(sample(0));
  session->holdRecipe(true);
  session->command({kStart + 6 * kSample, {"x"}, {1900.0}, CommandMode::kOverride});
  for (std::uint32_t k = 1; k < 4; ++k) session->receive(sample(k));
  session->carryOver();
  session->announce(2);
  for (std::uint32_t k = 0; k < 4; ++k) {
    session->receive(sample(k, 2));
    EXPECT_EQ(session->answer().tracking.setpoint, of({55.0, k < 2 ? 2000.0 : 1900.0})) << k;
  }
  session->holdRecipe(false);
  for (std::uint32_t k = 4; k < 9; ++k) {  // held at sample 1: four are left
    session->receive(sample(k, 2));
    EXPECT_EQ(session->answer().tracking.setpoint[0], k < 8 ? 55.0 : 70.0) << k;
  }
}

TEST(SessionComesBack, ASampleThatWasCalledTheLastByMistakeIsAnsweredWhenItComesAgain) {
  const auto session = newSession();
  session->receive(sample(0));
  Measurement last = sample(1);
  last.final = true;
  EXPECT_EQ(session->receive(last), Receipt::kAnswered);
  EXPECT_FALSE(session->answer().has_action);
  EXPECT_EQ(session->receive(last), Receipt::kRepeated);
  EXPECT_EQ(session->receive(sample(1)), Receipt::kAnswered);
  EXPECT_TRUE(session->answer().has_action);
  EXPECT_EQ(session->receive(sample(1)), Receipt::kRepeated);
  EXPECT_EQ(session->receive(sample(2)), Receipt::kAnswered);
}

}  // namespace control_operator_state_test
}  // namespace fpc
