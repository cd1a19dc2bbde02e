// A watch over sensors around a law of which everything is known: who stands still, when it is
// noticed, what is sent meanwhile, and how the law comes back.
#include "supervision/standstill.hpp"

#include <cmath>
#include <random>

#include "control/pi/pi.hpp"
#include "runtime/session_fixture.hpp"

namespace fpc::test_session {
namespace control_standstill_test {

constexpr int kWindow = 5;

class Standstill : public testing::Test {
 protected:
  void SetUp() override { make(params()); }
  static StandstillParams params() {
    StandstillParams p;
    p.signals = {{"s", true, 0, 0.5}, {"q_i", false, 0, 1.0}};
    p.window_samples = kWindow;
    p.usual = of({1300.0, 40.0});
    p.fallback = of({800.0});
    return p;
  }
  void make(StandstillParams p, double move = kInfinity,
            std::unique_ptr<Controller> fallback = nullptr) {
    auto owned = std::make_unique<FakeLaw>();
    law = owned.get();
    PlantInfo info = plant();
    info.disturbances.push_back({"s_i", "mg/l", 0, 100});
    watch = std::make_unique<StandstillWatch>(std::move(owned), std::move(fallback), std::move(p),
                                              limits(move), info);
    watch->reset(sample(0));
  }
  /// One sample with these values; x never moves.
  const ControllerOutput& see(double s, double q_i, double s_i = 40.0) {
    Measurement m = sample(step++, 1, applied);
    m.outputs[0] = s;
    m.disturbances = of({q_i, s_i});
    SetpointSource source(setpoints(), {"s", "x"}, SampleClock(720.0, 1234.5));
    output.events.clear();
    watch->step(m, source, output);
    applied = output.input[0];
    return output;
  }
  bool frozen(const std::string& signal) const {
    return output.events.has(EventCode::kSignalFrozen) && output.events.begin()->signal == signal;
  }
  bool silent() const { return output.events.empty(); }

