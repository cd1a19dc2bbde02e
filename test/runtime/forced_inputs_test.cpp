#include "runtime/forced_inputs.hpp"

#include <gtest/gtest.h>

#include "fmbpc/base/types.hpp"

namespace fpc {
namespace loop_forced_inputs_test {

PlantInfo plant() {
  PlantInfo info;
  info.inputs = {{"u", "m3/h", 0.0, 10.0}, {"v", "", -1.0, 1.0}};
  return info;
}

std::vector<CommandEffect> effect(std::vector<std::string> names, std::vector<double> values,
                                  CommandMode mode = CommandMode::kOverride) {
  CommandEffect one;
  one.command.name = std::move(names);
  one.command.value = std::move(values);
  one.command.mode = mode;
  return {one};
}

TEST(ForcedInputs, WhatTheLimitsAllowIsNotSaid) {
  ForcedInputs forced(plant());
  forced.look(1, effect({"input/u", "input/v"}, {10.0, -1.0}));
  forced.look(2, effect({"input/u"}, {-10.0}, CommandMode::kOffset));
  forced.look(3, effect({"q", "output/u"}, {1e300, 1e300}));
  EXPECT_EQ(forced.lines(), "");
  EXPECT_EQ(forced.samples(), 0U);
}

TEST(ForcedInputs, WhatIsBeyondThemIsSaidUntilItIsReleased) {
  ForcedInputs forced(plant());
  forced.look(1, effect({"input/u"}, {1e300}));
  EXPECT_EQ(forced.lines(),
            "input/u was asked to be 1e+300, beyond its limits, 0..10 [m3/h], and clamped");
  forced.look(2, {});
  EXPECT_NE(forced.lines(), "");
  forced.look(3, effect({"input/u"}, {}, CommandMode::kRelease));
  EXPECT_EQ(forced.lines(), "");
  EXPECT_EQ(forced.samples(), 2U);
}

TEST(ForcedInputs, AnotherCommandOnTheSameInputTakesItsPlace) {
  ForcedInputs forced(plant());
  forced.look(1, effect({"input/u", "input/v"}, {-0.1, 1.1}));
  EXPECT_NE(forced.lines().find("beyond its limits, -1..1, and"), std::string::npos);
  forced.look(2, effect({"input/v"}, {-2.5}, CommandMode::kOffset));
  EXPECT_EQ(forced.lines(),
            "input/u was asked to be -0.1, beyond its limits, 0..10 [m3/h], and clamped\n"
            "input/v was asked to be off by -2.5, more than its limits, -1..1, are apart, and "
            "clamped");
  forced.look(3, effect({"input/u", "input/v"}, {1.0, 1.0}));
  EXPECT_EQ(forced.lines(), "");
}

TEST(ForcedInputs, ANewRunReleasesEverything) {
  ForcedInputs forced(plant());
  forced.look(7, effect({"input/u"}, {11.0}));
  forced.look(0, {});
  EXPECT_EQ(forced.lines(), "");
  forced.look(0, effect({"input/u"}, {12.0}));
  EXPECT_NE(forced.lines(), "") << "commands of the file act from sample 0 on";
}

}  // namespace loop_forced_inputs_test
}  // namespace fpc
