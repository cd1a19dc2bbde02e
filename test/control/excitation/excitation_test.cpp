// Excitation signals sample by sample: levels, hold times, streams that do not depend on each
// other, limits, and mistakes named.
#include "control/excitation/excitation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "fmbpc/base/input_error.hpp"
#include "runtime/session.hpp"

namespace fpc {
namespace control_excitation_excitation_test {

ExcitationSignal prbs(int input) {
  ExcitationSignal signal;
  signal.input = input;
  signal.signal = ExcitationKind::kPrbs;
  signal.lower = 200.0;
  signal.upper = 800.0;
  signal.clock_steps = 3;
  return signal;
}

ExcitationSignal multiLevel(int input) {
  ExcitationSignal signal;
  signal.input = input;
  signal.signal = ExcitationKind::kMultiLevel;
  signal.lower = 200.0;
  signal.upper = 800.0;
  signal.hold_lower_steps = 4;
  signal.hold_upper_steps = 9;
  return signal;
}

std::vector<double> played(const ExcitationSignal& signal, std::uint64_t seed,
                           std::uint32_t count) {
  ExcitationStream stream(signal, seed, 570.0);
  std::vector<double> values;
  for (std::uint32_t k = 0; k < count; ++k) values.push_back(stream.at(k));
  return values;
}

TEST(ExcitationStream, PrbsHoldsEachBitForItsClockAndRepeatsAfterThePeriod) {
  const auto u = played(prbs(0), 1, 3 * 1023 * 2);
  double high = 0;
  for (std::size_t k = 0; k < u.size(); ++k) {
    EXPECT_TRUE(u[k] == 200.0 || u[k] == 800.0);
    EXPECT_EQ(u[k], u[k - k % 3]);
    EXPECT_EQ(u[k], u[(k + 3 * 1023) % u.size()]);
    if (k < 3 * 1023) high += u[k] == 800.0 ? 1.0 : 0.0;
  }
  EXPECT_EQ(high, 3.0 * 512.0);
}

TEST(ExcitationStream, LevelsAndHoldTimesAreUniformInsideTheirLimits) {
  const auto u = played(multiLevel(0), 1, 200000);
  std::vector<double> holds(10, 0.0);
  double count = 0.0, sum = 0.0, lowest = 1e9, highest = -1e9;
  std::size_t begin = 0;
  for (std::size_t k = 1; k < u.size(); ++k) {
    if (u[k] == u[k - 1]) continue;
    ASSERT_GE(k - begin, 4U);
    ASSERT_LE(k - begin, 9U);
    holds[k - begin] += 1.0;
    count += 1.0;
    sum += u[k];
    lowest = std::min(lowest, u[k]);
    highest = std::max(highest, u[k]);
    begin = k;
  }
  // five standard errors of the mean of a uniform number and of a share of one sixth
  EXPECT_NEAR(sum / count, 500.0, 5.0 * 600.0 / std::sqrt(12.0 * count));
  for (std::size_t hold = 4; hold <= 9; ++hold)
    EXPECT_NEAR(holds[hold] / count, 1.0 / 6.0, 5.0 * std::sqrt(5.0 / 36.0 / count)) << hold;
  EXPECT_GE(lowest, 200.0);
  EXPECT_LE(highest, 800.0);
  EXPECT_LT(lowest, 202.0);
  EXPECT_GT(highest, 798.0);
}

TEST(ExcitationStream, ListedLevelsAllComeAndNoOther) {
  ExcitationSignal signal = multiLevel(0);
  signal.levels = {1.0, 20.0, 300.0};
  const auto u = played(signal, 1, 1000);
  EXPECT_EQ(std::set<double>(u.begin(), u.end()), (std::set<double>{1.0, 20.0, 300.0}));
}

TEST(ExcitationStream, AStaircaseCountsFromTheStart) {
  ExcitationSignal signal;
  signal.signal = ExcitationKind::kSteps;
  signal.schedule = {{1, 300.0}, {3, 400.0}};
  EXPECT_EQ(played(signal, 1, 5), (std::vector<double>{570.0, 300.0, 300.0, 400.0, 400.0}));
  signal.schedule = {{0, 300.0}};
  EXPECT_EQ(played(signal, 1, 2), (std::vector<double>{300.0, 300.0}));
}

TEST(ExcitationStream, NoneStaysAtTheStartInput) {
  EXPECT_EQ(played(ExcitationSignal{}, 1, 50), std::vector<double>(50, 570.0));
}

TEST(ExcitationStream, DependsOnSeedInputAndSampleOnly) {
  for (const auto& make : {prbs, multiLevel}) {
    EXPECT_EQ(played(make(0), 7, 500), played(make(0), 7, 500));
    EXPECT_NE(played(make(0), 7, 500), played(make(0), 8, 500));
    EXPECT_NE(played(make(0), 7, 500), played(make(1), 7, 500));
    const auto u = played(make(0), 7, 500);
    ExcitationStream jumping(make(0), 7, 570.0);
    for (const std::uint32_t k : {400U, 3U, 3U, 499U, 0U, 250U}) EXPECT_EQ(jumping.at(k), u[k]);
  }
}

TEST(ExcitationStream, StreamsOfTwoInputsAreNotCorrelated) {
  constexpr std::uint32_t kCount = 90000;
  ExcitationSignal first = multiLevel(0), second = multiLevel(1);
  first.hold_upper_steps = second.hold_upper_steps = 4;
  const auto a = played(first, 3, kCount), b = played(second, 3, kCount);
  double product = 0.0;
  for (std::size_t k = 0; k < kCount; k += 4) product += (a[k] - 500.0) * (b[k] - 500.0);
  const double variance = 600.0 * 600.0 / 12.0, count = kCount / 4.0;
  EXPECT_NEAR(product / count / variance, 0.0, 5.0 / std::sqrt(count));
}

PlantInfo twoInputs() {
  PlantInfo info;
  info.header.time_ns = 1000000000;
  info.sample_time_s = 720.0;
  info.outputs = {{"y", "", 0.0, 1.0}};
  info.inputs = {{"u", "", 0.0, 1000.0}, {"v", "", 0.0, 1000.0}};
  return info;
}

InputLimits limits(double move) {
  return {Vector::Zero(2), Vector::Constant(2, 1000.0), Vector::Constant(2, move)};
}

ControllerSession session(const std::vector<ExcitationSignal>& signals, double move = kInfinity,
                          const std::vector<ExcitationFeedback>& feedback = {}) {
  ExcitationParams params;
  params.signals = signals;
  params.feedback = feedback;
  SetpointParams setpoint;
  setpoint.initial = Vector::Constant(1, 5.0);
  const Vector start = Vector::Constant(2, 570.0);
  return {std::make_unique<ExcitationController>(params, limits(move), start, twoInputs()),
          setpoint, limits(move), start, twoInputs()};
}

Measurement sample(std::uint32_t step, const Vector& applied) {
  return {{1000000000 + step * 720000000000, 1, step},
          Vector::Constant(1, 0.5),
          Vector(),
          applied,
          false};
}

TEST(ExcitationController, BitsOfAnInputDoNotDependOnTheOthers) {
  auto alone = session({multiLevel(1)}), together = session({prbs(0), multiLevel(1)});
  const Vector start = Vector::Constant(2, 570.0);
  for (std::uint32_t k = 0; k < 200; ++k) {
    alone.receive(sample(k, start));
    together.receive(sample(k, start));
    EXPECT_EQ(alone.answer().base.input[1], together.answer().base.input[1]);
    EXPECT_EQ(alone.answer().base.input[0], 570.0);
  }
}

TEST(ExcitationController, WalksToItsLevelWithinTheMoveLimitAndSaysClipped) {
  auto walking = session({prbs(0), multiLevel(1)}, 70.0);
  Vector before = Vector::Constant(2, 570.0);
  int clipped = 0;
  for (std::uint32_t k = 0; k < 500; ++k) {
    walking.receive(sample(k, before));
    const ControlAction& action = walking.answer().base;
    EXPECT_LE((action.input - before).cwiseAbs().maxCoeff(), 70.0 + 1e-9);
    EXPECT_GE(action.input.minCoeff(), 200.0);
    EXPECT_LE(action.input.maxCoeff(), 800.0);
    clipped += action.source == ActionSource::kClipped ? 1 : 0;
    before = action.input;
  }
  EXPECT_GT(clipped, 100);
}

TEST(ExcitationController, AfterManualAndGapsTheSignalIsWhereItWouldHaveBeen) {
  auto plain = session({prbs(0)}), disturbed = session({prbs(0)});
  const Vector start = Vector::Constant(2, 570.0);
  for (std::uint32_t k = 0; k < 60; ++k) {
    plain.receive(sample(k, start));
    disturbed.manual(k >= 10 && k < 20);
    if (k >= 30 && k < 40) continue;
    disturbed.receive(sample(k, start));
    const bool same = disturbed.answer().base.input == plain.answer().base.input;
    EXPECT_TRUE(same || (k >= 10 && k < 20)) << k;
  }
}

// The setpoint is 5, y is 0.5: 4.5 times the gain.
TEST(ExcitationController, FeedbackAddsItsShareToSignalsAndStillInputs) {
  auto plain = session({multiLevel(1)}),
       fed = session({multiLevel(1)}, kInfinity, {{1, 0, 2.0}, {0, 0, -10.0}, {0, 0, 3.0}});
  const Vector start = Vector::Constant(2, 570.0);
  for (std::uint32_t k = 0; k < 100; ++k) {
    plain.receive(sample(k, start));
    fed.receive(sample(k, start));
    EXPECT_EQ(fed.answer().base.input[1], plain.answer().base.input[1] + 9.0);
    EXPECT_EQ(fed.answer().base.input[0], 570.0 - 31.5);
  }
  EXPECT_EQ(fed.answer().tracking.setpoint[0], 5.0);
  EXPECT_EQ(fed.answer().tracking.reference[0], 5.0);
}

TEST(ExcitationController, FeedbackEndsAtTheLimits) {
  auto fed = session({prbs(0)}, kInfinity, {{0, 0, 1e6}});
  fed.receive(sample(0, Vector::Constant(2, 570.0)));
  EXPECT_EQ(fed.answer().base.input[0], 1000.0);
  EXPECT_EQ(fed.answer().base.source, ActionSource::kClipped);
}

TEST(ExcitationController, FollowsNothing) {
  auto open = session({prbs(0)});
  open.receive(sample(0, Vector::Constant(2, 570.0)));
  EXPECT_TRUE(std::isnan(open.answer().tracking.setpoint[0]));
  EXPECT_TRUE(std::isnan(open.answer().tracking.reference[0]));
  EXPECT_EQ(open.answer().base.source, ActionSource::kBase);
}

TEST(ExcitationParams, MistakesNameTheField) {
  const auto errorOf = [](const ExcitationSignal& signal) -> std::string {
    ExcitationParams params;
    params.signals = {signal};
    try {
      params.validate(limits(kInfinity), 1);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(errorOf(prbs(0)), "");
  EXPECT_NE(errorOf(prbs(2)).find("signals[0].input"), std::string::npos);
  ExcitationSignal beyond = prbs(0);
  beyond.upper = 1000.5;
  EXPECT_NE(errorOf(beyond).find("signals[0].range"), std::string::npos);
  ExcitationSignal holds = multiLevel(0);
  holds.hold_upper_steps = 3;
  EXPECT_NE(errorOf(holds).find("signals[0].hold_s"), std::string::npos);
  ExcitationSignal nan = multiLevel(0);
  nan.levels = {300.0, std::nan("")};
  EXPECT_NE(errorOf(nan).find("signals[0].levels"), std::string::npos);
  ExcitationParams twice;
  twice.signals = {prbs(0), multiLevel(0)};
  EXPECT_THROW(twice.validate(limits(kInfinity), 1), InputError);
  EXPECT_THROW(ExcitationParams{}.validate(limits(kInfinity), 1), InputError);
  ExcitationParams fed;
  fed.signals = {prbs(0)};
  fed.feedback = {{1, 0, 2.0}};
  EXPECT_NO_THROW(fed.validate(limits(kInfinity), 1));
  for (const auto& wrong : {ExcitationFeedback{2, 0, 2.0}, ExcitationFeedback{1, 1, 2.0},
                            ExcitationFeedback{1, 0, std::nan("")}}) {
    fed.feedback = {wrong};
    EXPECT_THROW(fed.validate(limits(kInfinity), 1), InputError);
  }
}

}  // namespace control_excitation_excitation_test
}  // namespace fpc