  FakeLaw* law{};
  std::unique_ptr<StandstillWatch> watch;
  ControllerOutput output;
  std::uint32_t step{};
  double applied{570.0};
};

TEST_F(Standstill, WhatMovesPassesUntouched) {
  for (int k = 0; k < 40; ++k) {
    const double before = applied;
    see(56.0 + 3.0 * std::sin(0.5 * k), 1300.0 + 200.0 * std::sin(0.3 * k));
    EXPECT_EQ(output.input[0], before + 1.0);
    EXPECT_TRUE(output.predictive);
    EXPECT_TRUE(silent());
  }
}

TEST_F(Standstill, APlantAtRestIsNoFault) {
  for (int k = 0; k < 40; ++k)
    see(56.0 + 20.0 * std::exp(-k), 1300.0);  // a start under constant load
  EXPECT_EQ(law->steps.size(), 40U);
  EXPECT_TRUE(silent());
}

TEST_F(Standstill, AnOutputThatStandsWhileTheLoadMovesBringsTheFallback) {
  for (int k = 0; k < 3; ++k) see(56.0 + k, 1300.0 + 200.0 * std::sin(k));
  for (int k = 0; k < kWindow - 1; ++k) see(58.0, 1300.0 + 200.0 * std::sin(k));
  EXPECT_EQ(output.source, ActionSource::kFallback);
  EXPECT_EQ(output.input[0], 800.0);
  EXPECT_FALSE(output.predictive);
  EXPECT_TRUE(frozen("s"));
  const std::size_t steps = law->steps.size();
  for (int k = 0; k < 100; ++k) see(58.0, 1300.0);  // nothing moves: no reason to trust it again
  EXPECT_EQ(law->steps.size(), steps);
  see(58.6, 1300.0);
  EXPECT_EQ(output.source, ActionSource::kBase);
  EXPECT_EQ(output.input[0], 801.0) << "goes on from the applied input";
  EXPECT_EQ(law->resets.back(), step - 1);
  EXPECT_TRUE(silent());
}

TEST_F(Standstill, ADisturbanceThatStandsIsReplacedByItsUsualValue) {
  double seen = 0.0;
  law->spoil = [&](ControllerOutput&) { seen += 1.0; };
  for (int k = 0; k < 20; ++k) see(56.0 + 10.0 * std::sin(k), 0.0, 40.0 + 10.0 * std::sin(k));
  EXPECT_EQ(seen, 20.0) << "the law goes on";
  EXPECT_EQ(output.source, ActionSource::kBase);
  EXPECT_TRUE(frozen("q_i"));
}

/// 800, and 2000 more at twice the usual flow: it does not look at the output.
std::unique_ptr<Controller> byFlow(const InputLimits& limits, const PlantInfo& plant) {
  PiLoop loop;
  loop.bias = 800.0;
  loop.terms.feedforward.push_back({0, 2000.0 / 1300.0, 1300.0, 0.0, -1});
  PiParams params;
  params.loops.push_back(loop);
  return std::make_unique<PiController>(params, limits, plant);
}

TEST_F(Standstill, TheFallbackKeepsLimitsAndFollowsTheFlow) {
  make(params(), 100.0, byFlow(limits(100.0), plant()));
  const auto q_i = [](int k) { return k % 2 == 0 ? 1300.0 : 1560.0; };
  for (int k = 0; k < kWindow; ++k) see(58.0, q_i(k));
  double before = applied;
  for (int k = 0; k < 40; ++k) {
    see(58.0, q_i(k));
    EXPECT_LE(std::abs(output.input[0] - before), 100.0 + 1e-9);
    EXPECT_LE(output.input[0], 1600.0);
    before = output.input[0];
  }
  EXPECT_EQ(output.source, ActionSource::kFallback);
  make(params(), kInfinity, byFlow(limits(kInfinity), plant()));
  for (int k = 0; k < kWindow + 1; ++k) see(58.0, q_i(k));
  EXPECT_NEAR(output.input[0], 800.0 + 2000.0 * 0.2 * (kWindow % 2), 1e-9);
  see(58.0, q_i(kWindow + 1));
  EXPECT_NEAR(output.input[0], 800.0, 1e-9);
}

TEST_F(Standstill, TheFallbackBeginsAnewEachTime) {
  auto other = std::make_unique<FakeLaw>();
  FakeLaw* const fallback = other.get();
  make(params(), kInfinity, std::move(other));
  const std::size_t before = fallback->resets.size();
  for (const double s : {58.0, 63.0}) {
    for (int k = 0; k < kWindow + 3; ++k) see(s, 1300.0 + 200.0 * std::sin(k));
    EXPECT_EQ(output.source, ActionSource::kFallback);
    EXPECT_TRUE(frozen("s"));
  }
  ASSERT_EQ(fallback->resets.size(), before + 2);
  EXPECT_EQ(fallback->resets.back(), 0U) << "as at a start";
}

TEST_F(Standstill, AFallbackWithoutAnAnswerHoldsTheInput) {
  auto lost = std::make_unique<FakeLaw>();
  lost->spoil = [](ControllerOutput& o) { o.ok = false; };
  make(params(), kInfinity, std::move(lost));
  double held = applied;
  for (int k = 0; k < kWindow + 3; ++k) {
    see(58.0, 1300.0 + 200.0 * std::sin(k));
    if (output.source != ActionSource::kFallback) held = applied;
  }
  EXPECT_EQ(output.source, ActionSource::kFallback);
  EXPECT_EQ(output.input[0], held);
}

/// Watched with noise of these standard deviations, over 32 samples.
StandstillParams noisy(StandstillParams p, double s, double q_i) {
  p.signals[0].least_change = p.signals[1].least_change = 1e-6;
  p.signals[0].noise_std = s;
  p.signals[1].noise_std = q_i;
  p.noise_window_samples = 32;
  return p;
}

TEST_F(Standstill, NoiseDoesNotHideASensorThatStands) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 engine(seed);
    std::normal_distribution<double> noise(0.0, 0.3);
    make(noisy(params(), 0.3, 0.0));
    const auto load = [](int k) { return 1300.0 + 400.0 * std::sin(0.2 * k); };
    for (int k = 0; k < 40; ++k) {
      see(56.0 + 3.0 * std::sin(0.2 * k - 1.0) + noise(engine), load(k));
      ASSERT_TRUE(silent()) << "seed " << seed << " sample " << k;
    }
    int first = -1;
    for (int k = 0; k < 200; ++k) {
      see(57.0 + noise(engine), load(k));
      if (first < 0 && output.source == ActionSource::kFallback) first = k;
      ASSERT_EQ(frozen("s"), first >= 0) << "seed " << seed;
    }
    EXPECT_GE(first, 8) << "seed " << seed;
    EXPECT_LE(first, 40) << "seed " << seed;
    see(61.0 + noise(engine), load(0));
    EXPECT_EQ(output.source, ActionSource::kBase) << "it moves again";
  }
}

