// What every type of controller promises, whatever it is: checked on the first shipped loop of each
// registered type.
#include <gtest/gtest.h>
#include <algorithm>

#include <cmath>
#include <cstdio>
#include <random>

#include "allocation_counter.hpp"
#include "config/plugins.hpp"
#include "paths.hpp"
#include "runtime/factory.hpp"
#include "runtime/loops_of_type.hpp"

namespace fpc {
namespace loop_controller_contract_test {

constexpr std::uint32_t kSettle = 30, kRun = 60;  // samples
constexpr double kRounding = 1e-9;                // of an input's range

class ControllerContract : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const auto loops = loopsOfType(GetParam());
    ASSERT_FALSE(loops.empty()) << "a shipped loop with controller.type " << GetParam();
    loop_ = readLoop(loops.front(), withoutRecords(loops.front()));
    ASSERT_GT(loop_.simulation.samples, kRun) << loop_.name;
  }
  ControllerSession makeSession() const {
    ControllerSession session = makeControllerSession(loop_);
    if (session.controller().needsModel()) session.setModel(loop_.model);
    return session;
  }
  const InputLimits& limits() const { return loop_.simulation.actuator.limits; }
  Vector range() const {
    const Vector width = limits().upper - limits().lower;
    return width.unaryExpr([](double w) { return std::isfinite(w) && w > 0.0 ? w : 1.0; });
  }
  double distance(const Vector& a, const Vector& b) const {
    return ((a - b).array() / range().array()).abs().maxCoeff();
  }
  LoopFile loop_;
};

/// Runs the plant under one session; `also` sees every sample before its answer is applied.
template <typename Also>
void run(Simulation& plant, ControllerSession& session, std::uint32_t samples, Also also) {
  while (plant.measurement().header.step < samples) {
    const Measurement& now = plant.measurement();
    ASSERT_EQ(session.receive(now), Receipt::kAnswered);
    also(now);
    plant.advance(session.answer().base.input);
  }
}

TEST_P(ControllerContract, TheObjectIsWhatItsRegistrationSays) {
  const ControllerType& type = controllerType(GetParam());
  EXPECT_FALSE(type.summary.empty());
  ControllerSession session = makeSession();
  EXPECT_EQ(session.controller().needsModel(), type.needs_model);
  EXPECT_EQ(session.controller().followsSetpoint(), !type.open_loop);
  Simulation plant = makeSimulation(loop_);
  plant.reset(1);
  bool predicted = false;
  run(plant, session, 5, [&](const Measurement&) {
    predicted = predicted || session.answer().has_prediction;
    EXPECT_TRUE(session.output().ok);
  });
  EXPECT_EQ(predicted, type.predicts);
}

/// Any value, also far outside of what the sensor can show.
Vector anywhere(const std::vector<SignalInfo>& signals, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> draw(-0.5, 1.5);
  Vector values(static_cast<Eigen::Index>(signals.size()));
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const bool bounded = std::isfinite(signals[i].lower) && std::isfinite(signals[i].upper);
    const double lower = bounded ? signals[i].lower : -1e3,
                 upper = bounded ? signals[i].upper : 1e3;
    values[static_cast<Eigen::Index>(i)] = lower + draw(generator) * (upper - lower);
  }
  return values;
}

TEST_P(ControllerContract, LimitsHoldAtEverySampleWhateverIsMeasured) {
  const bool any_input =
      makeSession().controller().mayBeSent(0.5 * (limits().lower + limits().upper));
  if (any_input) loop_.simulation.actuator.limits.move = 0.1 * range();
  ControllerSession session = makeSession();
  Measurement now = makeSimulation(loop_).measurement();
  now.header.run_id = 1;
  std::mt19937_64 generator(7);
  for (std::uint32_t k = 0; k < kRun; ++k) {
    now.header.step = k;
    now.header.time_ns += 1;
    now.outputs = anywhere(loop_.plant_info.outputs, generator);
    now.disturbances = anywhere(loop_.plant_info.disturbances, generator);
    ASSERT_EQ(session.receive(now), Receipt::kAnswered);
    const Vector& sent = session.answer().base.input;
    ASSERT_TRUE(sent.allFinite()) << k;
    const Vector& given = session.output().ok ? session.output().input : sent;
    const Vector slack = kRounding * range();
    for (const Vector& u : {given, sent}) {  // the law itself, before the session's net; and behind
      EXPECT_TRUE((u.array() >= (limits().lower - slack).array()).all()) << k << ": " << u;
      EXPECT_TRUE((u.array() <= (limits().upper + slack).array()).all()) << k << ": " << u;
      if (!any_input) continue;
      const Vector move = (u - now.input_applied).cwiseAbs();
      EXPECT_TRUE((move.array() <= (limits().move + slack).array()).all()) << k << ": " << move;
    }
    EXPECT_TRUE(session.controller().mayBeSent(sent)) << k << ": " << sent;
    now.input_applied = sent;
  }
}

