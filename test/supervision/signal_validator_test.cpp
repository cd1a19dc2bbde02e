#include "supervision/signal_validator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "base/no_value.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace supervision_signal_validator_test {

PlantInfo plant() {
  PlantInfo info;
  info.sample_time_s = 3600.0;
  info.outputs = {{"x", "mg/l", 0.0, 100.0}};
  info.disturbances = {{"q", "m3/h", 0.0, 10.0}};
  info.inputs = {{"u", "m3/h", 0.0, 10.0}};
  return info;
}

PlausibilityParams params(const std::function<void(SignalPlausibility&)>& change = nullptr) {
  PlausibilityParams p;
  p.enabled = true;
  p.hold_samples = 3;
  p.fallback = Vector::Constant(1, 5.0);
  p.outputs.resize(1);
  p.disturbances.resize(1);
  if (change) change(p.outputs[0]);
  return p;
}

struct Watch {
  explicit Watch(const PlausibilityParams& p) : judge(p, plant()) {}
  Verdict look(double x, double u = 1.0, double q = 2.0, const Foresee& foresee = {}) {
    Measurement m;
    m.outputs = Vector::Constant(1, x);
    m.disturbances = Vector::Constant(1, q);
    m.input_applied = Vector::Constant(1, u);
    return judge.look(m, foresee);
  }
  SignalValidator judge;
};

TEST(SignalValidator, AsksNothingByItselfButNumbers) {
  Watch watch{PlausibilityParams{}};
  EXPECT_EQ(watch.look(1e9), Verdict::kClean);
  EXPECT_EQ(watch.look(-1e9), Verdict::kClean);
  EXPECT_EQ(watch.look(kNaN), Verdict::kHold);
  EXPECT_EQ(watch.judge.notice().code, EventCode::kSignalMissing);
  EXPECT_STREQ(watch.judge.notice().signal, "x");
}

TEST(SignalValidator, AValueThatIsMissingForAReasonIsCalledByIt) {
  Watch watch(params());
  EXPECT_EQ(watch.look(noValue(NoValue::kStale)), Verdict::kHold);
  EXPECT_EQ(watch.judge.notice().code, EventCode::kSignalMissing);
  EXPECT_STREQ(watch.judge.notice().signal, "x");
  EXPECT_EQ(watch.look(noValue(NoValue::kMissing)), Verdict::kHold);
  EXPECT_EQ(watch.judge.notice().code, EventCode::kSignalMissing);
  EXPECT_STREQ(watch.judge.notice().signal, "x");
}

TEST(SignalValidator, RangeHoldsThenFallsBackAndReturnsAtOnce) {
  Watch watch(params([](SignalPlausibility& s) { s.upper = 110.0; }));
  EXPECT_EQ(watch.look(110.0), Verdict::kClean);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(watch.look(110.1), Verdict::kHold);
  EXPECT_EQ(watch.judge.notice().code, EventCode::kSignalOutOfRange);
  EXPECT_STREQ(watch.judge.notice().signal, "x");
  EXPECT_EQ(watch.look(110.1), Verdict::kFallback);
  EXPECT_EQ(watch.judge.notice().code, EventCode::kSignalOutOfRange);
  EXPECT_STREQ(watch.judge.notice().signal, "x");
  EXPECT_EQ(watch.look(100.0), Verdict::kClean);
  EXPECT_EQ(watch.judge.notice().code, EventCode::kNone);
}

TEST(SignalValidator, ASignalThatTheLawDoesNotNeedHoldsNothing) {
  Watch watch(params());
  watch.judge.need(1, false);
  EXPECT_EQ(watch.look(1.0, 1.0, 7.0), Verdict::kClean);
  for (int k = 0; k < 10; ++k) EXPECT_EQ(watch.look(1.0, 1.0, kNaN), Verdict::kRepaired);
  EXPECT_EQ(watch.judge.accepted().disturbances[0], 7.0);
  EXPECT_EQ(watch.judge.notice().code, EventCode::kSignalMissing);
  EXPECT_STREQ(watch.judge.notice().signal, "q");
}

