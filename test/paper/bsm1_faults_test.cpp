// BSM1 with faults of sensors, influent and blowers on a short protocol (2 days of constant
// influent, 14 of our own, the last 7 judged): limits hold, the fault is said, and the effluent is
// no worse than the default control's under the same fault.
#include <gtest/gtest.h>

#include <algorithm>

#include "events.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"
#include "study/evaluate.hpp"

namespace fpc {
namespace paper_bsm1_faults_test {

/// From 8 days before the end to the end.
const std::string kFrom = "192", kTo = "384";

struct Outcome {
  EffluentReport effluent;
  Summary summary;
  bool saysFrozen(const std::string& signal) const {
    return test::find(summary.events, EventCode::kSignalFrozen, signal) != nullptr;
  }
};

Outcome run(const std::string& name, const Overrides& fault) {
  Overrides overrides{{"disturbance.csv.lead_in_h", "48"},
                      {"sampling.duration_h", kTo},
                      {"report.record_from_h", "216"}};
  overrides.insert(overrides.end(), fault.begin(), fault.end());
  const LoopFile loop = readLoop(name, overrides);
  const RunRecord record = runLoop(loop);
  EXPECT_TRUE(record.complete) << record.trouble;
  return {evaluateEffluent(trajectoryOf(loop, record)), summarize(loop, record, 0.0)};
}

Overrides stuck(const std::string& sensor) {
  return {{"sensors." + sensor + ".class", sensor == "Q_in" ? "A" : "B0"},
          {"sensors." + sensor + ".stuck_h", std::string("[") + kFrom + ", " + kTo + "]"}};
}

/// `frozen`: the signal that is to be said frozen, "" for none.
void expectNoWorse(const Overrides& fault, const std::string& frozen) {
  const Outcome is = run("bsm1_own_default", fault), ours = run("bsm1_own_fmbpc", fault);
  EXPECT_EQ(ours.summary.input_violations, 0U);
  EXPECT_EQ(ours.summary.move_violations, 0U);
  EXPECT_LE(ours.effluent.EQI, is.effluent.EQI);
  EXPECT_TRUE(frozen.empty() || ours.saysFrozen(frozen)) << frozen;
}

TEST(Bsm1Faults, AnAmmoniumAnalyserThatSticksForEightDays) {
  expectNoWorse(stuck("S_NH5"), "S_NH5");
}

/// White noise on the ammonium, with the window that bsm1_fmbpc (up to 0.1 g/m3) or
/// bsm1_fmbpc_noise has for that much of it.
Overrides noisy(const std::string& std) {
  Overrides overrides{{"noise.std.S_NH5", std}};
  if (std::stod(std) > 0.1) overrides.emplace_back("standstill.noise_window_h", "24");
  return overrides;
}

/// `base` and then `more`.
Overrides both(Overrides base, const Overrides& more) {
  base.insert(base.end(), more.begin(), more.end());
  return base;
}

// Noise that goes on while the analyser sticks: it never shows the same number twice.
TEST(Bsm1Faults, AnAmmoniumAnalyserThatSticksUnderItsNoise) {
  for (const char* noise : {"0.05", "0.3"}) {
    const Overrides fault = both(stuck("S_NH5"), {{"noise.std.S_NH5", noise}});
    const Outcome is = run("bsm1_own_default", fault);
    const Outcome ours = run("bsm1_own_fmbpc", both(stuck("S_NH5"), noisy(noise)));
    EXPECT_EQ(ours.summary.input_violations, 0U) << noise;
    EXPECT_LE(ours.effluent.EQI, is.effluent.EQI) << noise;
    EXPECT_TRUE(ours.saysFrozen("S_NH5")) << noise;
  }
}

// At six in the morning the ammonium is at its lowest: a law that goes on with it starves the
// plant of air in the peak of the day.
TEST(Bsm1Faults, AnAnalyserThatSticksUnderItsNoiseBeforeThePeak) {
  if (!hasRecords()) GTEST_SKIP() << "needs ${FMBPC_DATA}";
  Overrides fault = stuck("S_NH5");
  fault[1].second = std::string("[222, ") + kTo + "]";  // the first morning of the judged week
  fault.emplace_back("noise.std.S_NH5", "0.05");
  const Outcome is = run("bsm1_default", fault), ours = run("bsm1_fmbpc", fault);
  EXPECT_LE(ours.effluent.EQI, is.effluent.EQI);
  EXPECT_TRUE(ours.saysFrozen("S_NH5"));
}

TEST(Bsm1Faults, AHealthyNoisyAnalyserIsNotAccused) {
  for (const char* noise : {"0.05", "0.3"})
    for (const char* seed : {"1", "2", "3"})
      EXPECT_FALSE(run("bsm1_own_fmbpc", both(noisy(noise), {{"seed", seed}})).saysFrozen(""))
          << noise << ", seed " << seed;
}

TEST(Bsm1Faults, AFlowMeterThatIsLost) { expectNoWorse(stuck("Q_in"), "Q_in"); }

TEST(Bsm1Faults, TwiceTheFlowForADay) {
  expectNoWorse({{"disturbance.commands",
                  "[{time_h: 240, name: Q_in, value: 18446, mode: offset}, {time_h: 264, name: "
                  "Q_in, mode: release}]"}},
                "");
}

// With blowers as large as the default control's: class A bounds that of tank 5 at 240, not 360.
TEST(Bsm1Faults, BlowersAtSixtyPercent) {
  expectNoWorse({{"disturbance.commands", "[{time_h: " + kFrom + ", name: blower, value: 0.6}]"},
                 {"plant.parameters.KLa5_upper", "360"}},
                "");
}

TEST(Bsm1Faults, AHealthyPlantIsNotAccused) {
  const Outcome ours = run("bsm1_own_fmbpc", {});
  EXPECT_FALSE(ours.saysFrozen(""));
  EXPECT_LE(ours.effluent.EQI, run("bsm1_own_default", {}).effluent.EQI);
}

}  // namespace paper_bsm1_faults_test
}  // namespace fpc
