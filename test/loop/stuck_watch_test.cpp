#include "fmbpc/loop/stuck_watch.hpp"

#include "loop/gateway_fixture.hpp"

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

}  // namespace loop_stuck_watch_test
}  // namespace fpc
