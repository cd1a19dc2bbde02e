#include "control/pi/pi.hpp"
#include "runtime/session_fixture.hpp"

namespace fpc {
namespace control_controller_safety_test {

using namespace test_session;

class ControllerSessionHold : public SessionFixture {};
class ControllerSessionManual : public SessionFixture {};

TEST_F(ControllerSessionHold, SampleThatIsNotFiniteIsAnsweredWithTheAppliedInput) {
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    make();
    session->receive(sample(0));
    Measurement m = sample(1, 1, 640.0);
    m.outputs[1] = bad;
    EXPECT_EQ(session->receive(m), Receipt::kAnswered);
    EXPECT_EQ(input(), 640.0);
    EXPECT_EQ(source(), ActionSource::kHeld);
    EXPECT_TRUE(session->answer().has_action);
    EXPECT_FALSE(session->answer().has_prediction);
    EXPECT_FALSE(session->output().ok);
    EXPECT_TRUE(session->output().events.has(EventCode::kSignalMissing));
    EXPECT_TRUE(session->answer().tracking.reference.allFinite());
    m = sample(2);
    m.disturbances[0] = bad;
    session->receive(m);
    EXPECT_EQ(source(), ActionSource::kHeld);
    EXPECT_EQ(session->counts().not_finite, 2u);
    EXPECT_EQ(law->steps, Steps{0});
  }
}

TEST_F(ControllerSessionHold, ControllerIsResetAtTheNextFiniteSample) {
  session->receive(sample(0));
  Measurement m = sample(1);
  m.outputs[0] = kNaN;
  session->receive(m);
  EXPECT_EQ(session->resetReason(), "");
  session->receive(sample(2));
  EXPECT_EQ(session->resetReason(), "data before were not finite");
  EXPECT_EQ(source(), ActionSource::kBase);
  EXPECT_TRUE(session->output().ok);
  session->receive(sample(3));
  EXPECT_EQ(law->resets, (Steps{0, 2}));
  EXPECT_EQ(session->resetReason(), "");
}

TEST_F(ControllerSessionHold, AppliedInputThatIsNotFiniteIsReplacedByTheLastOneSent) {
  Measurement m = sample(0);
  m.input_applied[0] = kInfinity;
  session->receive(m);
  EXPECT_EQ(input(), 570.0);  // u(-1) of the loop file: nothing was sent yet
  session->receive(sample(1, 1, 700.0));
  m = sample(2);
  m.input_applied[0] = kNaN;
  session->receive(m);
  EXPECT_EQ(input(), 701.0);
  EXPECT_EQ(source(), ActionSource::kHeld);
  EXPECT_EQ(session->counts().not_finite, 2u);
}

TEST_F(ControllerSessionHold, HeldInputStaysInsideTheBounds) {
  Measurement m = sample(0, 1, 5000.0);
  m.outputs[0] = kNaN;
  session->receive(m);
  EXPECT_EQ(input(), 1600.0);
}

TEST_F(ControllerSessionHold, SetpointsAdvanceOverSamplesThatAreNotFinite) {
  session->receive(sample(0));
  session->command({0, {"x"}, {2100.0}, CommandMode::kOverride});
  Measurement m = sample(1);
  m.outputs[0] = kNaN;
  session->receive(m);
  EXPECT_EQ(session->answer().tracking.setpoint[1], 2100.0);
  EXPECT_EQ(session->answer().effects.size(), 1u);
}

TEST_F(ControllerSessionHold, LawInTroubleHoldsAndTellsWhy) {
  session->receive(sample(0));
  law->spoil = [](ControllerOutput& o) {
    o.ok = false;
    o.events.add({EventCode::kInputWithoutEffect});
    o.input[0] = 1234.0;
  };
  session->receive(sample(1, 1, 640.0));
  EXPECT_EQ(input(), 640.0);
  EXPECT_EQ(source(), ActionSource::kHeld);
  EXPECT_FALSE(session->answer().has_prediction);
  EXPECT_TRUE(session->output().events.has(EventCode::kInputWithoutEffect));
}

TEST_F(ControllerSessionHold, BrokenLawNeverReachesTheActuator) {
  session->receive(sample(0));
  law->spoil = [](ControllerOutput& o) { o.input[0] = kNaN; };
  session->receive(sample(1, 1, 640.0));
  EXPECT_EQ(input(), 640.0);
  EXPECT_EQ(source(), ActionSource::kHeld);
  law->spoil = [](ControllerOutput& o) { o.input = of({1.0, 2.0}); };
  session->receive(sample(2, 1, 650.0));
  EXPECT_EQ(session->answer().base.input, of({650.0}));
  law->spoil = [](ControllerOutput& o) { o.input[0] = 9999.0; };
  session->receive(sample(3, 1, 650.0));
  EXPECT_EQ(input(), 1600.0);
}

TEST_F(ControllerSessionManual, ManualKeepsTheAppliedInputUntilAPersonSaysOtherwise) {
  session->receive(sample(0));
  session->manual(true);
  EXPECT_TRUE(session->isManual());
  session->receive(sample(1, 1, 700.0));
  EXPECT_EQ(input(), 700.0);
  EXPECT_EQ(source(), ActionSource::kManual);
  EXPECT_FALSE(session->answer().has_prediction);
  EXPECT_EQ(session->answer().tracking.reference, of({56.0, 1990.0}));
  EXPECT_EQ(session->answer().tracking.setpoint, of({55.0, 2000.0}));
  session->receive(sample(2, 1, 690.0));  // the valve drifts, the wish stays
  EXPECT_EQ(input(), 700.0);
  EXPECT_EQ(law->steps, Steps{0});
}

TEST_F(ControllerSessionManual, ManualInputRespectsBoundsAndMoveLimit) {
  make(limits(50.0));
  session->receive(sample(0));
  session->manual(true);
  session->manualInput(of({680.0}));
  session->receive(sample(1, 1, 570.0));
  EXPECT_EQ(input(), 620.0);
  session->receive(sample(2, 1, 620.0));
  EXPECT_EQ(input(), 670.0);
  session->receive(sample(3, 1, 670.0));
  EXPECT_EQ(input(), 680.0);
  session->manualInput(of({1e9}));
  session->receive(sample(4, 1, 1590.0));
  EXPECT_EQ(input(), 1600.0);
}

TEST_F(ControllerSessionManual, BadManualInputIsRefused) {
  EXPECT_THROW(session->manualInput(of({600.0})), InputError);  // auto: switch to manual first
  session->manual(true);
  EXPECT_THROW(session->manualInput(of({600.0, 1.0})), InputError);
  EXPECT_THROW(session->manualInput(of({kNaN})), InputError);
  session->receive(sample(0));
  EXPECT_EQ(input(), 570.0);
}

TEST_F(ControllerSessionManual, AnOldManualInputIsForgottenWhenManualComesBack) {
  session->manual(true);
  session->manualInput(of({100.0}));
  session->receive(sample(0));
  session->manual(false);
  session->receive(sample(1, 1, 100.0));
  session->manual(true);
  session->receive(sample(2, 1, 350.0));
  EXPECT_EQ(input(), 350.0);
}

TEST_F(ControllerSessionManual, BackInAutoTheControllerIsReset) {
  session->receive(sample(0));
  session->manual(true);
  session->receive(sample(1));
  session->manual(false);
  session->receive(sample(2));
  EXPECT_EQ(session->resetReason(), "back from manual");
  EXPECT_EQ(source(), ActionSource::kBase);
  EXPECT_EQ(law->resets, (Steps{0, 2}));
  session->manual(true);
  session->manual(false);  // between two samples: nothing happened
  session->receive(sample(3));
  EXPECT_EQ(law->resets, (Steps{0, 2}));
}

TEST_F(ControllerSessionManual, ManualLastsOverGapsAndNewRuns) {
  session->manual(true);
  session->manualInput(of({600.0}));
  session->receive(sample(0, 1));
  session->receive(sample(9, 1));
  session->receive(sample(0, 2));
  EXPECT_EQ(input(), 600.0);
  EXPECT_EQ(source(), ActionSource::kManual);
  EXPECT_TRUE(law->resets.empty());
  EXPECT_EQ(session->resetReason(), "");
  EXPECT_EQ(session->counts().gaps, 1u);
}

TEST_F(ControllerSessionManual, FinalSampleInManualTracksTheOutputs) {
  session->manual(true);
  Measurement m = sample(5);
  m.final = true;
  session->receive(m);
  EXPECT_FALSE(session->answer().has_action);
  EXPECT_EQ(session->answer().tracking.reference, m.outputs);
}

TEST(ControllerSessionWithPi, ManualAndBackIsBumplessWithPi) {
  PiParams params;
  params.loops.resize(1);
  params.loops[0].kp = -1.0;
  params.loops[0].ki_per_h = -0.1;
  params.loops[0].bias = 775.0;
  ControllerSession session(std::make_unique<PiController>(params, limits(), plant()), setpoints(),
                            limits(), of({775.0}), plant());
  double applied = 775.0;
  const auto next = [&](std::uint32_t step) {
    session.receive(sample(step, 1, applied));
    return applied = session.answer().base.input[0];
  };
  EXPECT_EQ(next(0), 776.0);  // u = 775 + (s - 55), the integral is 0
  EXPECT_NEAR(next(1), 776.02, 1e-9);
  session.manual(true);
  const double before = applied;
  EXPECT_EQ(next(2), before);
  session.manualInput(of({400.0}));
  EXPECT_EQ(next(3), 400.0);
  session.manual(false);
  EXPECT_EQ(next(4), 400.0);
  EXPECT_NEAR(next(5), 400.02, 1e-9);
}

}  // namespace control_controller_safety_test
}  // namespace fpc