TEST(SignalValidator, TheRateIsMeasuredFromTheLastAcceptedValue) {
  Watch watch(params([](SignalPlausibility& s) { s.rate_per_h = 10.0; }));  // a sample an hour
  EXPECT_EQ(watch.look(50.0), Verdict::kClean);
  EXPECT_EQ(watch.look(60.0), Verdict::kClean);
  EXPECT_EQ(watch.look(75.0), Verdict::kHold);
  EXPECT_EQ(watch.judge.doubt(0), Doubt::kRate);
  EXPECT_EQ(watch.look(75.0), Verdict::kClean);  // 15 in two hours can be true
}

TEST(SignalValidator, AJumpIsAcceptedOnceItStays) {
  Watch watch(params([](SignalPlausibility& s) { s.jump = 20.0; }));
  EXPECT_EQ(watch.look(50.0), Verdict::kClean);
  EXPECT_EQ(watch.look(90.0), Verdict::kHold);
  EXPECT_EQ(watch.look(52.0), Verdict::kClean);  // it was a spike
  EXPECT_EQ(watch.look(90.0), Verdict::kHold);
  EXPECT_EQ(watch.look(91.0), Verdict::kHold);
  EXPECT_EQ(watch.judge.doubt(0), Doubt::kJump);
  EXPECT_EQ(watch.look(92.0), Verdict::kClean);  // the third sample there
  EXPECT_EQ(watch.look(93.0), Verdict::kClean);
}

Foresee expecting(double x) {
  return [x](Eigen::Ref<Vector> outputs) {
    outputs[0] = x;
    return true;
  };
}

TEST(SignalValidator, AShortGapIsBridgedByWhatTheLawExpects) {
  PlausibilityParams asked = params();
  asked.hold_samples = 10;
  asked.bridge_samples = 2;
  Watch watch(asked);
  EXPECT_EQ(watch.look(kNaN, 1.0, 2.0, expecting(7.0)), Verdict::kRepaired);
  EXPECT_EQ(watch.judge.accepted().outputs[0], 7.0);
  EXPECT_EQ(watch.look(50.0, 1.0, 2.0, expecting(7.0)), Verdict::kClean);
  EXPECT_EQ(watch.judge.accepted().outputs[0], 50.0);
  EXPECT_EQ(watch.look(kNaN), Verdict::kRepaired);  // nothing is expected
  EXPECT_EQ(watch.judge.accepted().outputs[0], 50.0);
  EXPECT_EQ(watch.judge.notice().code, EventCode::kSignalMissing);
  EXPECT_STREQ(watch.judge.notice().signal, "x");
  EXPECT_EQ(watch.look(kNaN, 1.0, kNaN, expecting(8.0)), Verdict::kRepaired);
  EXPECT_EQ(watch.judge.accepted().outputs[0], 8.0);
  EXPECT_EQ(watch.judge.accepted().disturbances[0], 2.0);
  EXPECT_EQ(watch.look(kNaN, 1.0, 2.0, expecting(9.0)), Verdict::kHold);  // a long one
}

