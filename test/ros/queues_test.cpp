#include "ros/queues.hpp"

#include <gtest/gtest.h>

namespace fpc {
namespace ros_queues_test {

constexpr ListenerKind kKinds[] = {ListenerKind::kLaw, ListenerKind::kRecord, ListenerKind::kPeer,
                                   ListenerKind::kViewer};
constexpr Pace kPaces[] = {Pace::kLockstep, Pace::kPaced, Pace::kRealtime};

TEST(Queues, WhereThePlantWaitsALawAnswersEverySample) {
  for (const Pace pace : {Pace::kLockstep, Pace::kPaced}) {
    EXPECT_FALSE(answersNewestOnly(pace));
    EXPECT_EQ(queueOf(ListenerKind::kLaw, pace), queueOf(ListenerKind::kRecord, pace));
  }
}

TEST(Queues, InRealtimeALawAnswersTheNewestAndTheRecordStillHasAll) {
  EXPECT_TRUE(answersNewestOnly(Pace::kRealtime));
  EXPECT_LE(queueOf(ListenerKind::kLaw, Pace::kRealtime), 100U);
  EXPECT_EQ(queueOf(ListenerKind::kRecord, Pace::kRealtime),
            queueOf(ListenerKind::kRecord, Pace::kLockstep));
  EXPECT_GE(queueOf(ListenerKind::kRecord, Pace::kRealtime), 10000U);
}

// 0 is unbounded for roscpp.
TEST(Queues, AreBoundedForEverybodyInEveryPace) {
  for (const ListenerKind kind : kKinds)
    for (const Pace pace : kPaces) {
      EXPECT_GT(queueOf(kind, pace), 0U);
      EXPECT_LE(queueOf(kind, pace), 10000U);
    }
  for (const Pace pace : kPaces) EXPECT_LE(queueOf(ListenerKind::kViewer, pace), 1000U);
}

}  // namespace ros_queues_test
}  // namespace fpc
