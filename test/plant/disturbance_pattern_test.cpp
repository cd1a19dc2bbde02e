#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "plant/disturbance.hpp"

namespace fpc {
namespace plant_disturbance_pattern_test {

const std::vector<std::string> kNames{"q_i", "s_i"};
const Vector kNominal = Eigen::Vector2d(1300.0, 366.67);
constexpr double kSampleTime_s = 720.0;

PatternParams pattern(std::uint64_t seed) {
  return {seed, {{"q_i", "flow", 700.0, 2300.0, 1300.0}, {"s_i", "load", 150.0, 650.0, 366.67}}};
}

Matrix valuesOf(const PatternParams& params, std::uint32_t samples = 830) {
  return makePattern(params, kNames, kNominal, kSampleTime_s, samples).values;
}

TEST(DisturbancePattern, FillsItsRangeWithTheWantedMeanForEverySeed) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    PatternParams params = pattern(seed);
    params.channels[1].mean = seed % 2 == 0 ? 430.0 : 366.67;
    const Matrix values = valuesOf(params);
    ASSERT_EQ(values.cols(), 831);
    for (Eigen::Index i = 0; i < 2; ++i) {
      const PatternChannel& channel = params.channels[static_cast<std::size_t>(i)];
      EXPECT_NEAR(values.row(i).minCoeff(), channel.lower, 1e-9) << "seed " << seed;
      EXPECT_NEAR(values.row(i).maxCoeff(), channel.upper, 1e-9) << "seed " << seed;
      EXPECT_NEAR(values.row(i).mean(), channel.mean, 1e-9 * channel.mean) << "seed " << seed;
    }
  }
}

TEST(DisturbancePattern, TheSeedAloneDecides) {
  EXPECT_EQ(valuesOf(pattern(3)), valuesOf(pattern(3)));
  EXPECT_NE(valuesOf(pattern(3)), valuesOf(pattern(4)));
  EXPECT_NE(valuesOf(pattern(3)), valuesOf(pattern(3 + (1ULL << 40U))));
}

// The daily sine of the flow is at its top at 9 h + 6 h, that of the load at 11 h + 6 h: correlate
// with both phases.
TEST(DisturbancePattern, TheDayIsWhereTheFormulaPutsIt) {
  const double pi = std::acos(-1.0);
  const auto phase_h = [&](Eigen::Index row) {
    double in = 0.0, quadrature = 0.0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const Matrix values = valuesOf(pattern(seed), 24 * 7 * 5);
      for (Eigen::Index k = 0; k < 24 * 7 * 5; ++k) {
        const double angle = 2.0 * pi * static_cast<double>(k) * 0.2 / 24.0;
        in += (values(row, k) - kNominal[row]) * std::sin(angle);
        quadrature += (values(row, k) - kNominal[row]) * std::cos(angle);
      }
    }
    return -std::atan2(quadrature, in) * 24.0 / (2.0 * pi);  // sin(2 pi (t - phase)/24)
  };
  EXPECT_NEAR(phase_h(0), 9.0, 1.0);
  EXPECT_NEAR(phase_h(1), 11.0, 1.0);
}

TEST(DisturbancePattern, FlowAndLoadHaveDifferentNoise) {
  PatternParams same = pattern(1);
  same.channels[1].shape = "flow";
  const Matrix flows = valuesOf(same);
  EXPECT_NE(((flows.row(0).array() - 700.0) / 1600.0).matrix(),
            ((flows.row(1).array() - 150.0) / 500.0).matrix());
}

TEST(DisturbancePattern, AChannelDoesNotDependOnTheOtherOrOnTheirOrder) {
  PatternParams swapped = pattern(5), alone = pattern(5);
  std::swap(swapped.channels[0], swapped.channels[1]);
  alone.channels.erase(alone.channels.begin());
  EXPECT_EQ(valuesOf(swapped), valuesOf(pattern(5)));
  EXPECT_EQ(valuesOf(alone).row(1), valuesOf(pattern(5)).row(1));
}

TEST(DisturbancePattern, OtherDisturbancesStayNominal) {
  PatternParams params = pattern(1);
  params.channels.pop_back();
  const Matrix values = valuesOf(params);
  EXPECT_EQ(values.row(1), Matrix::Constant(1, 831, 366.67));
}

TEST(DisturbancePattern, BetweenFullHoursTheShapeIsInterpolated) {
  PatternParams params = pattern(2);
  params.channels.resize(1);
  const Matrix fine = makePattern(params, kNames, kNominal, 3600.0 / 8.0, 8 * 48).values;
  const Matrix coarse = makePattern(params, kNames, kNominal, 3600.0, 48).values;
  // A power keeps the order of values: inside an hour everything lies between its ends.
  for (Eigen::Index h = 0; h < 48; ++h) {
    const double low = std::min(fine(0, 8 * h), fine(0, 8 * h + 8));
    const double high = std::max(fine(0, 8 * h), fine(0, 8 * h + 8));
    for (Eigen::Index i = 0; i <= 8; ++i)
      EXPECT_TRUE(fine(0, 8 * h + i) >= low && fine(0, 8 * h + i) <= high) << h << " " << i;
    EXPECT_EQ(fine(0, 8 * h) < fine(0, 8 * h + 8), coarse(0, h) < coarse(0, h + 1)) << h;
  }
}

TEST(DisturbancePattern, AShortRunTakesTheStartOfADay) {
  const Matrix day = valuesOf(pattern(1), 120);
  EXPECT_EQ(valuesOf(pattern(1), 10), day.leftCols(11));
  EXPECT_EQ(valuesOf(pattern(1), 1), day.leftCols(2));
}

std::string errorOf(const std::function<void(PatternParams&)>& spoil, std::uint32_t samples = 830) {
  PatternParams params = pattern(1);
  spoil(params);
  try {
    valuesOf(params, samples);
  } catch (const InputError& e) {
    return e.what();
  }
  return "nothing was thrown";
}

TEST(DisturbancePattern, ErrorsNameChannelAndField) {
  using P = PatternParams;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expectWords = [](const std::string& error, const std::string& words) {
    EXPECT_NE(error.find(words), std::string::npos) << error;
  };
  expectWords(errorOf([](P& p) { p.channels[0].name = "q"; }), "'q': expected one of q_i, s_i");
  expectWords(errorOf([](P& p) { p.channels[1].name = "q_i"; }), "only once");
  expectWords(errorOf([](P& p) { p.channels[0].shape = "sine"; }), "'q_i': shape");
  expectWords(errorOf([&](P& p) { p.channels[0].lower = nan; }), "'q_i': lower");
  expectWords(errorOf([](P& p) { p.channels[1].upper = 100.0; }), "'s_i': upper");
  expectWords(errorOf([](P& p) { p.channels[1].mean = 650.0; }), "'s_i': mean");
  expectWords(errorOf([](P& p) { p.channels[1].mean = 649.9999; }), "'s_i': mean");
  expectWords(errorOf([](P&) {}, 0), "duration");
}

TEST(DisturbancePattern, ADayOfTinySamplesIsRefusedBeforeItIsMade) {
  try {
    makePattern(pattern(1), {"q_i", "s_i"}, Vector::Zero(2), 1e-4, 36);
    FAIL() << "864 million samples";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("sampling.sample_time_s"), std::string::npos) << e.what();
  }
}

}  // namespace plant_disturbance_pattern_test
}  // namespace fpc
