#include "fmbpc/control/setpoint_source.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace control_setpoint_source_test {

constexpr double kStart = 1234.5;               // t0 [s]
constexpr std::int64_t kSample = 720000000000;  // 0.2 h [ns]
constexpr std::int64_t kZero = 1234500000000;   // t0 [ns]

Vector two(double first, double second) {
  Vector values(2);
  values << first, second;
  return values;
}

SetpointParams params() {
  SetpointParams p;
  p.initial = two(55.0, 2000.0);
  return p;
}

SetpointSource source(const SetpointParams& p, double sample_time_s = 720.0) {
  return SetpointSource(p, {"s", "x"}, SampleClock(sample_time_s, kStart));
}

Command command(const std::string& name, double value, CommandMode mode = CommandMode::kOverride,
                std::int64_t time_ns = 0) {
  return {time_ns, {name}, {value}, mode};
}

std::string messageOf(const SetpointParams& p) {
  try {
    p.validate(2);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(SetpointSource, ScheduleActsFromTheFirstSampleThatIsNotEarlier) {
  SetpointParams p = params();
  p.schedule = {{0.6, two(60.0, kNaN)}, {0.7, two(kNaN, 1900.0)}};
  SetpointSource s = source(p);
  EXPECT_EQ(s.advance(2), two(55.0, 2000.0));
  EXPECT_EQ(s.advance(3), two(60.0, 2000.0));  // t_3 = 0.6 h, exactly its time
  EXPECT_EQ(s.advance(4), two(60.0, 1900.0));  // 0.7 h lies between t_3 and t_4
}

TEST(SetpointSource, DecimalTimesOfSamplesAreNeverASampleLate) {
  for (const double sample_time_s : {720.0, 0.1, 1.0 / 3.0, 7.3, 30.0}) {
    const SampleClock clock(sample_time_s, kStart);
    for (std::uint32_t k = 1; k < 4000000; k = 3 * k + 1) {
      SetpointParams p = params();
      p.schedule = {{static_cast<double>(k) * (sample_time_s / 3600.0), two(60.0, 1900.0)}};
      const SetpointSource s = source(p, sample_time_s);
      Vector value(2);
      s.scheduled(k, value);
      // 1/3 s is not a whole number of nanoseconds: after 10,000 samples that is microseconds
      if (sample_time_s * 1e9 != std::round(sample_time_s * 1e9) && k > 1000) continue;
      EXPECT_EQ(value[1], 1900.0) << "step " << k << " of " << sample_time_s << " s";
      s.scheduled(k - 1, value);
      EXPECT_EQ(value[1], 2000.0) << "step " << k << " of " << sample_time_s << " s";
    }
  }
}

TEST(SetpointSource, LaterEntryOfTheSameTimeWins) {
  SetpointParams p = params();
  p.schedule = {{0.2, two(1.0, 2.0)}, {0.2, two(3.0, kNaN)}};
  SetpointSource s = source(p);
  EXPECT_EQ(s.advance(1), two(3.0, 2.0));
}

TEST(SetpointSource, EndlessTimeOfTheScheduleNeverComes) {
  SetpointParams p = params();
  p.schedule = {{1e300, two(1.0, 1.0)}};
  SetpointSource s = source(p);
  EXPECT_EQ(s.advance(10000000u), p.initial);
}

TEST(SetpointSource, CommandWithoutStampActsAtTheNextSample) {
  SetpointSource s = source(params());
  s.advance(6);
  EXPECT_EQ(s.command(command("x", 2100.0)), 7u);
  EXPECT_EQ(s.present()[1], 2000.0);
  EXPECT_EQ(s.advance(7)[1], 2100.0);
  ASSERT_EQ(s.effects().size(), 1u);
  EXPECT_EQ(s.effects()[0].header.step, 7u);
  EXPECT_EQ(s.effects()[0].header.time_ns, kZero + 7 * kSample);
  EXPECT_EQ(s.effects()[0].command.name[0], "x");
  s.advance(8);
  EXPECT_TRUE(s.effects().empty());
}

TEST(SetpointSource, StampIsTheEarliestTime) {
  SetpointSource s = source(params());
  s.advance(0);
  const std::int64_t t5 = kZero + 5 * kSample;
  EXPECT_EQ(s.command(command("x", 1.0, CommandMode::kOverride, t5 - 1)), 5u);
  EXPECT_EQ(s.command(command("x", 2.0, CommandMode::kOverride, t5 + 1)), 6u);
  EXPECT_EQ(s.command(command("x", 3.0, CommandMode::kOverride, t5)), 5u);
  EXPECT_EQ(s.command(command("s", 4.0, CommandMode::kOverride, kZero)), 1u);  // past: the next
  EXPECT_EQ(s.advance(1), two(4.0, 2000.0));
  EXPECT_EQ(s.advance(4)[1], 2000.0);
  EXPECT_EQ(s.advance(5)[1], 3.0);
  EXPECT_EQ(s.advance(6)[1], 2.0);
}

TEST(SetpointSource, StampsAreThePlantsWhenItsStartIsAnother) {
  SetpointSource s = source(params());
  const std::int64_t t0 = 1700000000123456789;
  s.command(command("x", 1.0, CommandMode::kOverride, t0 + 12 * kSample));
  s.anchor({t0 + 10 * kSample, 3, 10});
  EXPECT_EQ(s.advance(10)[1], 2000.0);
  EXPECT_EQ(s.command(command("s", 2.0, CommandMode::kOverride, t0 + 12 * kSample)), 12u);
  EXPECT_EQ(s.advance(11)[1], 2000.0);
  EXPECT_EQ(s.advance(12), two(2.0, 1.0));
  EXPECT_EQ(s.effects()[0].header.time_ns, t0 + 12 * kSample);
}

TEST(SetpointSource, OffsetsReplaceEachOtherAndFollowTheSchedule) {
  SetpointParams p = params();
  p.schedule = {{0.4, two(55.0, 1900.0)}};
  SetpointSource s = source(p);
  s.command(command("x", 10.0, CommandMode::kOffset));
  EXPECT_EQ(s.advance(0)[1], 2010.0);
  s.command(command("x", 20.0, CommandMode::kOffset));
  EXPECT_EQ(s.advance(1)[1], 2020.0);
  EXPECT_EQ(s.advance(2)[1], 1920.0);
  s.command(command("x", 7.0));
  EXPECT_EQ(s.advance(3)[1], 7.0);
  s.command(command("x", 0.0, CommandMode::kRelease));
  EXPECT_EQ(s.advance(4)[1], 1900.0);
}

TEST(SetpointSource, BeyondTheRangeOfThePlantIsRefusedAndBetweenThatAndTheLimitsClamped) {
  PlantInfo plant;
  plant.outputs = {{"s", "mg/l", 0.0, 5000.0}, {"x", "mg/l", 0.0, 10000.0}};
  SetpointParams p = params();
  p.upper = two(100.0, 2500.0);
  SetpointSource s(p, plant, SampleClock(720.0, kStart));
  for (int started = 0; started < 2; ++started) {
    EXPECT_THROW(s.command(command("x", 20000.0)), InputError);
    EXPECT_THROW(s.command(command("x", -10001.0, CommandMode::kOffset)), InputError);
    EXPECT_EQ(s.advance(static_cast<std::uint32_t>(started)), p.initial);
  }
  s.command(command("x", 3000.0));
  EXPECT_EQ(s.advance(2)[1], 2500.0);
}

TEST(SetpointSource, BadCommandThrowsAndChangesNothing) {
  SetpointSource s = source(params());
  for (int started = 0; started < 2; ++started) {
    EXPECT_THROW(s.command(command("y", 1.0)), InputError);
    EXPECT_THROW(s.command(command("x", kNaN)), InputError);
    EXPECT_THROW(s.command(command("x", 1.0, static_cast<CommandMode>(0))), InputError);
    EXPECT_THROW(s.command({0, {"s", "x"}, {1.0}, CommandMode::kOverride}), InputError);
    EXPECT_EQ(s.advance(static_cast<std::uint32_t>(started)), params().initial);
    EXPECT_TRUE(s.effects().empty());
  }
}

TEST(SetpointSource, ClampHoldsForScheduleCommandAndPreview) {
  SetpointParams p = params();
  p.lower = two(0.0, 1500.0);
  p.upper = two(100.0, kInfinity);
  p.schedule = {{0.2, two(-5.0, 1000.0)}};
  SetpointSource s = source(p);
  EXPECT_EQ(s.advance(1), two(0.0, 1500.0));
  s.command({0, {"s", "x"}, {1e9, 1e9}, CommandMode::kOverride});
  EXPECT_EQ(s.advance(2), two(100.0, 1e9));
  Vector value(2);
  s.scheduled(0, value);
  EXPECT_EQ(value, two(100.0, 1e9));
}

TEST(SetpointSource, RateLimitCountsTheHoursThatPassed) {
  SetpointParams p = params();
  p.rate_per_h = two(kInfinity, 50.0);  // 10 per sample
  p.schedule = {{0.2, two(60.0, 2100.0)}, {2.0, two(60.0, 0.0)}};
  SetpointSource s = source(p);
  s.advance(0);
  EXPECT_EQ(s.advance(1)[0], 60.0);
  EXPECT_NEAR(s.present()[1], 2010.0, 1e-9);
  EXPECT_NEAR(s.advance(2)[1], 2020.0, 1e-9);
  EXPECT_NEAR(s.advance(5)[1], 2050.0, 1e-9);   // samples 3 and 4 were lost
  EXPECT_NEAR(s.advance(10)[1], 2000.0, 1e-9);  // down since t = 2 h, with five samples of way
}

TEST(SetpointSource, FirstValueOfARunIsNotRateLimited) {
  SetpointParams p = params();
  p.rate_per_h = two(1.0, 1.0);
  p.schedule = {{1.0, two(90.0, 1500.0)}};
  SetpointSource s = source(p);
  EXPECT_EQ(s.advance(7), two(90.0, 1500.0));
  s.restart();
  EXPECT_EQ(s.advance(0), p.initial);
  s.reset();
  EXPECT_EQ(s.advance(5), two(90.0, 1500.0));
}

TEST(SetpointSource, UnlimitedRateStaysFiniteWhateverPasses) {
  SetpointSource s = source(params());
  s.advance(0);
  s.command({0, {"s", "x"}, {1e308, -1e308}, CommandMode::kOverride});
  EXPECT_EQ(s.advance(1), two(1e308, -1e308));
  s.command({0, {"s", "x"}, {-1e308, 1e308}, CommandMode::kOverride});
  EXPECT_EQ(s.advance(10000000u), two(-1e308, 1e308));
  EXPECT_EQ(s.advance(10000000u), two(-1e308, 1e308));
}

TEST(SetpointSource, RestartReleasesCommandsAndReplaysThoseOfTheParams) {
  SetpointParams p = params();
  p.commands = {command("x", 2200.0, CommandMode::kOverride, kZero + 2 * kSample)};
  SetpointSource s = source(p);
  s.command(command("s", 70.0));
  for (std::uint32_t k = 0; k < 2; ++k) EXPECT_EQ(s.advance(k), two(70.0, 2000.0));
  EXPECT_EQ(s.advance(2), two(70.0, 2200.0));
  s.command(command("s", 80.0, CommandMode::kOverride, kZero + 100 * kSample));
  s.restart();
  for (std::uint32_t k = 0; k < 2; ++k) EXPECT_EQ(s.advance(k), p.initial);
  EXPECT_EQ(s.advance(2), two(55.0, 2200.0));
  EXPECT_EQ(s.advance(101), two(55.0, 2200.0));
}

TEST(SetpointSource, RespawnedSourceContinuesWhatTheOperatorAsked) {
  SetpointParams p = params();
  p.commands = {command("x", 2200.0, CommandMode::kOverride, kZero + 2 * kSample)};
  SetpointSource first = source(p);
  first.advance(2);
  first.command(command("x", 1900.0));
  first.command(command("s", -5.0, CommandMode::kOffset));
  first.advance(3);
  ASSERT_EQ(first.inForce().size(), 2u);
  EXPECT_EQ(first.inForce()[0].mode, CommandMode::kOverride);
  EXPECT_EQ(first.inForce()[0].name[0], "x");

  SetpointSource second = source(p);
  for (const Command& c : first.inForce()) EXPECT_TRUE(second.restore(c));
  EXPECT_EQ(second.advance(10), first.advance(10));
  EXPECT_EQ(second.present(), two(50.0, 1900.0));
  EXPECT_FALSE(second.restore(command("x", 1.0)));  // a source that runs knows better
  EXPECT_EQ(second.advance(11), two(50.0, 1900.0));
}

TEST(SetpointSource, PreviewTouchesNoMemory) {
  SetpointParams p = params();
  p.rate_per_h = two(5.0, 5.0);
  p.schedule = {{1.0, two(60.0, 2100.0)}};
  SetpointSource s = source(p), untouched = source(p);
  s.advance(0);
  untouched.advance(0);
  Vector value(2);
  s.scheduled(5, value);
  EXPECT_EQ(value, two(60.0, 2100.0));  // asked, not rate-limited
  for (std::uint32_t k = 1; k < 8; ++k) EXPECT_EQ(s.advance(k), untouched.advance(k));
}

TEST(SetpointParams, ValidationNamesTheField) {
  EXPECT_EQ(messageOf(params()), "");
  SetpointParams p = params();
  p.initial = Vector::Zero(3);
  EXPECT_NE(messageOf(p).find("setpoint.initial"), std::string::npos);
  p = params();
  p.initial[0] = kNaN;
  EXPECT_NE(messageOf(p).find("setpoint.initial"), std::string::npos);
  p = params();
  p.schedule = {{1.0, two(1.0, 1.0)}, {0.5, two(1.0, 1.0)}};
  EXPECT_NE(messageOf(p).find("setpoint.schedule[1].time_h"), std::string::npos);
  p.schedule = {{-1.0, two(1.0, 1.0)}};
  EXPECT_NE(messageOf(p).find("setpoint.schedule[0].time_h"), std::string::npos);
  p.schedule = {{1.0, two(1.0, 1.0), 0.5}, {1.4, two(1.0, 1.0)}};
  EXPECT_NE(messageOf(p).find("setpoint.schedule[1].time_h"), std::string::npos);
  p.schedule = {{1.0, two(1.0, 1.0), -0.5}};
  EXPECT_NE(messageOf(p).find("setpoint.schedule[0].ramp_h"), std::string::npos);
  p.schedule = {{1.0, two(kInfinity, 1.0)}};
  EXPECT_NE(messageOf(p).find("setpoint.schedule[0].value"), std::string::npos);
  p = params();
  p.lower = Vector::Zero(1);
  EXPECT_NE(messageOf(p).find("setpoint.lower"), std::string::npos);
  p.lower = two(2.0, 2.0);
  p.upper = two(3.0, 1.0);
  EXPECT_NE(messageOf(p).find("setpoint.upper"), std::string::npos);
  p = params();
  p.rate_per_h = two(1.0, 0.0);
  EXPECT_NE(messageOf(p).find("setpoint.rate_per_h"), std::string::npos);
  p = params();
  p.commands = {command("nothing", 1.0)};
  EXPECT_THROW(source(p), InputError);
}

}  // namespace control_setpoint_source_test
}  // namespace fpc
