#include "fmbpc/ros/setpoint_keeper.hpp"

#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr std::int64_t kSecond = 1000000000;

class SetpointKeeperTest : public ::testing::Test {
 protected:
  SetpointKeeper keeper{{"s", "x"}};
  void ask(std::int64_t time_ns, const std::string& name, double value, CommandMode mode) {
    keeper.accept({time_ns, {name}, {value}, mode});
  }
};

TEST_F(SetpointKeeperTest, NothingStandsAtFirst) {
  EXPECT_FALSE(keeper.advance(kSecond));
  EXPECT_TRUE(keeper.inForce().empty());
  EXPECT_TRUE(keeper.waiting().empty());
}

TEST_F(SetpointKeeperTest, ACommandWaitsForItsTime) {
  ask(5 * kSecond, "x", 1900.0, CommandMode::kOverride);
  EXPECT_FALSE(keeper.advance(5 * kSecond - 1));
  EXPECT_EQ(1u, keeper.waiting().size());
  EXPECT_TRUE(keeper.advance(5 * kSecond));
  EXPECT_TRUE(keeper.waiting().empty());
  ASSERT_EQ(1u, keeper.inForce().size());
  EXPECT_EQ(std::vector<double>{1900.0}, keeper.inForce()[0].value);
}

TEST_F(SetpointKeeperTest, OverridesAndOffsetsStandSideBySide) {
  ask(0, "s", 10.0, CommandMode::kOffset);
  ask(0, "x", 1900.0, CommandMode::kOverride);
  EXPECT_TRUE(keeper.advance(kSecond));
  const std::vector<Command> commands = keeper.inForce();
  ASSERT_EQ(2u, commands.size());
  EXPECT_EQ(CommandMode::kOverride, commands[0].mode);
  EXPECT_EQ(std::vector<std::string>{"x"}, commands[0].name);
  EXPECT_EQ(CommandMode::kOffset, commands[1].mode);
  EXPECT_EQ(std::vector<std::string>{"s"}, commands[1].name);
}

TEST_F(SetpointKeeperTest, AReleaseEndsIt) {
  ask(0, "x", 1900.0, CommandMode::kOverride);
  keeper.advance(kSecond);
  keeper.accept({0, {"x"}, {}, CommandMode::kRelease});
  EXPECT_TRUE(keeper.advance(2 * kSecond));
  EXPECT_TRUE(keeper.inForce().empty());
}

TEST_F(SetpointKeeperTest, ANewRunStartsWithoutCommands) {
  ask(0, "x", 1900.0, CommandMode::kOverride);
  ask(9 * kSecond, "s", 60.0, CommandMode::kOverride);
  keeper.advance(kSecond);
  keeper.clear();
  EXPECT_FALSE(keeper.advance(10 * kSecond));
  EXPECT_TRUE(keeper.inForce().empty());
}

TEST_F(SetpointKeeperTest, RefusesWhatAControllerWouldRefuse) {
  EXPECT_THROW(ask(0, "nobody", 1.0, CommandMode::kOverride), InputError);
  EXPECT_THROW(keeper.accept({0, {"x"}, {}, CommandMode::kOverride}), InputError);
  EXPECT_FALSE(keeper.advance(kSecond));
}

}  // namespace
}  // namespace fpc
