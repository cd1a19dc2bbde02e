// What no plan foresees: a law that has locked itself up, and a burst of influent that does not
// come again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>

#include "runtime/run.hpp"
#include "study/run_judgement.hpp"

namespace fpc {
namespace paper_asp_events_test {

struct Case {
  const char* bound;
  int seed;
};

constexpr Case kLocking[] = {{"1600", 5},  {"1600", 13}, {"1600", 28}, {"1600", 34},
                             {"1600", 36}, {"3000", 13}, {"3000", 27}, {"3000", 35}};
constexpr int kWithin = 20;  // samples: no lock-up lasts so long

/// Case C with a model of our own: the published law pushes the recirculation over the top of the
/// static curve. Which runs of seeds 1-40 stay there was found by a study.
/// The longest lock-up of a run of at least kWithin samples.
std::uint64_t lockedIn(const Case& c, bool guarded) {
  Overrides set{{"actuator.input_upper.q_r", c.bound}, {"seed", std::to_string(c.seed)}};
  if (!guarded) set.emplace_back("guard", "false");
  const LoopFile loop = readLoop("asp_case_c_own", set);
  return lockedSamples(loop, runLoop(loop), kWithin);
}

TEST(LockUp, IsLeftWithinAStatedNumberOfSamples) {
  const std::size_t every = std::getenv("FMBPC_LONG_TESTS") != nullptr ? 1 : 4;
  for (std::size_t i = 0; i < std::size(kLocking); i += every) {
    const Case& c = kLocking[i];
    const std::uint64_t without = lockedIn(c, false), with = lockedIn(c, true);
    std::printf("up to %s m3/h, seed %d: locked over %llu samples, with the guard %llu\n", c.bound,
                c.seed, static_cast<unsigned long long>(without),
                static_cast<unsigned long long>(with));
    EXPECT_GT(without, 83U) << c.bound << ", seed " << c.seed;  // a tenth of the run
    EXPECT_EQ(with, 0U) << c.bound << ", seed " << c.seed;
  }
}

/// Inputs of asp_best over 80 h, the influent's flow at 2300 m3/h from 50 to 52 h or not. The guard
/// looks at the present sample only: what it does ahead comes on top (docs/comparisons.md).
std::vector<double> inputsOf(const char* memory_h, bool burst) {
  Overrides keys{{"sampling.duration_h", "80"},
                 {"controller.forecast_memory_h", memory_h},
                 {"guard.look_ahead", "0"}};
  if (burst)
    keys.emplace_back(
        "disturbance.commands",
        "[{time_h: 50, name: q_i, value: 2300}, {time_h: 52, name: q_i, mode: release}]");
  std::vector<double> inputs;
  for (const auto& sample : runLoop(readLoop("asp_best", keys)).samples)
    if (sample.has_action) inputs.push_back(sample.action.input[0]);
  return inputs;
}

/// How far the burst moves the input a day later, 16 to 28 h after it.
double echoOf(const char* memory_h) {
  const std::vector<double> quiet = inputsOf(memory_h, false), moved = inputsOf(memory_h, true);
  double echo = 0.0;
  for (std::size_t k = 340; k < std::min(quiet.size(), moved.size()); ++k)
    echo = std::max(echo, std::abs(moved[k] - quiet[k]));
  return echo;
}

TEST(Burst, IsNotExpectedAgainAsMuchByALawThatLearnsWhatItsForecastIsWorth) {
  const double trusting = echoOf("0"), learning = echoOf("24");
  std::printf("a day after the burst: %.0f m3/h, with a memory %.0f\n", trusting, learning);
  EXPECT_GT(trusting, 300.0);
  EXPECT_LE(learning, 2.0 / 3.0 * trusting);
}

}  // namespace paper_asp_events_test
}  // namespace fpc
