#include "runtime/authority.hpp"

#include <gtest/gtest.h>

namespace fpc {
namespace loop_authority_test {

TEST(Authority, OnlyTheNamedNodesSpeakOnAGuardedTopic) {
  Authority authority(Publishers{{"measurement", {"/plant_simulator"}}, {"setpoint", {}}});
  EXPECT_TRUE(authority.admits("measurement", "/plant_simulator"));
  EXPECT_FALSE(authority.admits("measurement", "/stranger"));
  EXPECT_FALSE(authority.admits("measurement", "/stranger"));
  EXPECT_TRUE(authority.admits("setpoint", "/anyone"));
  EXPECT_TRUE(authority.admits("disturbance", "/anyone"));
  EXPECT_TRUE(authority.guards("measurement"));
  EXPECT_FALSE(authority.guards("setpoint"));
  EXPECT_EQ(authority.refused().at("measurement from /stranger"), 2U);
  EXPECT_EQ(authority.latest(), "measurement from /stranger");
}

TEST(Authority, ManyStrangersDoNotFillTheMemory) {
  Authority authority(Publishers{{"measurement", {"/plant_simulator"}}});
  for (int i = 0; i < 1000; ++i) authority.admits("measurement", "/s" + std::to_string(i));
  EXPECT_LE(authority.refused().size(), Authority::kMostNamed + 1);
  EXPECT_EQ(authority.refused().at("measurement from others"), 1000 - Authority::kMostNamed);
}

TEST(Authority, NobodySpeaksForAnotherNodeButTheManagerOfNodelets) {
  Authority authority(Publishers{}), nodelets(Publishers{}, "/manager");
  EXPECT_TRUE(authority.speaksFor("loop_state", "/loop_recorder", "/loop_recorder"));
  EXPECT_FALSE(authority.speaksFor("loop_state", "/rostopic_1", "/loop_recorder"));
  EXPECT_FALSE(authority.speaksFor("loop_state", "/manager", "/loop_recorder"));
  EXPECT_FALSE(authority.speaksFor("loop_state", "", "/loop_recorder"));
  EXPECT_TRUE(nodelets.speaksFor("loop_state", "/manager", "/loop_recorder"));
  EXPECT_EQ(authority.refused().at("loop_state from /rostopic_1"), 1U);
}

TEST(RateLimit, LetsABurstThroughAndThenTheStatedRate) {
  RateLimit limit(10.0, 5.0);
  int passed = 0;
  for (int i = 0; i < 60000; ++i) passed += limit.pass(100.0) ? 1 : 0;
  EXPECT_EQ(passed, 5);
  EXPECT_EQ(limit.dropped(), 59995U);
  EXPECT_TRUE(limit.pass(100.1 + 1e-9));
  EXPECT_FALSE(limit.pass(100.1 + 1e-9));
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(limit.pass(101.0 + 0.1001 * i));
}

}  // namespace loop_authority_test
}  // namespace fpc
