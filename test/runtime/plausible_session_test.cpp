// A loop whose instruments, actuator or models lie: what the controller's session makes of it.
#include <cmath>
#include <functional>

#include "events.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/factory.hpp"
#include "runtime/identifier_session.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace loop_plausible_session_test {

/// 120 samples of the activated sludge loop; x may be in [0, 3500] and more.
LoopFile loopWith(const Overrides& more) {
  Overrides overrides{{"sampling.duration_h", "24"},
                      {"plausibility.signals.x.range", "[-1000, 3000]"},
                      {"actuator.hold_samples", "4"},
                      {"actuator.fallback.q_r", "300"}};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return readLoop("asp_case1", overrides);
}

Overrides fault(const std::string& signal, double value, double to_h) {
  return {{"disturbance.commands",
           "[{time_h: 6, name: " + signal + ", value: " + std::to_string(value) +
               "}, {time_h: " + std::to_string(to_h) + ", name: " + signal + ", mode: release}]"}};
}

ActionSource sourceAt(const RunRecord& record, double time_h) {
  return record.samples[static_cast<std::size_t>(std::lround(time_h * 5.0))].base.source;
}

bool says(const RunRecord& record, EventCode code, const std::string& signal) {
  return test::find(test::eventsOf(record), code, signal) != nullptr;
}

TEST(PlausibleSession, ALyingSensorHoldsTheInputThenFallsBackAndReturnsWithoutABump) {
  LoopFile loop = loopWith(fault("output/x", 9000.0, 8.0));
  loop.plausibility.bridge_samples = 0;
  const RunRecord record = runLoop(loop);
  EXPECT_EQ(sourceAt(record, 5.8), ActionSource::kBase);
  EXPECT_EQ(sourceAt(record, 6.0), ActionSource::kHeld);
  EXPECT_EQ(sourceAt(record, 6.6), ActionSource::kHeld);
  EXPECT_EQ(sourceAt(record, 6.8), ActionSource::kFallback);
  EXPECT_EQ(record.samples[35].base.input[0], 300.0);
  EXPECT_TRUE(says(record, EventCode::kSignalOutOfRange, "x"));
  const std::size_t back = 40;  // 8 h
  EXPECT_NE(record.samples[back].base.source, ActionSource::kFallback);
  const RunRecord calm = runLoop(loopWith({}));
  EXPECT_FALSE(says(calm, EventCode::kSignalOutOfRange, "x"));
  const double bump = std::abs(record.samples[back].base.input[0] - 300.0);
  EXPECT_LT(bump, 160.0);  // a tenth of the range
}

TEST(PlausibleSession, TheModelsValueKeepsTheLoopClosed) {
  Overrides overrides = fault("output/x", 9000.0, 6.6);
  overrides.emplace_back("plausibility.signals.x.substitute", "model");
  const RunRecord record = runLoop(loopWith(overrides));
  EXPECT_EQ(sourceAt(record, 6.0), ActionSource::kBase);
  EXPECT_TRUE(says(record, EventCode::kSignalOutOfRange, "x"));
  const RunRecord calm = runLoop(loopWith({}));
  for (std::size_t k = 30; k < 34; ++k)
    EXPECT_NEAR(record.samples[k].base.input[0], calm.samples[k].base.input[0], 80.0) << k;
}

TEST(PlausibleSession, AStuckActuatorIsSaid) {
  const auto said = [](const LoopFile& loop) {
    const Summary summary = summarize(loop, runLoop(loop), 0.0);
    return test::find(summary.events, EventCode::kInputStuck, "q_r") != nullptr;
  };
  EXPECT_FALSE(said(loopWith({})));
  EXPECT_TRUE(said(loopWith(fault("input/q_r", 900.0, 12.0))));
}

/// A session that has answered its first sample with the loop's model.
ControllerSession started(const LoopFile& loop, Measurement& m) {
  ControllerSession session = makeControllerSession(loop);
  session.setModel(loop.model);
  m.header = loop.plant_info.header;
  m.outputs = (Vector(2) << 55.0, 1793.0).finished();
  m.disturbances = loop.disturbance_nominal;
  m.input_applied = loop.simulation.actuator.initial;
  EXPECT_EQ(session.receive(m), Receipt::kAnswered);
  return session;
}

/// With the inputs of these submodels turned round.
TsModel negated(TsModel model, std::initializer_list<std::size_t> outputs) {
  for (const std::size_t o : outputs)
    for (Rule& rule : model.submodels[o].rules)
      for (std::size_t i = 0; i < model.submodels[o].regressors.size(); ++i)
        if (model.submodels[o].regressors[i].kind == SignalKind::kInput)
          rule.coefficients[static_cast<Eigen::Index>(i)] *= -1.0;
  return model;
}

TEST(PlausibleSession, AModelWithNegatedGainsIsRefusedInTheRun) {
  const LoopFile loop = loopWith({});
  Measurement m;
  ControllerSession session = started(loop, m);
  expectWords(errorOf([&] { session.setModel(negated(loop.model, {0, 1})); }), {"gain", "q_r"});
  EXPECT_EQ(session.models(), 1U);
  EXPECT_NO_THROW(session.setModel(loop.model));
  EXPECT_EQ(session.modelText(), "");
}

