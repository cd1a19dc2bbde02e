#include "supervision/actuator_effectiveness.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "identification/model_fixture.hpp"
#include "random/dice.hpp"

namespace fpc {
namespace control_actuator_effectiveness_test {

constexpr int kWindow = 40;

/// y(k+1) = 0.8 y + 0.5 u1(k-1) + 0.2 u2(k).
TsModel model() {
  return test::oneRule(
      test::numbered("u", 2),
      {{SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, 1}, {SignalKind::kInput, 1, 0}},
      Eigen::Vector3d(0.8, 0.5, 0.2));
}

/// The process of that model, with parts of its inputs' moves arriving, and what the watch says.
struct Process {
  double part1{1.0}, part2{1.0}, noise{0.0}, bias{0.0};
  double y{0.0}, before{0.0};
  Dice dice{1};
  Measurement m;

  Process() {
    m.outputs = Vector::Zero(1);
    m.input_applied = Vector::Zero(2);
  }
  /// u1 and u2 are told; sample k + 1.
  const Measurement& step(double u1, double u2) {
    y = 0.8 * y + 0.5 * part1 * before + 0.2 * part2 * u2 + bias;
    before = u1;
    m.input_applied << u1, u2;
    m.outputs[0] = y + noise * (dice.between(-1.0, 1.0));
    return m;
  }
  void live(ActuatorEffectiveness& watch, int samples) {
    for (int k = 0; k < samples; ++k)
      watch.look(step(dice.between(-1.0, 1.0), dice.between(-1.0, 1.0)));
  }
};

TEST(ActuatorEffectiveness, SeesTheWholeReactionOfAProcessThatIsItsModel) {
  ActuatorEffectiveness watch(model(), kWindow);
  Process process;
  watch.look(process.m);
  process.live(watch, kWindow + 1);
  EXPECT_NEAR(watch.share(0), 1.0, 1e-9);
  EXPECT_NEAR(watch.share(1), 1.0, 1e-9);
  EXPECT_EQ(watch.notice().code, EventCode::kNone);
}

TEST(ActuatorEffectiveness, NamesTheInputThatStandsStillAndForgetsItWhenItMoves) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    ActuatorEffectiveness watch(model(), kWindow);
    Process process;
    process.dice = Dice(seed);
    process.noise = 0.02;
    process.live(watch, 2 * kWindow);
    EXPECT_EQ(watch.notice().code, EventCode::kNone) << "seed " << seed;
    process.part1 = 0.0;
    process.live(watch, 2 * kWindow);
    EXPECT_STREQ(watch.notice().signal, "u1") << seed;
    EXPECT_NEAR(watch.share(0), 0.0, 0.2) << seed;
    process.part1 = 1.0;
    process.live(watch, 2 * kWindow);
    EXPECT_EQ(watch.notice().code, EventCode::kNone) << "seed " << seed;
  }
}

TEST(ActuatorEffectiveness, AnInputThatPushesTheOtherWayIsNamedToo) {
  ActuatorEffectiveness watch(model(), kWindow);
  Process process;
  process.part2 = -1.0;
  process.live(watch, 2 * kWindow);
  EXPECT_LT(watch.share(1), -0.5);
  EXPECT_STREQ(watch.notice().signal, "u2");
}

TEST(ActuatorEffectiveness, AGainThatIsOffByAThirdOrDoubleIsNoFault) {
  for (const double part : {0.7, 2.0}) {
    ActuatorEffectiveness watch(model(), kWindow);
    Process process;
    process.part1 = process.part2 = part;
    process.noise = 0.02;
    process.live(watch, 4 * kWindow);
    EXPECT_EQ(watch.notice().code, EventCode::kNone) << part;
  }
}

TEST(ActuatorEffectiveness, NothingIsSaidWithoutMovesNorInNoise) {
  ActuatorEffectiveness watch(model(), kWindow);
  Process process;
  process.part1 = process.part2 = 0.0;
  process.noise = 0.1;
  for (int k = 0; k < 3 * kWindow; ++k) watch.look(process.step(0.3, -0.2));
  EXPECT_EQ(watch.notice().code, EventCode::kNone);
  EXPECT_TRUE(std::isnan(watch.share(0)));
  process.noise = 20.0;
  process.live(watch, 3 * kWindow);
  EXPECT_EQ(watch.notice().code, EventCode::kNone);
}

TEST(ActuatorEffectiveness, ASteadyDisturbanceIsNoFault) {
  ActuatorEffectiveness watch(model(), kWindow);
  Process process;
  process.noise = 0.02;
  process.live(watch, kWindow);
  process.bias = 0.5;
  process.live(watch, 2 * kWindow);
  EXPECT_EQ(watch.notice().code, EventCode::kNone);
}

TEST(ActuatorEffectiveness, AWindowOfFewSamplesIsRefused) {
  EXPECT_THROW(ActuatorEffectiveness(model(), 7), InputError);
}

}  // namespace control_actuator_effectiveness_test
}  // namespace fpc
