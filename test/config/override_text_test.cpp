// Several overrides in one text, as roslaunch hands them over.
#include <gtest/gtest.h>

#include "runtime/loop_fixture.hpp"

namespace fpc {
namespace config_override_text_test {

TEST(OverrideText, SpacesSeparateUnlessBracketsOrQuotesHoldThem) {
  EXPECT_EQ(parseOverrides("setpoint.initial={s: 55, x: 1900}  seed=3"),
            (Overrides{{"setpoint.initial", "{s: 55, x: 1900}"}, {"seed", "3"}}));
  EXPECT_EQ(parseOverrides("controller.loops.0.kp=2 a.b=[{x: 'one two=2'}, 3]"),
            (Overrides{{"controller.loops.0.kp", "2"}, {"a.b", "[{x: 'one two=2'}, 3]"}}));
  EXPECT_EQ(parseOverrides("title=\"a run=1\" noise.std.x=1"),
            (Overrides{{"title", "\"a run=1\""}, {"noise.std.x", "1"}}));
}

TEST(OverrideText, WordsWithoutAKeyBelongToTheValueBefore) {
  EXPECT_EQ(parseOverrides("title=A long day seed=3"),
            (Overrides{{"title", "A long day"}, {"seed", "3"}}));
  EXPECT_EQ(parseOverrides("title=The operator's day seed=3"),
            (Overrides{{"title", "The operator's day"}, {"seed", "3"}}));
}

// roslaunch ... "set:='setpoint.initial={T: 45}'": the shell takes the outer quotes only.
TEST(OverrideText, QuotesAroundAWholeOverrideAreTakenOff) {
  const Overrides both{{"setpoint.initial", "{T: 45}"}, {"seed", "3"}};
  EXPECT_EQ(parseOverrides("'setpoint.initial={T: 45}' seed=3"), both);
  EXPECT_EQ(parseOverrides("\"setpoint.initial={T: 45}\" 'seed=3'"), both);
  EXPECT_EQ(parseOverrides("title='a b'"), (Overrides{{"title", "'a b'"}}));
  EXPECT_EQ(parseOverrides("title=The 'big' day"), (Overrides{{"title", "The 'big' day"}}));
  expectWords(errorOf([] { parseOverride("'loop.pace=paced"); }), {"without quotes"});
}

TEST(OverrideText, NothingIsNoOverride) {
  EXPECT_TRUE(parseOverrides("").empty());
  EXPECT_TRUE(parseOverrides("  ").empty());
}

TEST(OverrideText, AValueWithoutAKeyIsNamed) {
  expectWords(errorOf([] { parseOverrides("fast loop.pace=paced"); }),
              {"--set fast", "path=value"});
}

}  // namespace config_override_text_test
}  // namespace fpc