TEST_F(Standstill, LessNoiseThanDeclaredIsNoSignOfLife) {
  make(noisy(params(), 0.3, 0.0));
  for (int k = 0; k < 40; ++k)
    see(57.0 + 0.01 * std::cos(3.0 * k), 1300.0 + 400.0 * std::sin(0.2 * k));
  EXPECT_TRUE(frozen("s"));
}

TEST_F(Standstill, NoiseOnAPlantAtRestIsNoFault) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 engine(seed);
    std::normal_distribution<double> noise(0.0, 1.0);
    make(noisy(params(), 0.3, 200.0));
    law->spoil = [&](ControllerOutput& out) { out.input[0] = 570.0 + 200.0 * noise(engine); };
    for (int k = 0; k < 300; ++k) {
      see(56.0 + 0.3 * noise(engine), 1300.0 + 200.0 * noise(engine), 40.0);
      ASSERT_TRUE(silent()) << "seed " << seed << " sample " << k;
    }
  }
}

// A law that holds its output well moves its input, and follows the noise.
TEST_F(Standstill, AnInputThatMovesIsNoEvidenceUnderNoise) {
  std::mt19937_64 engine(3);
  std::normal_distribution<double> noise(0.0, 1.0);
  make(noisy(params(), 0.3, 20.0));
  law->spoil = [&](ControllerOutput& out) { out.input[0] = 800.0 + 500.0 * std::sin(0.1 * step); };
  for (int k = 0; k < 300; ++k) {
    see(56.0 + 0.3 * noise(engine), 1300.0 + 20.0 * noise(engine), 40.0);
    ASSERT_TRUE(silent()) << k;
  }
}

TEST_F(Standstill, ANoisyDisturbanceThatStandsIsReplaced) {
  std::mt19937_64 engine(7);
  std::normal_distribution<double> noise(0.0, 1.0);
  make(noisy(params(), 0.3, 20.0));
  for (int k = 0; k < 80; ++k)
    see(56.0 + 10.0 * std::sin(0.2 * k), 900.0 + 20.0 * noise(engine),
        40.0 + 20.0 * std::sin(0.2 * k));
  EXPECT_TRUE(frozen("q_i"));
  EXPECT_EQ(output.source, ActionSource::kBase);
}

// A flow that a weir or a pump limits stands there for hours and is right.
TEST_F(Standstill, AFlowAtItsLimitIsNoFault) {
  const auto load = [](int k) { return 40.0 + 20.0 * std::sin(0.2 * k); };
  for (int k = 0; k < 100; ++k)
    see(56.0 + 3.0 * std::sin(k), std::min(1300.0 + 400.0 * std::sin(0.05 * k), 1600.0), load(k));
  for (int k = 100; k < 200; ++k) {
    see(56.0 + 3.0 * std::sin(k), 1600.0, load(k));
    ASSERT_TRUE(silent()) << k;
  }
  for (int k = 0; k < 2 * kWindow; ++k) see(56.0 + 3.0 * std::sin(k), 900.0, load(k));
  EXPECT_TRUE(frozen("q_i"));
}

// A healthy signal that was quiet for a window, and whose day is smaller than five standard
// deviations of its noise.
TEST_F(Standstill, ASmallMotionUnderNoiseIsSeenAgain) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 engine(seed);
    std::normal_distribution<double> noise(0.0, 0.3);
    make(noisy(params(), 0.3, 0.0));
    const auto load = [](int k) { return 1300.0 + 400.0 * std::sin(0.2 * k); };
    for (int k = 0; k < 60; ++k) see(57.0 + noise(engine), load(k));
    ASSERT_TRUE(frozen("s")) << seed;
    int back = -1;
    for (int k = 60; k < 160; ++k) {
      see(57.6 + noise(engine), load(k));
      if (back < 0 && output.source == ActionSource::kBase) back = k - 60;
    }
    EXPECT_GE(back, 0) << seed;
    EXPECT_LE(back, 32) << seed;
  }
}

TEST_F(Standstill, MistakesAreNamed) {
  StandstillParams p = params();
  p.fallback = of({1.0, 2.0});
  EXPECT_THROW(make(p), InputError);
  p = params();
  p.signals[0].least_change = 0.0;
  EXPECT_THROW(make(p), InputError);
}

}  // namespace control_standstill_test
}  // namespace fpc::test_session
