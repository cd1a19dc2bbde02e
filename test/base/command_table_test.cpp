#include "fmbpc/base/command_table.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace base_command_table_test {

Command command(const std::string& name, double value, CommandMode mode = CommandMode::kOverride) {
  return {0, {name}, {value}, mode};
}

TEST(CommandTable, NothingIsInForceAtTheStart) {
  CommandTable table(std::vector<std::string>{"q_i", "s_i"});
  Vector values(2);
  values << 1300.0, 366.0;
  EXPECT_TRUE(table.advance(0).empty());
  table.apply(values);
  EXPECT_EQ(values[0], 1300.0);
  EXPECT_EQ(values[1], 366.0);
}

TEST(CommandTable, ACommandActsFromItsStepOn) {
  CommandTable table(std::vector<std::string>{"q_i", "s_i"});
  table.accept(command("q_i", 1900.0), 3);
  EXPECT_TRUE(table.advance(2).empty());
  EXPECT_EQ(table.apply(0, 1300.0), 1300.0);
  ASSERT_EQ(table.advance(3).size(), 1U);
  EXPECT_EQ(table.apply(0, 1300.0), 1900.0);
  EXPECT_EQ(table.apply(1, 366.0), 366.0);
  EXPECT_TRUE(table.advance(4).empty());
  EXPECT_EQ(table.apply(0, 1300.0), 1900.0);
}

TEST(CommandTable, OffsetsReplaceAndDoNotAddUp) {
  CommandTable table(std::vector<std::string>{"q_i"});
  table.accept(command("q_i", 100.0, CommandMode::kOffset), 0);
  table.accept(command("q_i", 50.0, CommandMode::kOffset), 1);
  table.advance(0);
  EXPECT_EQ(table.apply(0, 1300.0), 1400.0);
  table.advance(1);
  EXPECT_EQ(table.apply(0, 1300.0), 1350.0);
}

TEST(CommandTable, ReleaseGivesTheNominalValueBackAndNeedsNoValues) {
  CommandTable table(std::vector<std::string>{"q_i"});
  table.accept(command("q_i", 100.0), 0);
  table.accept({0, {"q_i"}, {}, CommandMode::kRelease}, 1);
  table.advance(0);
  EXPECT_EQ(table.apply(0, 1300.0), 100.0);
  table.advance(1);
  EXPECT_EQ(table.apply(0, 1300.0), 1300.0);
  EXPECT_FALSE(table.active()[0].active);
}

TEST(CommandTable, OrderOfStepsCountsNotOrderOfArrival) {
  CommandTable table(std::vector<std::string>{"q_i"});
  table.accept(command("q_i", 5.0), 5);
  table.accept(command("q_i", 2.0), 2);
  EXPECT_EQ(table.advance(9).size(), 2U);
  EXPECT_EQ(table.apply(0, 0.0), 5.0);
}

TEST(CommandTable, ForTheSameStepTheLaterCommandWins) {
  CommandTable table(std::vector<std::string>{"q_i"});
  table.accept(command("q_i", 1.0), 4);
  table.accept(command("q_i", 2.0), 4);
  table.advance(4);
  EXPECT_EQ(table.apply(0, 0.0), 2.0);
}

TEST(CommandTable, ValuesBeyondTheRangeOfTheirSignalAreErrors) {
  CommandTable table(std::vector<SignalInfo>{{"q_i", "m3/h", 100.0, 3000.0}});
  for (const double value : {99.9, 3000.1}) {
    try {
      table.accept(command("q_i", value), 0);
      ADD_FAILURE() << value << " was taken";
    } catch (const InputError& error) {
      const std::string words = error.what();
      EXPECT_EQ(words.rfind("value of q_i: expected a number >= 100 and <= 3000 [m3/h], got ", 0),
                0U)
          << words;
    }
  }
  EXPECT_THROW(table.accept(command("q_i", -2900.1, CommandMode::kOffset), 0), InputError);
  EXPECT_TRUE(table.advance(0).empty());
  table.accept(command("q_i", 3000.0), 1);
  table.accept(command("q_i", -2900.0, CommandMode::kOffset), 2);
  EXPECT_EQ(table.advance(2).size(), 2U);
}

TEST(CommandTable, AReleaseWithoutNamesIsOneOfAllNames) {
  CommandTable table(std::vector<std::string>{"q_i", "s_i"});
  table.accept({0, {"q_i", "s_i"}, {1.0, 2.0}, CommandMode::kOverride}, 0);
  table.advance(0);
  table.accept({0, {}, {}, CommandMode::kRelease}, 1);
  ASSERT_EQ(table.advance(1).size(), 1U);
  EXPECT_FALSE(table.active()[0].active || table.active()[1].active);
}

TEST(CommandTable, BadCommandsAreErrorsAndNothingIsTaken) {
  CommandTable table(std::vector<std::string>{"q_i", "s_i"});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(table.accept({0, {"q_i", "typo"}, {1.0, 2.0}}, 0), InputError);
  EXPECT_THROW(table.accept({0, {"q_i", "s_i"}, {1.0}}, 0), InputError);
  EXPECT_THROW(table.accept({0, {}, {}}, 0), InputError);
  EXPECT_THROW(table.accept(command("q_i", nan), 0), InputError);
  EXPECT_THROW(table.accept(command("q_i", infinity), 0), InputError);
  EXPECT_THROW(table.accept(command("q_i", 1.0, static_cast<CommandMode>(0)), 0), InputError);
  EXPECT_THROW(table.accept({0, {"q_i"}, {}, CommandMode::kOffset}, 0), InputError);
  EXPECT_TRUE(table.advance(10).empty());
  EXPECT_EQ(table.apply(0, 7.0), 7.0);
}

TEST(CommandTable, ClearForgetsActiveAndPending) {
  CommandTable table(std::vector<std::string>{"q_i"});
  table.accept(command("q_i", 1.0), 0);
  table.accept(command("q_i", 2.0), 5);
  table.advance(0);
  table.clear();
  EXPECT_EQ(table.apply(0, 7.0), 7.0);
  EXPECT_TRUE(table.advance(9).empty());
}

TEST(CommandTable, NamesAreBoundedInNumberAndEachComesOnce) {
  CommandTable table(std::vector<std::string>{"q_i", "s_i"});
  const std::vector<std::string> many(200000, "q_i"), twice(2, "q_i");
  EXPECT_THROW(
      table.accept({0, many, std::vector<double>(many.size(), 1.0), CommandMode::kOverride}, 0),
      InputError);
  EXPECT_THROW(table.accept({0, twice, {1.0, 2.0}, CommandMode::kOverride}, 0), InputError);
  EXPECT_THROW(table.accept({0, many, {}, CommandMode::kRelease}, 0), InputError);
  EXPECT_TRUE(table.advance(1).empty());
}

TEST(CommandTable, ARefusalOfALongNameIsShort) {
  CommandTable table(std::vector<std::string>{"q_i"});
  try {
    table.accept(command(std::string(1000000, 'x'), 1.0), 0);
    FAIL() << "taken";
  } catch (const InputError& error) {
    EXPECT_LT(std::string(error.what()).size(), 200U);
  }
}

}  // namespace base_command_table_test
}  // namespace fpc
