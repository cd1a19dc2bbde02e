// Frozen sensors, changes of unit and inputs that move together: found, and not where all is well.
#include "identification/record_faults.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "base/csv.hpp"
#include "base/random.hpp"
#include "identification/record_remarks.hpp"

namespace fpc {
namespace identification_record_faults_test {

using Eigen::Index;

/// y(k+1) = 0.9 y(k) + 0.1 (u + v)(k) around `rest`, u and v held for random whiles.
DataSet recordOf(Index rows, std::uint64_t seed, double noise = 0.01, double rest = 5.0) {
  std::mt19937_64 random(seed);
  DataSet data;
  data.source = "made up";
  data.sample_time_s = 1.0;
  data.values.resize(rows, 3);
  double y = 0.0, u = 0.0, v = 0.0;
  for (Index k = 0; k < rows; ++k) {
    if (uniform(random) < 0.15) u = 2.0 * uniform(random) - 1.0;
    if (uniform(random) < 0.15) v = 2.0 * uniform(random) - 1.0;
    data.values.row(k) << rest + y + noise * standardNormal(random), rest + u, v;
    y = 0.9 * y + 0.1 * (u + v);
  }
  const auto info = [&](const char* name, Index c) {
    return SignalInfo{name, "", data.values.col(c).minCoeff(), data.values.col(c).maxCoeff()};
  };
  data.outputs = {info("y", 0)};
  data.inputs = {info("u", 1), info("v", 2)};
  data.constant.assign(3, false);
  return data;
}

TEST(RecordFaults, GoodRecordsHaveNone) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed)
    for (const double noise : {0.0, 0.01, 0.1})
      for (const double rest : {0.0, 5.0}) {
        const auto remarks = faultRemarks(recordOf(400, seed, noise, rest));
        EXPECT_TRUE(remarks.empty()) << "seed " << seed << ": " << remarks.front();
      }
}

TEST(RecordFaults, AFrozenSensorIsFoundAndLeftOut) {
  DataSet data = recordOf(600, 3);
  data.values.col(0).segment(200, 150).setConstant(data.values(200, 0));
  const auto frozen = frozenRows(data, 0);
  ASSERT_EQ(frozen.size(), 1U);
  EXPECT_EQ(frozen[0].first, 200);
  EXPECT_EQ(frozen[0].last, 350);
  EXPECT_EQ(withoutOutliers(data).values.col(0).array().isNaN().count(), 149);
}

/// Each column of each public record as the output, the others as inputs, sound and with a stretch
/// of it frozen somewhere.
TEST(RecordFaults, FrozenStretchesOfPublicRecordsAreFoundAndHealthyOnesNotAccused) {
  const char* folder = std::getenv("FMBPC_DATA");
  if (!folder) GTEST_SKIP() << "FMBPC_DATA names no folder of public records";
  std::mt19937_64 random(1);
  int columns = 0, accused = 0, frozen = 0, found = 0;
  std::set<std::string> files;  // in an order of their own: the draws are the same everywhere
  for (const auto& file : std::filesystem::directory_iterator(folder))
    if (file.path().extension() == ".csv") files.insert(file.path().string());
  for (const std::string& file : files) {
    const Matrix values = readCsv(file).values;
    for (Index c = 0; c < values.cols(); ++c, ++columns) {
      DataSet data;
      data.values = values;
      data.values.col(0).swap(data.values.col(c));
      data.outputs = {{"y", "", 0.0, 1.0}};
      data.inputs.assign(static_cast<std::size_t>(values.cols()) - 1, {"u", "", 0.0, 1.0});
      accused += frozenRows(data, 0).empty() ? 0 : 1;
      for (int n = 0; n < 10 && values.rows() > 200; ++n) {
        DataSet spoilt = data;
        const auto first =
            static_cast<Index>(uniform(random) * static_cast<double>(values.rows() - 50));
        if (!std::isfinite(data.values(first, 0))) continue;
        spoilt.values.col(0).segment(first, 50).setConstant(data.values(first, 0));
        ++frozen;
        found += frozenRows(spoilt, 0).empty() ? 0 : 1;
      }
    }
  }
  RecordProperty("columns", columns);
  RecordProperty("frozen", frozen);
  RecordProperty("found", found);
  EXPECT_GT(columns, 100);
  EXPECT_EQ(accused, 0);
  EXPECT_GT(found, 2 * frozen / 3);
}

TEST(RecordFaults, ASensorAtItsLimitAtRestOrOfLowResolutionIsNotFrozen) {
  DataSet limited = recordOf(600, 4, 0.05);
  limited.values.col(0) = limited.values.col(0).cwiseMin(5.1);
  EXPECT_TRUE(frozenRows(limited, 0).empty());
  DataSet coarse = recordOf(600, 5, 0.01);
  coarse.values.col(0) = (coarse.values.col(0) * 5.0).array().round() / 5.0;
  EXPECT_TRUE(frozenRows(coarse, 0).empty());
  DataSet resting = recordOf(600, 6, 0.01);
  resting.values.block(200, 0, 100, 3).rowwise() = resting.values.row(200).eval();
  EXPECT_TRUE(frozenRows(resting, 0).empty()) << "no input moved";
  EXPECT_TRUE(frozenRows(resting, 1).empty()) << "an input may rest";
}

TEST(RecordFaults, AChangeOfUnitHalfWayIsFoundWithItsFactor) {
  for (const double factor : {1000.0, 10.0, 0.001, 60.0}) {
    DataSet data = recordOf(600, 7);
    data.values.col(0).tail(300) *= factor;
    const UnitChange change = unitChange(data.values.col(0));
    EXPECT_EQ(change.row, 300) << factor;
    EXPECT_NEAR(change.factor / factor, 1.0, 1e-9);
    EXPECT_EQ(unitChange(data.values.col(1)).row, 0);
  }
}

TEST(RecordFaults, AStepToAnotherLevelIsNoChangeOfUnit) {
  DataSet data = recordOf(600, 9);
  data.values.col(0).tail(300).array() += 50.0;
  EXPECT_EQ(unitChange(data.values.col(0)).row, 0);
}

TEST(RecordFaults, InputsThatMoveTogetherAreTold) {
  DataSet data = recordOf(400, 10);
  std::mt19937_64 random(1);
  for (Index k = 0; k < data.rows(); ++k)
    data.values(k, 2) = 0.5 * data.values(k, 1) + 0.01 * standardNormal(random);
  const auto found = collinearCauses(data);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].column, 1);
  EXPECT_EQ(found[0].partner, 2);
  EXPECT_GT(found[0].share, 0.99);
}

}  // namespace identification_record_faults_test
}  // namespace fpc
