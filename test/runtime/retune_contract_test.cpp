// What every controller with settings promises a person who turns them in a run: no bump, and an
// effect.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <regex>

#include "allocation_counter.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/factory.hpp"
#include "runtime/loops_of_type.hpp"

namespace fpc {
namespace loop_retune_contract_test {

constexpr std::uint32_t kSettle = 30, kRun = 60;  // samples
constexpr double kRounding = 1e-9;                // of an input's range

/// The same text with every number a fifth smaller.
std::string lessOf(const std::string& text, const SettingInfo& info) {
  static const std::regex number("(^|[ =])(-?[0-9][-+.0-9e]*)");
  std::string less;
  std::size_t from = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), number), end; at != end; ++at) {
    less += text.substr(from, static_cast<std::size_t>(at->position(2)) - from);
    less += exactText(0.8 * settingNumber((*at)[2].str(), info.key));
    from = static_cast<std::size_t>(at->position(2) + at->length(2));
  }
  return less + text.substr(from);
}

/// What to try instead of a value: of whole numbers the neighbours.
std::vector<std::string> othersOf(const std::string& text, const SettingInfo& info) {
  if (info.kind != SettingKind::kInteger) return {lessOf(text, info)};
  const int value = settingInteger(text, info.key);
  return {std::to_string(value - 1), std::to_string(value + 1)};
}

class RetuneContract : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const std::string name = loopsOfType(GetParam()).front();
    loop_ = readLoop(name, withoutRecords(name));
  }
  ControllerSession makeSession() const {
    ControllerSession session = makeControllerSession(loop_);
    if (session.controller().needsModel()) session.setModel(loop_.model);
    return session;
  }
  double distance(const Vector& a, const Vector& b) const {
    const InputLimits& limits = loop_.simulation.actuator.limits;
    const Vector width = (limits.upper - limits.lower).unaryExpr([](double w) {
      return std::isfinite(w) && w > 0.0 ? w : 1.0;
    });
    return ((a - b).array() / width.array()).abs().maxCoeff();
  }
  bool accepted(const Settings& settings) const {
    try {
      return makeSession().retune(settings);
    } catch (const InputError&) {
      return false;
    }
  }
  /// Largest distance of a controller that is retuned at kSettle from one that is not, both beside
  /// the plant that the latter moves.
  double retune(const Settings& settings) const {
    ControllerSession session = makeSession(), twin = makeSession();
    Simulation plant = makeSimulation(loop_);
    plant.reset(1);
    double effect = 0.0;
    for (std::uint32_t k = 0; k < kRun; ++k) {
      const Measurement now = plant.measurement();
      if (k == kSettle) EXPECT_TRUE(session.retune(settings));
      testing::AllocationCounter counter;
      session.receive(now);
      if (k >= kSettle && testing::AllocationCounter::works()) EXPECT_EQ(counter.count(), 0U) << k;
      twin.receive(now);
      const double apart = distance(session.output().input, twin.output().input);
      if (k <= kSettle) EXPECT_LE(apart, kRounding) << k;
      EXPECT_TRUE(session.output().ok);
      effect = std::max(effect, apart);
      plant.advance(twin.answer().base.input);
    }
    return effect;
  }
  LoopFile loop_;
};

TEST_P(RetuneContract, NewSettingsComeWithoutABumpAndHaveAnEffect) {
  const Settings shown = makeSession().controller().settings();
  double effect = 0.0;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const SettingInfo& info = controllerType(GetParam()).settings[i];
    const std::vector<std::string> others = othersOf(shown[i].second, info);
    const auto other = std::find_if(others.begin(), others.end(), [&](const std::string& text) {
      return accepted({{info.key, text}});
    });
    SCOPED_TRACE(loop_.name + ": " + info.key + " " + shown[i].second);
    if (other != others.end()) effect = std::max(effect, retune({{info.key, *other}}));
    // Two whole numbers may hold each other where they are, as P = 1 and M = 1.
    // The published law heeds no weights: they are refused.
    const bool unheeded = loop_.name == "asp_case1" &&
                          (info.key.rfind("weight_", 0) == 0 || info.key == "input_target");
    EXPECT_TRUE(other != others.end() || info.kind == SettingKind::kInteger || unheeded);
  }
  EXPECT_GT(effect, 1e-6) << "of the inputs' ranges";
}

TEST_P(RetuneContract, WhatIsNoFiniteNumberIsRefused) {
  const Settings shown = makeSession().controller().settings();
  for (const auto& [key, text] : shown)
    for (const char* bad : {"nan", "inf", "-inf"})
      EXPECT_FALSE(accepted({{key, bad}})) << key << " " << bad << ", now " << text;
}

TEST_P(RetuneContract, SettingsAreKeptAcrossAResetAndANewModel) {
  const ControllerType& type = controllerType(GetParam());
  ControllerSession session = makeSession();
  Settings next = session.controller().settings();
  for (const auto& text : othersOf(next.front().second, type.settings.front()))
    if (accepted({{next.front().first, text}})) next.front().second = text;
  ASSERT_TRUE(session.retune({next.front()}));
  if (type.needs_model) session.setModel(loop_.model);
  Simulation plant = makeSimulation(loop_);
  plant.reset(1);
  session.receive(plant.measurement());
  plant.reset(2);
  session.receive(plant.measurement());
  EXPECT_EQ(session.controller().settings().front(), next.front());
}

std::vector<std::string> typesWithSettings() {
  std::vector<std::string> types;
  for (const std::string& name : controllerNames())
    if (!controllerType(name).settings.empty() && !loopsOfType(name).empty()) types.push_back(name);
  return types;
}

INSTANTIATE_TEST_SUITE_P(Types, RetuneContract, ::testing::ValuesIn(typesWithSettings()),
                         [](const auto& type) { return type.param; });

TEST(RetuneRegistry, TheTypesThatCanBeRetunedAreKnown) {
  const std::vector<std::string> types = typesWithSettings();
  for (const char* name : {"fmbpc", "fuzzy_optimal", "pi"})
    EXPECT_NE(std::find(types.begin(), types.end(), name), types.end()) << name;
}

TEST(RetuneRegistry, AKeyThatTheLawDoesNotHeedIsRefusedAsInItsFile) {
  const LoopFile loop = readLoop("cstr_tracking");
  ControllerSession session = makeControllerSession(loop);
  session.setModel(loop.model);
  const auto refusal = [](const std::function<void()>& action) -> std::string {
    try {
      action();
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  for (const std::string& words :
       {refusal([&] {
          session.retune({{"weight_move", "q_c=1"}});
        }),
        refusal([] {
          readLoop("cstr_tracking", {{"controller.weight_move.q_c", "1"}});
        })}) {
    EXPECT_NE(words.find("controller.weight_move"), std::string::npos) << words;
    EXPECT_NE(words.find("law general or iterated"), std::string::npos) << words;
  }
  for (const char* key : {"weight_input", "input_target", "iterations"}) {
    const std::string words = refusal([&] { session.retune({{key, "9"}}); });
    EXPECT_NE(words.find("law iterated"), std::string::npos) << key << ": " << words;
  }
  EXPECT_TRUE(session.retune({{"weight_move", "q_c=0"}, {"coincidence_steps", "8"}}));
}

}  // namespace loop_retune_contract_test
}  // namespace fpc
