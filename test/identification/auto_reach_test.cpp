// Processes that integrate, are unstable by themselves or answer the wrong way first: judged by
// runs of a few samples.
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "identification/auto_data.hpp"
#include "identification/auto_identify.hpp"
#include "identification/pair_data.hpp"
#include "identification/validation.hpp"

namespace fpc {
namespace identification_auto_reach_test {

using Eigen::Index;

Index reach(const DataSet& data) { return reachOf(prepareAuto(data, 0, 4, 2000, 8000)); }

/// y(k+1) = pole y(k) + (1 - pole) u(k), u held for random whiles; measured with noise.
DataSet stable(double pole, double noise, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Matrix values(600, 2);
  double y = 0.0, u = 0.0;
  for (Index k = 0; k < values.rows(); ++k) {
    if (uniform(random) < 0.1) u = 2.0 * uniform(random) - 1.0;
    values.row(k) << y + noise * standardNormal(random), u;
    y = pole * y + (1.0 - pole) * u;
  }
  return pairData(values);
}

/// Unstable by itself, held by a proportional law with a dither.
DataSet unstable(double pole, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Matrix values(600, 2);
  double y = 0.0, dither = 0.0;
  for (Index k = 0; k < values.rows(); ++k) {
    if (k % 6 == 0) dither = 2.0 * uniform(random) - 1.0;
    const double measured = y + 0.01 * standardNormal(random);
    const double u = dither - 0.8 * measured;
    values.row(k) << measured, u;
    y = pole * y + 0.5 * u + 0.02 * standardNormal(random);
  }
  return pairData(values);
}

/// A level that first swells: integral of u less a lag of it, about its rest by a weak law.
DataSet swell(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Matrix values(600, 2);
  double level = 0.0, lag = 0.0, u = 0.0;
  for (Index k = 0; k < values.rows(); ++k) {
    const double measured = level - 2.0 * lag + 0.02 * standardNormal(random);
    if (k % 5 == 0) u = 2.0 * uniform(random) - 1.0 - 0.1 * measured;
    values.row(k) << measured, u;
    level += 0.1 * u;
    lag = 0.8 * lag + 0.2 * u;
  }
  return pairData(values);
}

TEST(AutoReach, OfAStableProcessRunsAreFree) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    for (const double pole : {0.0, 0.5, 0.9, 0.98})
      for (const double noise : {0.001, 0.1})
        EXPECT_EQ(reach(stable(pole, noise, seed)), 0) << pole << ", " << noise << ", " << seed;
}

TEST(AutoReach, AProcessThatIntegratesOrIsUnstableIsJudgedByShortRuns) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    EXPECT_EQ(reach(swell(seed)), 30) << seed;
    EXPECT_NEAR(static_cast<double>(reach(unstable(1.3, seed))), 11.0, 2.0) << seed;
  }
}

AutoIdentification searched(const DataSet& data) {
  AutoParams params;
  params.work = 1.5;
  return autoIdentify(data, params);
}

double slowestPole(const TsModel& model) {
  return std::abs(ruleDynamics(model).front().poles.front());
}

TEST(AutoReach, AnUnstablePoleIsFound) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const AutoIdentification found = searched(unstable(1.3, seed));
    EXPECT_GT(found.reach, 0);
    EXPECT_NEAR(slowestPole(found.linear), 1.3, 0.06) << seed;
    EXPECT_GT(found.outputs[0].linear.fit, 50.0) << found.outputs[0].verdict;
    EXPECT_LT(found.outputs[0].linear.free_run, 0.5 * found.outputs[0].hold);
  }
}

TEST(AutoReach, AnInverseResponseIsNoDelay) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const AutoIdentification found = searched(swell(seed));
    EXPECT_EQ(found.outputs[0].delay[0], 0) << seed;
    EXPECT_NEAR(slowestPole(found.linear), 1.0, 0.02) << seed;
    EXPECT_LT(found.outputs[0].linear.free_run, 0.5 * found.outputs[0].hold);
  }
}

}  // namespace identification_auto_reach_test
}  // namespace fpc
