#include "runtime/session_fixture.hpp"

namespace fpc {
namespace control_controller_session_test {

using namespace test_session;

class ControllerSessionExchange : public SessionFixture {};

TEST_F(ControllerSessionExchange, AnswersEachNewSampleOnceUnderItsHeader) {
  for (std::uint32_t k = 0; k < 3; ++k) {
    ASSERT_EQ(session->receive(sample(k)), Receipt::kAnswered);
    const ControllerAnswer& answer = session->answer();
    for (const StepHeader& h :
         {answer.base.header, answer.tracking.header, answer.prediction.header}) {
      EXPECT_EQ(h.step, k);
      EXPECT_EQ(h.run_id, 1u);
      EXPECT_EQ(h.time_ns, kStart + k * kSample);
    }
    EXPECT_TRUE(answer.has_action);
    EXPECT_TRUE(answer.has_prediction);
    EXPECT_EQ(input(), 571.0);
    EXPECT_EQ(source(), ActionSource::kBase);
    EXPECT_EQ(answer.tracking.setpoint, of({55.0, 2000.0}));
    EXPECT_EQ(answer.tracking.reference, of({55.5, 1995.0}));
  }
  EXPECT_EQ(law->resets, Steps{0});
  EXPECT_EQ(law->steps, (Steps{0, 1, 2}));
  EXPECT_EQ(session->counts().accepted, 3u);
  EXPECT_EQ(session->resetReason(), "");
}

TEST_F(ControllerSessionExchange, RepeatGetsTheCachedAnswerAndIsNeverComputedTwice) {
  session->receive(sample(0));
  Measurement again = sample(0);
  again.input_applied[0] = 900.0;
  EXPECT_EQ(session->receive(again), Receipt::kRepeated);
  EXPECT_EQ(input(), 571.0);
  EXPECT_EQ(law->steps, Steps{0});
  EXPECT_EQ(session->counts().repeated, 1u);
}

/// A law begins with the first measurement that it gets as it would at sample 0, unless somebody
/// else has had the inputs or it came late itself.
TEST_F(ControllerSessionExchange, ARunWithoutItsFirstMeasurementBeginsWithTheNext) {
  const auto lost = [](std::uint32_t step, std::uint64_t run_id) {
    Measurement m = sample(step, run_id);
    m.outputs[0] = kNaN;
    return m;
  };
  for (const std::uint32_t k : {0, 1}) session->receive(lost(k, 1));
  session->receive(sample(2, 1));
  EXPECT_EQ(law->resets, Steps{0});
  EXPECT_EQ(law->steps, Steps{2});
  session->receive(lost(0, 2));
  session->manual(true);
  session->receive(sample(1, 2));
  session->manual(false);
  session->receive(sample(2, 2));
  EXPECT_EQ(law->resets, (Steps{0, 2}));
  session->receive(lost(1, 3));  // sample 0 was answered by nobody here
  session->receive(sample(2, 3));
  EXPECT_EQ(law->resets, (Steps{0, 2, 2}));
}

TEST_F(ControllerSessionExchange, OldStepsAndEarlierRunsAreDroppedAndCountedApart) {
  session->receive(sample(0, 5));
  session->receive(sample(1, 5));
  EXPECT_EQ(session->receive(sample(0, 5)), Receipt::kDropped);
  EXPECT_EQ(session->receive(sample(2, 4)), Receipt::kDropped);
  EXPECT_EQ(session->counts().old, 1u);
  EXPECT_EQ(session->counts().other_run, 1u);
  EXPECT_EQ(session->answer().base.header.step, 1u);
  EXPECT_EQ(session->receive(sample(2, 5)), Receipt::kAnswered);
  EXPECT_EQ(law->resets, Steps{0});
}

TEST_F(ControllerSessionExchange, WrongSizesAreDroppedAndDoNotTouchTheSequence) {
  session->receive(sample(0));
  Measurement m = sample(1);
  m.outputs = of({1.0});
  EXPECT_EQ(session->receive(m), Receipt::kDropped);
  m = sample(1);
  m.disturbances = Vector();
  EXPECT_EQ(session->receive(m), Receipt::kDropped);
  m = sample(1);
  m.input_applied = of({1.0, 2.0});
  EXPECT_EQ(session->receive(m), Receipt::kDropped);
  EXPECT_EQ(session->counts().wrong_size, 3u);
  EXPECT_EQ(session->receive(sample(1)), Receipt::kAnswered);
  EXPECT_EQ(law->resets, Steps{0});
}

/// A law that fills in what it must and nothing else.
struct InputOnly final : Controller {
  void reset(const Measurement&) override {}
  void step(const Measurement& now, const SetpointSource&, ControllerOutput& output) override {
    output.input = now.input_applied.array() + 1.0;
  }
};

TEST(ControllerSession, ALawThatOnlyGivesAnInputActsAlsoAfterItWasHeld) {
  ControllerSession session(std::make_unique<InputOnly>(), setpoints(), limits(), of({570.0}),
                            plant());
  Measurement lost = sample(1);
  lost.outputs[0] = kNaN;
  const Measurement samples[] = {sample(0), lost, sample(2)};
  const ActionSource expected[] = {ActionSource::kBase, ActionSource::kHeld, ActionSource::kBase};
  for (int i = 0; i < 3; ++i) {
    session.receive(samples[i]);
    EXPECT_EQ(session.answer().base.source, expected[i]) << i;
  }
  EXPECT_EQ(session.answer().base.input[0], 571.0);
}

TEST_F(ControllerSessionExchange, GapResetsAndNamesTheMissingSamples) {
  session->receive(sample(0));
  session->receive(sample(4));
  EXPECT_EQ(session->resetReason(), "samples 1..3 missing");
  session->receive(sample(5));
  EXPECT_EQ(session->resetReason(), "");
  session->receive(sample(7));
  EXPECT_EQ(session->resetReason(), "sample 6 missing");
  EXPECT_EQ(law->resets, (Steps{0, 4, 7}));
  EXPECT_EQ(session->counts().gaps, 2u);
}

TEST_F(ControllerSessionExchange, NewRunResetsAndReleasesSetpointCommands) {
  session->receive(sample(0, 1));
  session->command({0, {"x"}, {2200.0}, CommandMode::kOverride});
  session->receive(sample(1, 1));
  EXPECT_EQ(law->seen_setpoint[1], 2200.0);
  EXPECT_EQ(session->receive(sample(0, 2)), Receipt::kAnswered);
  EXPECT_EQ(session->resetReason(), "new run");
  EXPECT_EQ(law->resets, (Steps{0, 0}));
  EXPECT_EQ(law->seen_setpoint[1], 2000.0);
  EXPECT_EQ(session->counts().new_runs, 1u);
}

TEST_F(ControllerSessionExchange, LateJoinerStartsAtWhateverSampleComes) {
  SetpointParams p = setpoints();
  p.schedule = {{1.0, of({55.0, 1900.0})}};
  p.rate_per_h = of({1.0, 1.0});
  make(limits(), p);
  EXPECT_EQ(session->receive(sample(41, 9)), Receipt::kAnswered);
  EXPECT_EQ(session->resetReason(), "first sample is 41");
  EXPECT_EQ(law->resets, Steps{41});
  EXPECT_EQ(law->seen_setpoint[1], 1900.0);
  EXPECT_EQ(session->counts().gaps, 0u);
}

TEST_F(ControllerSessionExchange, SetpointsCatchUpOverAGap) {
  SetpointParams p = setpoints();
  p.schedule = {{0.4, of({55.0, 1900.0})}};
  p.rate_per_h = of({1e9, 50.0});  // 10 per sample
  make(limits(), p);
  session->receive(sample(0));
  session->receive(sample(6));
  EXPECT_NEAR(session->answer().tracking.setpoint[1], 1940.0, 1e-9);
}

TEST_F(ControllerSessionExchange, SetpointCommandsTakeEffectUnderTheSamplesHeader) {
  session->receive(sample(0, 3));
  EXPECT_EQ(session->command({0, {"x"}, {2100.0}, CommandMode::kOverride}), 1u);
  session->receive(sample(1, 3));
  ASSERT_EQ(session->answer().effects.size(), 1u);
  EXPECT_EQ(session->answer().effects[0].header.run_id, 3u);
  EXPECT_EQ(session->answer().effects[0].header.step, 1u);
  EXPECT_EQ(session->answer().effects[0].header.time_ns, kStart + kSample);
  session->receive(sample(2, 3));
  EXPECT_TRUE(session->answer().effects.empty());
}

TEST_F(ControllerSessionExchange, RespawnedSessionTakesUpTheSetpointThatWasInForce) {
  EXPECT_TRUE(session->restore({0, {"x"}, {1850.0}, CommandMode::kOverride}));
  session->receive(sample(30));
  EXPECT_EQ(law->seen_setpoint[1], 1850.0);
  EXPECT_FALSE(session->restore({0, {"x"}, {1.0}, CommandMode::kOverride}));
}

TEST_F(ControllerSessionExchange, StampsAreThoseOfThePlantNotOfThePlantInfo) {
  Measurement m = sample(0);
  const std::int64_t t0 = 1700000000123456789;
  m.header.time_ns = t0;
  session->receive(m);
  EXPECT_EQ(session->command({t0 + 3 * kSample, {"x"}, {1.0}, CommandMode::kOverride}), 3u);
}

TEST_F(ControllerSessionExchange, FinalSampleHasTrackingButNoAction) {
  session->receive(sample(0));
  Measurement m = sample(1);
  m.final = true;
  EXPECT_EQ(session->receive(m), Receipt::kAnswered);
  EXPECT_FALSE(session->answer().has_action);
  EXPECT_FALSE(session->answer().has_prediction);
  EXPECT_EQ(session->answer().tracking.header.step, 1u);
  EXPECT_EQ(session->answer().tracking.reference, of({55.5, 1995.0}));
  EXPECT_EQ(session->receive(m), Receipt::kRepeated);
  EXPECT_FALSE(session->answer().has_action);
  EXPECT_EQ(law->steps, (Steps{0, 1}));
}

TEST_F(ControllerSessionExchange, NotReadyWithoutTheModelItNeeds) {
  law->needs_model = true;
  EXPECT_FALSE(session->ready());
  EXPECT_EQ(session->receive(sample(0)), Receipt::kNotReady);
  EXPECT_EQ(session->counts().accepted, 0u);
  TsModel model;
  model.name = "bad";
  EXPECT_THROW(session->setModel(model), InputError);
  EXPECT_FALSE(session->ready());
  model.name = "good";
  session->setModel(model);
  EXPECT_TRUE(session->ready());
  EXPECT_EQ(session->receive(sample(0)), Receipt::kAnswered);  // the plant sent it again
  EXPECT_EQ(session->resetReason(), "first sample is 0");
}

TEST_F(ControllerSessionExchange, NewModelInARunGoesToTheControllerAndABadOneChangesNothing) {
  session->receive(sample(0));
  TsModel model;
  model.name = "second";
  session->setModel(model);
  model.name = "bad";
  EXPECT_THROW(session->setModel(model), InputError);
  EXPECT_EQ(law->models, std::vector<std::string>{"second"});
  EXPECT_EQ(session->receive(sample(1)), Receipt::kAnswered);
  EXPECT_EQ(law->resets, Steps{0});  // the controller itself sees to a bumpless change
}

TEST_F(ControllerSessionExchange, WhatTheOperatorAskedComesBackInAnotherSession) {
  session->receive(sample(0));
  session->command({0, {"x"}, {1900.0}, CommandMode::kOverride});
  session->command({kStart + 50 * kSample, {"s"}, {60.0}, CommandMode::kOverride});
  session->holdRecipe(true);
  session->manual(true);
  session->manualInput(of({650.0}));
  session->receive(sample(1));
  const OperatorState operator_state = session->operator_state();
  FakeLaw* other_law = new FakeLaw;
  ControllerSession other(std::unique_ptr<Controller>(other_law), setpoints(), limits(),
                          of({570.0}), plant());
  TsModel model;
  model.name = "first";
  other.setModel(model);
  other.restore(operator_state);
  ASSERT_EQ(other.receive(sample(2)), Receipt::kAnswered);
  EXPECT_EQ(other.answer().base.source, ActionSource::kManual);
  EXPECT_EQ(other.answer().base.input, of({650.0}));
  EXPECT_EQ(other.answer().tracking.setpoint, of({55.0, 1900.0}));
  EXPECT_TRUE(other.setpoint().held());
  other.receive(sample(50));
  EXPECT_EQ(other.answer().tracking.setpoint, of({60.0, 1900.0}));
  other.restore(OperatorState{});  // too late: it knows better
  other.receive(sample(51));
  EXPECT_TRUE(other.isManual());
}

TEST_F(ControllerSessionExchange, OneThatDoesNotKnowWhatWasAskedHoldsUntilItIsReleased) {
  session->holdUntilReleased();
  session->receive(sample(7, 1, 612.0));
  EXPECT_EQ(session->answer().base.source, ActionSource::kHeld);
  EXPECT_EQ(session->answer().base.input, of({612.0}));
  session->manual(false);
  session->receive(sample(8, 1, 612.0));
  EXPECT_EQ(session->answer().base.source, ActionSource::kBase);
  EXPECT_EQ(session->resetReason(), "first sample is 7; released");
}

TEST_F(ControllerSessionExchange, TheLawLooksOnWhileOthersHaveTheInput) {
  Measurement unknown = sample(0);
  unknown.outputs[0] = kNaN;
  session->receive(unknown);  // never measured: nothing to look at
  session->receive(sample(1));
  session->manual(true);
  session->receive(sample(2));
  session->receive(sample(3));
  session->manual(false);
  session->receive(sample(4));
  Measurement bad = sample(5);
  bad.outputs[0] = kNaN;
  session->receive(bad);  // held: what was not measured is not looked at
  session->receive(sample(6));
  session->plantTakesActions(false);
  session->receive(sample(7));
  EXPECT_EQ(law->looks, (Steps{2, 3, 7}));
  EXPECT_EQ(law->steps, (Steps{1, 4, 6}));
  EXPECT_EQ(law->resets, (Steps{0, 4, 6}));
}

TEST_F(ControllerSessionExchange, AnEarlierClockOfThePlantDoesNotStopIt) {
  session->announce(9);
  session->receive(sample(0, 9));
  session->announce(3);
  EXPECT_EQ(session->receive(sample(1, 9)), Receipt::kDropped);
  EXPECT_EQ(session->receive(sample(0, 3)), Receipt::kAnswered);
  EXPECT_EQ(session->resetReason(), "new run");
}

TEST_F(ControllerSessionExchange, OneMessageFromTheFarFutureDoesNotEndTheRun) {
  session->receive(sample(0));
  EXPECT_EQ(session->receive(sample(4000000000U)), Receipt::kDropped);
  EXPECT_EQ(session->receive(sample(1)), Receipt::kAnswered);
  EXPECT_EQ(session->resetReason(), "");
  EXPECT_EQ(session->receive(sample(500)), Receipt::kAnswered);  // may be true
  EXPECT_EQ(session->receive(sample(2)), Receipt::kAnswered);    // it was not
  EXPECT_EQ(session->resetReason(), "back to sample 2, where the plant is");
}

TEST(ControllerSession, BadConstructionNamesTheField) {
  const auto make = [](Vector initial, const InputLimits& l) {
    ControllerSession(std::make_unique<FakeLaw>(), setpoints(), l, std::move(initial), plant());
  };
  EXPECT_NO_THROW(make(of({1.0}), limits()));
  EXPECT_THROW(make(of({1.0, 2.0}), limits()), InputError);
  EXPECT_THROW(make(of({kNaN}), limits()), InputError);
  EXPECT_THROW(make(of({1.0}), limits(-1.0)), InputError);
  EXPECT_THROW(ControllerSession(nullptr, setpoints(), limits(), of({1.0}), plant()), InputError);
}

}  // namespace control_controller_session_test
}  // namespace fpc