TEST(SignalValidator, TheLastGoodValueOrTheModelsTakesItsPlace) {
  Watch good(params([](SignalPlausibility& s) {
    s.upper = 100.0;
    s.substitute = Substitute::kLastGood;
  }));
  EXPECT_EQ(good.look(1000.0), Verdict::kHold);  // there is none yet
  good.look(50.0);
  EXPECT_EQ(good.look(1000.0), Verdict::kRepaired);
  EXPECT_EQ(good.judge.accepted().outputs[0], 50.0);
  EXPECT_EQ(good.judge.notice().code, EventCode::kSignalOutOfRange);
  EXPECT_STREQ(good.judge.notice().signal, "x");

  Watch model(params([](SignalPlausibility& s) {
    s.upper = 100.0;
    s.substitute = Substitute::kModel;
  }));
  model.look(50.0);
  EXPECT_EQ(model.look(1000.0, 1.0, 2.0, expecting(58.0)), Verdict::kRepaired);
  EXPECT_EQ(model.judge.accepted().outputs[0], 58.0);
  EXPECT_EQ(model.judge.notice().code, EventCode::kSignalOutOfRange);
  EXPECT_STREQ(model.judge.notice().signal, "x");
  for (int k = 0; k < 2; ++k) EXPECT_EQ(model.look(1000.0), Verdict::kRepaired);
  EXPECT_EQ(model.look(1000.0), Verdict::kFallback);  // nor for ever
}

/// Frozen is judged by the signal's own noise.
PlausibilityParams byNoise() {
  PlausibilityParams p = params([](SignalPlausibility& s) {
    s.frozen = true;
    s.scale_lower = 0.0;
    s.scale_upper = 100.0;
  });
  p.disturbances[0] = p.outputs[0];
  p.disturbances[0].scale_upper = 10.0;
  return p;
}

TEST(SignalValidator, AnOutputWithoutItsNoiseIsFrozenAndTheModelsValueIsUsed) {
  std::mt19937_64 engine(1);
  std::normal_distribution<double> noise;
  Watch watch(byNoise());
  for (int k = 0; k < 200; ++k)
    EXPECT_EQ(watch.look(50.0 + noise(engine), 1.0, 5.0 + 0.1 * noise(engine)), Verdict::kClean);
  int after = 0;
  for (; after < 20 && watch.judge.doubt(0) != Doubt::kFrozen; ++after) {
    watch.look(50.5, 1.0, 5.0 + 0.1 * noise(engine), expecting(7.0));
  }
  EXPECT_LE(after, 8);
  EXPECT_EQ(watch.judge.doubt(0), Doubt::kFrozen);
  EXPECT_EQ(watch.judge.accepted().outputs[0], 7.0);
  EXPECT_EQ(watch.judge.notice().code, EventCode::kSignalFrozen);
  EXPECT_STREQ(watch.judge.notice().signal, "x");
  EXPECT_EQ(watch.look(50.5, 1.0, 5.0), Verdict::kHold) << "nothing was foreseen";
  EXPECT_EQ(watch.look(50.4, 1.0, 5.1), Verdict::kClean) << "it moves again";
}

TEST(SignalValidator, ADisturbanceWithoutItsNoiseIsSaidAndTheLawGoesOn) {
  std::mt19937_64 engine(2);
  std::normal_distribution<double> noise;
  Watch watch(byNoise());
  for (int k = 0; k < 200; ++k) watch.look(50.0 + noise(engine), 1.0, 5.0 + 0.1 * noise(engine));
  for (int k = 0; k < 30; ++k) watch.look(50.0 + noise(engine), 1.0, 5.0);
  EXPECT_EQ(watch.judge.doubt(1), Doubt::kFrozen);
  EXPECT_EQ(watch.look(50.0 + noise(engine), 1.0, 5.0), Verdict::kRepaired) << "for ever";
  EXPECT_EQ(watch.judge.notice().code, EventCode::kSignalFrozen);
  EXPECT_STREQ(watch.judge.notice().signal, "q");
}

TEST(SignalValidator, AReadingThatComesTwiceInMotionIsBridged) {
  PlausibilityParams p = byNoise();
  p.outputs[0].repeated = true;
  p.bridge_samples = 3;
  Watch watch(p);
  const auto motion = [](int k) { return 50.0 + 5.0 * std::sin(0.05 * k); };
  for (int k = 0; k < 130; ++k) EXPECT_EQ(watch.look(motion(k)), Verdict::kClean) << k;
  EXPECT_EQ(watch.look(motion(129), 1.0, 2.0, expecting(51.0)), Verdict::kRepaired);
  EXPECT_EQ(watch.judge.accepted().outputs[0], 51.0);
  EXPECT_EQ(watch.judge.notice().code, EventCode::kSignalNotRenewed);
  EXPECT_STREQ(watch.judge.notice().signal, "x");
  EXPECT_EQ(watch.look(motion(131)), Verdict::kClean);
}