TEST_P(ControllerContract, MissingDataHoldTheInputAndTheNextSampleGoesOn) {
  loop_.plausibility.bridge_samples = 0;
  ControllerSession session = makeSession();
  Simulation plant = makeSimulation(loop_);
  plant.reset(1);
  run(plant, session, kSettle, [](const Measurement&) {});
  Measurement bad = plant.measurement();
  const auto& needs = loop_.plausibility.needs;
  const auto needed = std::find(needs.begin(), needs.end(), true) - needs.begin();
  ASSERT_LT(needed, bad.outputs.size());
  bad.outputs[needed] = std::nan("");
  ASSERT_EQ(session.receive(bad), Receipt::kAnswered);
  EXPECT_EQ(session.answer().base.input, bad.input_applied);
  EXPECT_EQ(session.answer().base.source, ActionSource::kHeld);
  EXPECT_FALSE(session.answer().has_prediction);
  plant.advance(bad.input_applied);
  ASSERT_EQ(session.receive(plant.measurement()), Receipt::kAnswered);
  EXPECT_EQ(session.resetReason(), "data before were not finite");
  EXPECT_TRUE(session.output().ok);
  for (int missed = 0; missed < 3; ++missed) plant.advance(session.answer().base.input);
  ASSERT_EQ(session.receive(plant.measurement()), Receipt::kAnswered);
  EXPECT_NE(session.resetReason(), "");
  EXPECT_TRUE(session.output().ok);
}

/// An input elsewhere that may be sent: a twentieth of the range away.
Vector moved(const Controller& controller, const InputLimits& limits, const Vector& input) {
  const Vector width = (limits.upper - limits.lower).cwiseMin(1e6);
  Vector other = (input + 0.05 * width).cwiseMin(limits.upper).cwiseMax(limits.lower);
  controller.makeSendable(other);
  return other;
}

/// A person moves the inputs for five samples, beside a twin that sees the same samples and was
/// never interrupted: back from manual the input stays where the person left it, or goes where the
/// twin's goes.
TEST_P(ControllerContract, HandOverFromManualIsBumpless) {
  ControllerSession session = makeSession(), twin = makeSession();
  Simulation plant = makeSimulation(loop_);
  plant.reset(1);
  double bump = 0.0;
  run(plant, session, kSettle + 6, [&](const Measurement& now) {
    const std::uint32_t k = now.header.step;
    ASSERT_EQ(twin.receive(now), Receipt::kAnswered);
    if (k + 1 == kSettle) session.manual(true);
    if (k + 1 == kSettle)
      session.manualInput(moved(session.controller(), limits(), now.input_applied));
    if (k + 1 == kSettle + 5) session.manual(false);
    const Vector& sent = session.answer().base.input;
    if (k == kSettle + 5)
      bump = std::min(distance(sent, now.input_applied), distance(sent, twin.answer().base.input));
  });
  EXPECT_EQ(session.resetReason(), "back from manual");
  std::printf("%s on %s: bump %.3g of the range\n", GetParam().c_str(), loop_.name.c_str(), bump);
  EXPECT_LE(bump, 1e-6);
}

TEST_P(ControllerContract, TheSameSamplesGiveTheSameBits) {
  ControllerSession session = makeSession(), twin = makeSession();
  Simulation plant = makeSimulation(loop_);
  plant.reset(1);
  run(plant, session, kRun, [&](const Measurement& now) {
    twin.receive(now);
    ASSERT_EQ(twin.answer().base.input, session.answer().base.input) << now.header.step;
  });
}

