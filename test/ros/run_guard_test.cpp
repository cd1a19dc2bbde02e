#include "fmbpc/ros/run_guard.hpp"

#include <gtest/gtest.h>

namespace fpc {
namespace {

ros::WallTime at(double seconds) { return ros::WallTime(1000.0 + seconds); }

TEST(RunGuard, AdmitsTheAnnouncedRunAtOnce) {
  RunGuard guard;
  guard.announce(5);
  EXPECT_TRUE(guard.admits(5, at(0.0)));
  guard.announce(9);
  EXPECT_TRUE(guard.admits(9, at(0.1)));
}

TEST(RunGuard, LeavesEarlierRunsToTheStepGate) {
  RunGuard guard;
  guard.announce(5);
  EXPECT_TRUE(guard.admits(5, at(0.0)));
  EXPECT_TRUE(guard.admits(4, at(0.1)));
  EXPECT_TRUE(guard.admits(5, at(0.2)));
}

TEST(RunGuard, DropsStraysOfLaterRunsWhileThePresentOneGoesOn) {
  RunGuard guard;
  guard.announce(5);
  for (int k = 0; k < 20; ++k) {
    EXPECT_TRUE(guard.admits(5, at(0.1 * k)));
    EXPECT_FALSE(guard.admits(77, at(0.1 * k + 0.05)));
  }
}

TEST(RunGuard, AdmitsAnUnannouncedRunThatGoesOnAlone) {
  RunGuard guard;
  guard.announce(5);
  EXPECT_TRUE(guard.admits(5, at(0.0)));
  EXPECT_FALSE(guard.admits(6, at(1.0)));
  EXPECT_FALSE(guard.admits(6, at(1.4)));
  EXPECT_TRUE(guard.admits(6, at(1.6)));
  EXPECT_TRUE(guard.admits(6, at(1.7)));
}

TEST(RunGuard, DoesNotTrustAStrayBeforeTheFirstSample) {
  RunGuard guard;
  guard.announce(5);
  EXPECT_FALSE(guard.admits(1000, at(0.0)));
  EXPECT_TRUE(guard.admits(5, at(0.1)));
}

}  // namespace
}  // namespace fpc
