#include "runtime/pacer.hpp"

#include <gtest/gtest.h>

namespace fpc {
namespace loop_pacer_test {

constexpr double kStart = 1000.0;
double at(double seconds) { return kStart + seconds; }

TEST(Pacer, LockstepIsAlwaysDue) {
  Pacer pacer(Pace::kLockstep, 0.2);
  pacer.restart(kStart);
  EXPECT_TRUE(pacer.due(kStart));
  EXPECT_FALSE(pacer.timed());
}

TEST(Pacer, PacedWaitsAtLeastAPeriodAfterEachSample) {
  Pacer pacer(Pace::kPaced, 0.2);
  pacer.restart(kStart);
  EXPECT_FALSE(pacer.due(at(0.19)));
  EXPECT_NEAR(0.01, pacer.remaining(at(0.19)), 1e-6);
  EXPECT_TRUE(pacer.due(at(0.2 + 1e-9)));
  pacer.sent(at(0.5));  // the answer came late: the next period counts from here
  EXPECT_FALSE(pacer.due(at(0.69)));
  EXPECT_TRUE(pacer.due(at(0.7 + 1e-9)));
  EXPECT_EQ(0u, pacer.slips());
}

TEST(Pacer, RealtimeKeepsItsGrid) {
  Pacer pacer(Pace::kRealtime, 0.2);
  pacer.restart(kStart);
  pacer.sent(at(0.203));
  EXPECT_FALSE(pacer.due(at(0.399)));
  EXPECT_TRUE(pacer.due(at(0.4 + 1e-9)));
  pacer.sent(at(0.47));
  EXPECT_TRUE(pacer.due(at(0.6 + 1e-9)));
  EXPECT_EQ(0u, pacer.slips());
}

TEST(Pacer, RealtimeSlipsWhenThePlantItselfIsLateByAWholeSample) {
  Pacer pacer(Pace::kRealtime, 0.2);
  pacer.restart(kStart);
  pacer.sent(at(0.7));
  EXPECT_EQ(1u, pacer.slips());
  EXPECT_FALSE(pacer.due(at(0.89)));
  EXPECT_TRUE(pacer.due(at(0.9 + 1e-9)));
}

TEST(Pacer, RemainingTimeIsNeverZero) {
  Pacer pacer(Pace::kRealtime, 0.2);
  pacer.restart(kStart);
  EXPECT_GT(pacer.remaining(at(5.0)), 0.0);
}

}  // namespace loop_pacer_test
}  // namespace fpc
