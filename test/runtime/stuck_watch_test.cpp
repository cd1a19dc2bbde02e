#include "runtime/stuck_watch.hpp"

#include "runtime/gateway_fixture.hpp"

namespace fpc {
namespace loop_stuck_watch_test {

StuckWatch watch() {
  return StuckWatch({3, 0.02}, {one(0.0), one(10.0), one(1.0)}, {{"inflow", "m3/h", 0, 10}});
}

TEST(StuckWatch, SaysItAfterSoManySamplesAndTakesItBackAtOnce) {
  StuckWatch stuck = watch();
  for (int k = 0; k < 2; ++k) stuck.look(one(6.0), one(5.0), one(5.0));
  EXPECT_EQ(stuck.words(), "");
  stuck.look(one(6.0), one(5.0), one(5.0));
  EXPECT_EQ(stuck.words(), "input inflow does not follow its command");
  stuck.look(one(6.0), one(5.0), one(5.9));
  EXPECT_EQ(stuck.words(), "");
}

TEST(StuckWatch, WhatTheLimitsHoldBackIsNotStuck) {
  StuckWatch stuck = watch();
  for (int k = 0; k < 9; ++k) stuck.look(one(40.0), one(k), one(k + 1.0));
  EXPECT_EQ(stuck.words(), "");
}

TEST(StuckWatch, AnInputThatNobodyReadsBackIsNotKnownToFollow) {
  StuckWatch stuck = watch();
  for (int k = 0; k < 3; ++k) stuck.look(one(5.0), one(5.0), one(std::nan("")));
  EXPECT_EQ(stuck.words(), "input inflow is not read back");
  EXPECT_TRUE(stuck.all());
}

TEST(StuckWatch, HoldsWhereItWasToldAndThenAtTheLastCommandThatWasFollowed) {
  StuckWatch stuck = watch();
  const auto held = [&](double asked) {
    Vector action = one(asked);
    stuck.hold(action, one(6.0));
    return action[0];
  };
  stuck.look(one(5.0), one(5.0), one(5.1));
  EXPECT_EQ(held(7.0), 7.0);
  stuck.look(one(6.0), one(5.0), one(5.1));
  EXPECT_EQ(held(6.5), 6.0);
  for (int k = 0; k < 2; ++k) stuck.look(one(6.0), one(6.0), one(5.1));
  EXPECT_EQ(held(6.0), 5.0);
  EXPECT_EQ(held(6.5), 5.5);  // one move from what is asked
  stuck.reset();
  EXPECT_EQ(held(6.5), 6.5);
}

}  // namespace loop_stuck_watch_test
}  // namespace fpc