TEST(PlausibleSession, ATurnedModelThatIsTakenIsSaidOnce) {
  LoopFile loop = loopWith({});
  loop.plausibility.gain_sign = false;
  Measurement m;
  ControllerSession session = started(loop, m);
  EXPECT_TRUE(session.output().events.empty());
  session.setModel(negated(loop.model, {1}));
  EXPECT_EQ(session.models(), 2U);
  expectWords(session.modelText(), {"turns the sign of the gain from", "q_r to x"});
  for (const bool said : {true, false}) {
    ++m.header.step;
    m.header.time_ns += 720'000'000'000;
    m.input_applied = session.answer().base.input;
    ASSERT_EQ(session.receive(m), Receipt::kAnswered);
    EXPECT_EQ(session.output().events.has(EventCode::kModelGainTurned), said);
  }
  session.setModel(negated(loop.model, {1}));  // the same again turns nothing
  EXPECT_EQ(session.modelText(), "");
}

TEST(PlausibleSession, WithoutTheRuleATurnedModelIsTakenAndStillSaid) {
  LoopFile loop = loopWith({});
  loop.plausibility.gain_sign = false;
  Measurement m;
  ControllerSession session = started(loop, m);
  session.setModel(negated(loop.model, {0, 1}));
  expectWords(session.modelText(), {"q_r to s", "q_r to x"});
}

/// A loop that runs with a model whose second output pushes the wrong way gets one that was learned
/// from the plant: it turns that gain back, is taken, and that is said.
TEST(PlausibleSession, ALearnedModelThatTurnsAGainIsTakenAndSaid) {
  LoopFile loop = readLoop("asp_case1",
                           {{"sampling.duration_h", "60"}, {"model.identify.online.every", "100"}});
  loop.plausibility.gain_sign = false;
  const RunRecord record = runLoop(readLoop("asp_case1", {{"sampling.duration_h", "60"}}));
  IdentifierSession identifier(loop);
  identifier.start();
  ControllerSession session = makeControllerSession(loop);
  session.setModel(negated(loop.model, {1}));
  bool said = false;
  std::string of_model;
  for (const SampleRecord& sample : record.samples) {
    session.receive(sample.measurement);
    said = said || session.output().events.has(EventCode::kModelGainTurned);
    const auto due = identifier.take(sample.measurement);
    if (due.model == nullptr || session.models() > 1) continue;
    session.setModel(*due.model);
    of_model = session.modelText();
  }
  EXPECT_EQ(session.models(), 2U);
  expectWords(of_model, {"turns the sign of the gain from", "q_r to x"});
  EXPECT_TRUE(said);
}

/// All coefficients of one output of two turned round: one gain turns, and what came is missed by
/// far.
TEST(PlausibleSession, ANegatedOutputIsRefusedByWhatItForesees) {
  const LoopFile loop = readLoop("asp_case1", {{"sampling.duration_h", "12"}});
  ControllerSession session = makeControllerSession(loop);
  session.setModel(loop.model);
  for (const SampleRecord& sample : runLoop(loop).samples) session.receive(sample.measurement);
  TsModel bad = loop.model;
  for (Rule& rule : bad.submodels[0].rules) rule.coefficients *= -1.0;
  expectWords(errorOf([&] { session.setModel(bad); }), {"foresee s", "q_r"});
  EXPECT_EQ(session.models(), 1U);
  session.setModel(loop.model);
  EXPECT_EQ(session.models(), 2U);
}

/// Every fourth loop, 40 samples of it; with FMBPC_LONG_TESTS all of all.
TEST(PlausibleSession, NoShippedLoopIsDoubted) {
  const bool all = std::getenv("FMBPC_LONG_TESTS") != nullptr;
  std::size_t number = 0, seen = 0;
  for (const std::string& name : loopNames()) {
    if ((!all && number++ % 4 != 0) || (needsRecords(name) && !hasRecords())) continue;
    LoopFile loop = readLoop(name);
    if (loop.external_plant) continue;
    const std::string hours = exactText(loop.simulation.sample_time_s * 40.0 / 3600.0);
    const RunRecord record = runLoop(
        all ? loop
            : readLoop(name, {{"sampling.duration_h", hours}, {"report.record_from_h", "0"}}));
    const std::vector<Event> events = summarize(loop, record, 0.0).events;
    for (const EventCode code :
         {EventCode::kSignalMissing, EventCode::kSignalOutOfRange, EventCode::kSignalTooFast,
          EventCode::kSignalJumped, EventCode::kSignalFrozen, EventCode::kSignalNotRenewed,
          EventCode::kInputHeld, EventCode::kInputStuck, EventCode::kMeasurementRejected})
      EXPECT_FALSE(contains(events, code)) << name << ": " << kindOf(code).name;
    ++seen;
  }
  EXPECT_GT(seen, 30U);
}

}  // namespace loop_plausible_session_test
}  // namespace fpc