TEST(SignalValidator, AtTheEndOfItsScaleNothingIsFrozen) {
  std::mt19937_64 engine(3);
  std::normal_distribution<double> noise;
  Watch watch(byNoise());
  for (int k = 0; k < 200; ++k) watch.look(95.0 + noise(engine), 1.0, 5.0 + 0.1 * noise(engine));
  for (int k = 0; k < 200; ++k)
    EXPECT_EQ(watch.look(100.0, 1.0, 5.0 + 0.1 * noise(engine)), Verdict::kClean);
}

// Without noise there is nothing to tell a frozen signal by, whatever its inputs do.
TEST(SignalValidator, ASignalWithoutNoiseIsNeverFrozen) {
  Watch watch(byNoise());
  double x = 50.0;
  for (int k = 0; k < 300; ++k) {
    const double u = k < 100 ? 10.0 : 2.0;
    EXPECT_EQ(watch.look(x, u), Verdict::kClean) << k;
    if (k < 150) x = 0.9 * x + 0.5 * u;  // then it stands
  }
}

// A pump that rests between its two speeds, and a flow that a weir limits.
TEST(SignalValidator, ADisturbanceAtALimitOfItsOwnIsNotFrozen) {
  std::mt19937_64 engine(4);
  std::normal_distribution<double> noise;
  for (const double limit : {4.5, 5.5}) {
    Watch watch(byNoise());
    const auto flow = [&] {
      const double q = 5.0 + 0.3 * noise(engine);
      return limit < 5.0 ? std::max(limit, q) : std::min(limit, q);
    };
    for (int k = 0; k < 200; ++k)
      EXPECT_EQ(watch.look(50.0 + noise(engine), 1.0, flow()), Verdict::kClean) << limit;
    for (int k = 0; k < 200; ++k)
      EXPECT_EQ(watch.look(50.0 + noise(engine), 1.0, limit), Verdict::kClean) << limit;
  }
}

TEST(SignalValidator, AValueOutsideItsRangeMovesNothingUnlessAFallbackIsAskedFor) {
  PlausibilityParams p = params([](SignalPlausibility& s) { s.upper = 110.0; });
  p.range_falls = false;
  Watch watch(p);
  watch.look(100.0);
  for (int k = 0; k < 30; ++k) EXPECT_EQ(watch.look(111.0), Verdict::kHold);
  EXPECT_EQ(watch.judge.notice().code, EventCode::kSignalOutOfRange);
  EXPECT_STREQ(watch.judge.notice().signal, "x");
  for (int k = 0; k < 3; ++k) watch.look(kNaN);
  EXPECT_EQ(watch.look(kNaN), Verdict::kFallback) << "what is not measured at all";
}

TEST(SignalValidator, ANewRunForgetsThePast) {
  Watch watch(params([](SignalPlausibility& s) { s.jump = 20.0; }));
  watch.look(50.0);
  watch.judge.reset();
  EXPECT_EQ(watch.look(90.0), Verdict::kClean);
}

TEST(SignalValidator, RefusesWhatMakesNoSense) {
  EXPECT_THROW(SignalValidator(params([](SignalPlausibility& s) { s.jump = 0.0; }), plant()),
               InputError);
  PlausibilityParams p = params();
  p.fallback = Vector::Zero(2);
  EXPECT_THROW(SignalValidator(p, plant()), InputError);
}

}  // namespace supervision_signal_validator_test
}  // namespace fpc
