#include "fmbpc/base/sample_clock.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace base_sample_clock_test {

TEST(SampleClock, TimesAreExactMultiplesOfTheSampleTime) {
  const SampleClock clock(720.0, 1.0);
  EXPECT_EQ(clock.timeAt(0), 1'000'000'000);
  EXPECT_EQ(clock.timeAt(830), 1'000'000'000 + 830LL * 720'000'000'000);
  EXPECT_DOUBLE_EQ(clock.hoursAt(830), 166.0);
  const SampleClock tenth(0.1, 1234.5);
  EXPECT_EQ(tenth.timeAt(3'000'000'000U), 1'234'500'000'000 + 300'000'000'000'000'000);
}

TEST(SampleClock, FirstStepAtIsTheFirstSampleNotBeforeTheTime) {
  const SampleClock clock(2.0, 10.0);
  EXPECT_EQ(clock.firstStepAt(0), 0U);
  EXPECT_EQ(clock.firstStepAt(10'000'000'000), 0U);
  EXPECT_EQ(clock.firstStepAt(10'000'000'001), 1U);
  EXPECT_EQ(clock.firstStepAt(12'000'000'000), 1U);
  EXPECT_EQ(clock.firstStepAt(12'000'000'001), 2U);
}

// What a person writes for sample k: k Ts in hours, in double precision or rounded to nine digits.
TEST(SampleClock, AWrittenTimeOfASampleIsThatSample) {
  for (const double sample_time_s : {360.0, 720.0, 1.0 / 3.0, 0.1, 0.7, 1e-3, 86400.0}) {
    const SampleClock clock(sample_time_s, 1.0);
    for (std::uint32_t k = 0; k < 200000; k = 1 + k + k / 50) {
      const double time_h = k * sample_time_s / 3600.0;
      EXPECT_EQ(clock.firstStepAtHours(time_h), k) << sample_time_s;
      EXPECT_EQ(clock.firstStepAtHours(time_h + 0.4 * sample_time_s / 3600.0), k + 1);
    }
  }
  const SampleClock clock(360.0, 1.0);
  EXPECT_EQ(clock.firstStepAtHours(0.1000000002), 1U) << "within a microsecond";
  EXPECT_EQ(clock.firstStepAtHours(0.10000001), 2U);
  EXPECT_EQ(clock.firstStepAtHours(1e300), std::numeric_limits<std::uint32_t>::max());
  EXPECT_EQ(clock.firstStepAtHours(-1.0), 0U);
}

TEST(SampleClock, TimesBeyondTheLastStepDoNotWrapRound) {
  const SampleClock clock(1e-9, 1.0);
  EXPECT_EQ(clock.firstStepAt(std::numeric_limits<std::int64_t>::max()),
            std::numeric_limits<std::uint32_t>::max());
}

TEST(SampleClock, FirstStepInvertsTimeAt) {
  const SampleClock clock(0.0333, 1.0);
  for (std::uint32_t step = 0; step < 100000; step += 777)
    EXPECT_EQ(clock.firstStepAt(clock.timeAt(step)), step);
}

TEST(SampleClock, HeaderCarriesRunAndStep) {
  const StepHeader header = SampleClock(1.0, 1.0).header(7, 3);
  EXPECT_EQ(header.time_ns, 4'000'000'000);
  EXPECT_EQ(header.run_id, 7U);
  EXPECT_EQ(header.step, 3U);
}

TEST(SampleClock, UnusableTimesAreErrors) {
  for (const double bad : {0.0, -1.0, kNaN, kInfinity, 1e300}) {
    EXPECT_THROW(SampleClock(bad, 1.0), InputError) << bad;
    EXPECT_THROW(SampleClock(1.0, bad), InputError) << bad;
  }
}

}  // namespace base_sample_clock_test
}  // namespace fpc
