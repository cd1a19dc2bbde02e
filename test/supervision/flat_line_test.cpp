// A signal that shows the same number again: noise behind a resolution, motion, limits, records.
#include "supervision/flat_line.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>

#include "base/csv.hpp"

namespace fpc {
namespace control_flat_line_test {

struct Seen {
  int unlikely{0};  // readings
  int first{-1};    // the sample of the first one
};

Seen watch(FlatLine& line, int samples, const std::function<double(int)>& reading) {
  Seen seen;
  for (int k = 0; k < samples; ++k) {
    line.add(reading(k));
    if (!line.isUnlikely()) continue;
    if (seen.unlikely++ == 0) seen.first = k;
  }
  return seen;
}

/// A value that wanders slowly, with noise of `std`, shown in steps of `resolution`.
struct Instrument {
  double std{}, resolution{};
  std::mt19937_64 engine;
  std::normal_distribution<double> normal;
  Instrument(double noise, double step, unsigned seed)
      : std(noise), resolution(step), engine(seed) {}
  double operator()(int k) {
    const double value = 50.0 + 5.0 * std::sin(0.01 * k) + std * normal(engine);
    return resolution > 0.0 ? resolution * std::round(value / resolution) : value;
  }
};

TEST(FlatLine, NoiseBehindAResolutionIsNotAccusedAndAFrozenReadingIs) {
  for (const double resolution : {0.0, 0.1, 0.5, 1.0})
    for (unsigned seed = 1; seed <= 20; ++seed) {
      Instrument instrument(1.0, resolution, seed);
      FlatLine line;
      EXPECT_EQ(watch(line, 20000, std::ref(instrument)).unlikely, 0) << resolution << " " << seed;
      const double last = instrument(20000);
      const Seen frozen = watch(line, 300, [&](int) { return last; });
      EXPECT_GT(frozen.first, 2) << resolution << " " << seed;
      EXPECT_LE(frozen.first, resolution > 0.5 ? 90 : 40) << resolution << " " << seed;
    }
}

TEST(FlatLine, ATrulyQuietSignalIsNotAccused) {
  for (const double resolution : {5.0, 20.0})  // a fifth and a twentieth of it is noise
    for (unsigned seed = 1; seed <= 20; ++seed) {
      Instrument instrument(1.0, resolution, seed);
      FlatLine line;
      EXPECT_EQ(watch(line, 50000, std::ref(instrument)).unlikely, 0) << resolution << " " << seed;
    }
}

TEST(FlatLine, MotionThatComesToRestIsNoFault) {
  const std::function<double(int)> courses[] = {
      [](int k) { return 3.0 + std::exp(-0.1 * k); },                          // a first-order lag
      [](int k) { return std::exp(-0.05 * k) * std::cos(0.7 * k); },           // ringing
      [](int k) { return std::pow(-0.9, k); },                                 // from side to side
      [](int k) { return k < 200 ? std::sin(0.1 * k) : 0.3; },                 // cut short
      [](int k) { return k < 200 ? (k % 2 == 0 ? 1.0 : 2.0) : 2.0; },          // to and fro
      [](int k) { return k < 200 ? static_cast<double>(k / 10) : 19.0; },      // a staircase
      [](int k) { return std::round(1000.0 * (3.0 + std::exp(-0.01 * k))); },  // a coarse lag
      [](int k) { return static_cast<float>(0.1 + std::exp(-0.1 * k)); },
  };
  for (const auto& course : courses) {
    FlatLine line;
    EXPECT_EQ(watch(line, 5000, course).unlikely, 0) << &course - &courses[0];
  }
}

/// An aggressive law turns a deviation from side to side until rounding is left, which then stops.
TEST(FlatLine, AnOscillationThatDiesOutIsNoNoise) {
  for (double ratio = 0.1; ratio < 0.96; ratio += 0.05)
    for (const double rest : {0.05, 1.0, 300.0}) {
      FlatLine line;
      const auto course = [&](int k) {
        if (k % 1000 < 200) return k % 5 < 2 ? rest : std::nextafter(rest, 1000.0);
        return rest + 0.04 * rest * std::pow(-ratio, k % 1000 - 200);
      };
      EXPECT_EQ(watch(line, 5000, course).unlikely, 0) << ratio << " " << rest;
    }
}

TEST(FlatLine, AReadingThatComesTwiceInMotionIsRepeated) {
  const auto motion = [](int k) { return 50.0 + 5.0 * std::sin(0.05 * k); };
  FlatLine line;
  int found = 0, wrong = 0;
  for (int k = 0; k < 1000; ++k) {
    const bool again = k > 100 && k % 10 == 0;
    line.add(motion(again ? k - 1 : k));
    found += again && line.isRepeated() ? 1 : 0;
    wrong += !again && line.isRepeated() ? 1 : 0;
    EXPECT_FALSE(line.isUnlikely()) << k;
  }
  EXPECT_GT(found, 80) << "of 89; at an end of the sine there is no motion";
  EXPECT_EQ(wrong, 0);
  for (int k = 0; k < 20; ++k) line.add(54.0);
  EXPECT_FALSE(line.isRepeated()) << "it has come to a limit";

  FlatLine early;  // a step response, as soon as it can be told from a staircase
  for (int k = 0; k < 60; ++k) {
    const bool again = k > 0 && k % 10 == 0;
    early.add(1.0 - std::pow(0.9, again ? k - 1 : k));
    EXPECT_EQ(early.isRepeated(), again) << k;
  }

  FlatLine coarse;  // whole numbers
  for (int k = 0; k < 1000; ++k) {
    coarse.add(std::round(50.0 + 0.7 * k));
    EXPECT_FALSE(coarse.isRepeated()) << k;
  }
}

TEST(FlatLine, TheLargestAndTheSmallestValueSoFarMayBeLimits) {
  std::mt19937_64 engine(3);
  std::normal_distribution<double> noise(0.0, 1.0);
  FlatLine line;
  watch(line, 200, [&](int) { return std::min(10.0, 8.0 + noise(engine)); });
  watch(line, 100, [&](int) { return 10.0; });
  EXPECT_TRUE(line.isUnlikely());
  EXPECT_TRUE(line.isAtExtreme());
  line.add(9.0);
  EXPECT_FALSE(line.isAtExtreme());
  line.add(-10.0);
  EXPECT_TRUE(line.isAtExtreme());
}

TEST(FlatLine, ShiftAndScaleChangeNothing) {
  for (const double scale : {1e-3, 1.0, 512.0, -4.0})
    for (const double shift : {0.0, 64.0}) {
      Instrument instrument(1.0, 0.25, 5);
      FlatLine plain, other;
      for (int k = 0; k < 400; ++k) {
        const double value = k < 300 ? instrument(k) : 50.0;
        plain.add(value);
        other.add(scale == 1e-3 ? value * 0.0009765625 + shift : value * scale + shift);
        EXPECT_EQ(plain.isUnlikely(), other.isUnlikely()) << k << " " << scale << " " << shift;
      }
      EXPECT_TRUE(plain.isUnlikely());
    }
}

// Columns of public records that instruments have shown; ends of scales that the records state.
TEST(FlatLine, NoSignalOfThePublicRecordsIsAccused) {
  const char* folder = std::getenv("FMBPC_DATA");
  if (!folder) GTEST_SKIP() << "needs ${FMBPC_DATA}";
  int columns = 0;
  for (const char* name : {"box_jenkins_gas_furnace", "bsm1_influent_dry", "bsm1_influent_rain",
                           "cascaded_tanks_estimation", "coupled_drives_1_estimation",
                           "coupled_drives_2_estimation", "daisy_cstr", "daisy_destill",
                           "daisy_heating_system", "daisy_powerplant", "uci_wwtp_daily"}) {
    const CsvTable table = readCsv(std::string(folder) + "/" + name + ".csv");
    for (std::size_t column = 0; column < table.names.size(); ++column) {
      FlatLine line;
      int accused = 0;
      for (const double value : table.values.col(static_cast<Eigen::Index>(column))) {
        if (!std::isfinite(value)) continue;
        line.add(value);
        const bool at_end = line.isAtExtreme();
        accused += line.isUnlikely() && !at_end ? 1 : 0;
      }
      ++columns;
      EXPECT_EQ(accused, 0) << name << ": " << table.names[column];
    }
  }
  EXPECT_GT(columns, 100);
}

}  // namespace control_flat_line_test
}  // namespace fpc
