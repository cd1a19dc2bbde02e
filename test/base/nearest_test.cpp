#include "fmbpc/base/nearest.hpp"

#include <gtest/gtest.h>

namespace fpc {
namespace {

TEST(Nearest, FindsSlipsOfTheFingersAndBeginnings) {
  const std::vector<std::string> known{"resolve", "run", "reproduce", "asp_case1", "asp_case1_clp"};
  EXPECT_EQ(nearest("rnu", known), std::vector<std::string>{"run"});
  EXPECT_EQ(nearest("reproduc", known).at(0), "reproduce");
  EXPECT_EQ(nearest("asp_caes1", known).at(0), "asp_case1");
  EXPECT_EQ(nearest("asp_c", known).size(), 2U);
  EXPECT_EQ(nearest("asp_case", known, 1).size(), 1U);
  EXPECT_TRUE(nearest("thermostat", known).empty());
  EXPECT_TRUE(nearest("", known).empty());
}

}  // namespace
}  // namespace fpc
