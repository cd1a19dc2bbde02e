#include "runtime/recorder_clock.hpp"

#include <gtest/gtest.h>

namespace fpc {
namespace loop_recorder_clock_test {

constexpr double kFinal = RecorderClock::kFinalPatience, kWrite = RecorderClock::kWritePatience;

TEST(RecorderClock, ARunBeginsWithTheFirstThatComesOfIt) {
  RecorderClock clock;
  EXPECT_EQ(clock.elapsed(50.0), 0.0);
  clock.hear(100.0);
  clock.hear(103.0);
  EXPECT_EQ(clock.elapsed(107.0), 7.0);
  clock.restart();
  clock.hear(200.0);
  EXPECT_EQ(clock.elapsed(201.0), 1.0);
}

TEST(RecorderClock, ARunThatIsGoneOnWithBeganBefore) {
  RecorderClock clock;
  clock.restart(90.0);
  clock.hear(100.0);
  EXPECT_EQ(clock.elapsed(101.0), 11.0);
}

TEST(RecorderClock, StragglersAreWaitedForFromTheFinalSampleOn) {
  RecorderClock clock;
  EXPECT_FALSE(clock.stragglersLost(1e9));
  clock.seeFinal(true, 100.0);
  clock.seeFinal(true, 105.0);  // the plant sends it again
  EXPECT_FALSE(clock.stragglersLost(100.0 + kFinal - 0.1));
  EXPECT_TRUE(clock.stragglersLost(100.0 + kFinal));
  clock.seeFinal(false, 112.0);  // the plant goes on
  EXPECT_FALSE(clock.stragglersLost(1e9));
  clock.seeFinal(true, 200.0);
  EXPECT_FALSE(clock.stragglersLost(200.0 + kFinal - 0.1));
  clock.close(205.0);
  EXPECT_FALSE(clock.stragglersLost(1e9));
}

TEST(RecorderClock, ADiskWithoutRoomGetsTimeFromTheFirstTryOn) {
  RecorderClock clock;
  EXPECT_FALSE(clock.closed());
  EXPECT_FALSE(clock.writingLost(1e9));
  clock.close(100.0);
  clock.close(108.0);
  EXPECT_TRUE(clock.closed());
  EXPECT_FALSE(clock.writingLost(100.0 + kWrite));
  EXPECT_TRUE(clock.writingLost(100.0 + kWrite + 0.1));
  clock.restart();
  EXPECT_FALSE(clock.closed());
  EXPECT_FALSE(clock.writingLost(1e9));
}

}  // namespace loop_recorder_clock_test
}  // namespace fpc
