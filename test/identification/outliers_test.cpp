// Spikes and bursts of sensors, misprinted inputs: found, and nothing else is.
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "identification/record_remarks.hpp"

namespace fpc {
namespace fuzzy_outliers_test {

using Eigen::Index;
using Rows = std::vector<Index>;

/// y(k+1) = pole y(k) + (1 - pole) u(k), u held for a random while.
DataSet recordOf(double pole, Index rows, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  DataSet data;
  data.source = "made up";
  data.sample_time_s = 1.0;
  data.values.resize(rows, 2);
  double y = 0.0, u = 0.0;
  Index until = 0;
  for (Index k = 0; k < rows; ++k) {
    if (k >= until) {
      u = 4.0 * uniform(random) - 2.0;
      until = k + 2 + static_cast<Index>(20.0 * uniform(random));
    }
    data.values.row(k) << y + 0.02 * standardNormal(random), u;
    y = pole * y + (1.0 - pole) * u;
  }
  data.outputs = {{"y", "", data.values.col(0).minCoeff(), data.values.col(0).maxCoeff()}};
  data.inputs = {{"u", "", -2.0, 2.0}};
  data.constant.assign(2, false);
  return data;
}

TEST(Outliers, OfGoodRecordsAreNone) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed)
    for (const double pole : {0.0, 0.5, 0.9}) {
      const auto found = outliersOf(recordOf(pole, 300, seed));
      EXPECT_TRUE(found[0].empty() && found[1].empty()) << "seed " << seed << ", pole " << pole;
    }
}

TEST(Outliers, ASmoothPeakIsNone) {
  // as an output without noise passes a load
  Vector y(400);
  for (Index k = 0; k < y.size(); ++k) {
    const double t = static_cast<double>(k) - 200.0;
    y[k] = 1.7 * std::exp(-0.5 * std::pow(t / 3.0, 2.0)) - 0.4 * std::cos(t / 15.0);
  }
  EXPECT_TRUE(outliersOf(y).empty());
}

TEST(Outliers, InPairsAndBurstsAreFound) {
  const DataSet good = recordOf(0.9, 400, 3);
  for (const Index length : {1, 2, 3, 5}) {
    DataSet data = good;
    Rows expected;
    for (Index k = 200; k < 200 + length; ++k) {
      data.values(k, 0) += 25.0;
      expected.push_back(k);
    }
    EXPECT_EQ(outliersOf(data)[0], expected) << length;
    const DataSet clean = withoutOutliers(data);
    EXPECT_EQ(clean.values.col(0).array().isNaN().count(), length);
    EXPECT_LT(clean.outputs[0].upper, 3.0) << "the range is that of the samples that are left";
  }
}

TEST(Outliers, OfBothSignsBesideEachOtherAreFound) {
  DataSet data = recordOf(0.9, 400, 4);
  data.values(100, 0) += 30.0;
  data.values(101, 0) -= 30.0;
  EXPECT_EQ(outliersOf(data)[0], (Rows{100, 101}));
}

TEST(Outliers, LongerThanABurstAreTakenForTheProcess) {
  DataSet data = recordOf(0.9, 400, 3);
  data.values.col(0).segment(200, 6).array() += 25.0;
  EXPECT_TRUE(outliersOf(data)[0].empty());
}

/// The process answers to what is in column u, or to `u` without its spike.
DataSet spiked(bool real, std::uint64_t seed) {
  DataSet data = recordOf(0.9, 400, seed);
  const Matrix as_it_was = data.values;
  data.values(150, 1) = 60.0;
  const Matrix& acts = real ? data.values : as_it_was;
  std::mt19937_64 random(seed);
  double y = 0.0;
  for (Index k = 0; k < 400; ++k) {
    data.values(k, 0) = y + 0.02 * standardNormal(random);
    y = 0.9 * y + 0.1 * acts(k, 1);
  }
  data.inputs[0].upper = 60.0;
  return data;
}

TEST(Outliers, OfInputsAreThoseThatNoOutputNotices) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const DataSet misprint = spiked(false, seed), pulse = spiked(true, seed);
    EXPECT_EQ(outliersOf(misprint)[1], Rows{150}) << seed;
    EXPECT_TRUE(outliersOf(pulse)[1].empty()) << seed;
    EXPECT_TRUE(outliersOf(pulse)[0].empty()) << seed;
    const DataSet clean = withoutOutliers(misprint);
    EXPECT_TRUE(clean.values.allFinite()) << "a free run goes on";
    EXPECT_LE(clean.inputs[0].upper, 2.0);
  }
}

TEST(Outliers, ThatFollowAPulseOfAnInputAreItsEffect) {
  // nothing but one pulse of three samples, and a process without memory
  DataSet data = recordOf(0.0, 300, 5);
  std::mt19937_64 random(5);
  for (Index k = 0; k < 300; ++k) {
    data.values(k, 1) = 0.01 * standardNormal(random) + (k >= 100 && k < 103 ? 5.0 : 0.0);
    data.values(k, 0) = 0.01 * standardNormal(random) + (k > 0 ? 2.0 * data.values(k - 1, 1) : 0.0);
  }
  const auto found = outliersOf(data);
  EXPECT_TRUE(found[0].empty());
  EXPECT_TRUE(found[1].empty());
}

TEST(Outliers, PeaksThatTheInputsExplainAreKept) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    DataSet data = recordOf(0.0, 400, seed);  // an output that answers to changes of u alone
    std::mt19937_64 random(seed);
    data.values.col(1).head(9).setConstant(data.values(8, 1));  // the first rows have no past
    double before = data.values(0, 1);
    for (Index k = 0; k + 1 < 400; ++k) {
      data.values(k + 1, 0) = 3.0 * (data.values(k, 1) - before) + 0.02 * standardNormal(random);
      before = data.values(k, 1);
    }
    EXPECT_TRUE(outliersOf(data)[0].empty()) << "seed " << seed;
    data.values(200, 0) += 25.0;
    EXPECT_EQ(outliersOf(data)[0], Rows{200}) << "seed " << seed;
  }
}

}  // namespace fuzzy_outliers_test
}  // namespace fpc