TEST_P(ControllerContract, AStepDoesNotAllocate) {
  if (!testing::AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  ControllerSession session = makeSession();
  Simulation plant = makeSimulation(loop_);
  plant.reset(1);
  run(plant, session, kSettle, [](const Measurement&) {});
  std::size_t allocations = 0;
  for (std::uint32_t k = kSettle; k < kRun; ++k) {
    const Measurement now = plant.measurement();
    testing::AllocationCounter counter;
    session.receive(now);
    allocations += counter.count();
    plant.advance(session.answer().base.input);
  }
  EXPECT_EQ(allocations, 0U);
}

TEST_P(ControllerContract, SettingsAreThoseOfTheTableAndTakingThemAgainMovesNothing) {
  const ControllerType& type = controllerType(GetParam());
  ControllerSession session = makeSession(), twin = makeSession();
  const Settings shown = session.controller().settings();
  ASSERT_EQ(shown.size(), type.settings.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    EXPECT_EQ(shown[i].first, type.settings[i].key);
    EXPECT_FALSE(type.settings[i].description.empty());
  }
  if (shown.empty()) {
    EXPECT_FALSE(session.retune({{"kp", "1"}}));
    return;
  }
  Simulation plant = makeSimulation(loop_);
  plant.reset(1);
  run(plant, twin, kRun, [&](const Measurement& now) {
    const bool retuned = now.header.step != kSettle || session.retune(shown);
    EXPECT_TRUE(retuned);
    session.receive(now);
    EXPECT_LE(distance(session.answer().base.input, twin.answer().base.input), kRounding)
        << now.header.step;
  });
  EXPECT_EQ(session.controller().settings(), shown);
}

TEST_P(ControllerContract, SettingsThatMakeNoSenseAreRefusedAndChangeNothing) {
  ControllerSession session = makeSession();
  const Settings shown = session.controller().settings();
  if (shown.empty()) GTEST_SKIP() << "nothing may change in a run";
  EXPECT_THROW(session.retune({{"no_such_key", "1"}}), InputError);
  for (const auto& [key, text] : shown) {
    EXPECT_THROW(session.retune({{key, "much"}}), InputError) << key;
    EXPECT_THROW(session.retune({{key, ""}}), InputError) << key;
  }
  EXPECT_EQ(session.controller().settings(), shown);
}

std::string nameOf(const ::testing::TestParamInfo<std::string>& type) { return type.param; }

/// Ours, and those of the example of a user's package.
std::vector<std::string> everyType() {
  setenv("FMBPC_CONFIG_PATH", (sourceDir() + "/examples/two_tanks/config").c_str(), 1);
  setenv("FMBPC_PLUGIN_PATH", FMBPC_TEST_PLUGINS, 1);
  loadPlugin("two_tanks", "test");
  return controllerNames();
}

INSTANTIATE_TEST_SUITE_P(Types, ControllerContract, ::testing::ValuesIn(everyType()), nameOf);

TEST(ControllerRegistry, HoldsTheTypesThatShip) {
  for (const char* type : {"fmbpc", "fuzzy_optimal", "pi", "excitation"})
    EXPECT_EQ(controllerType(type).name, type);
  EXPECT_GE(controllerNames().size(), 9U);
  expectWords(errorOf([] { controllerType("magic"); }), {"controller.type 'magic'", "fmbpc"});
}

TEST(ControllerRegistry, ANameIsTakenOnlyOnce) {
  EXPECT_FALSE(registerControllerReader({"pi", "another"}, nullptr));
  EXPECT_NE(controllerType("pi").summary, "another");
}

TEST(ControllerRegistry, ParametersOfAnotherTypeAreNotGuessed) {
  struct Other {};
  const LoopFile loop = readLoop(loopsOfType("pi").front());
  expectWords(errorOf([&] { loop.controllerParams<Other>(); }),
              {loop.name, "controller.type", "pi"});
  EXPECT_EQ(findParams<Other>(*loop.controller), nullptr);
}

}  // namespace loop_controller_contract_test
}  // namespace fpc
