// Remarks on records: each where it is due, and not where it is not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "identification/auto_identify.hpp"
#include "identification/pair_data.hpp"
#include "identification/record_remarks.hpp"

namespace fpc {
namespace fuzzy_remarks_test {

using Eigen::Index;

DataSet recordOf(const Matrix& values) { return pairData(values, 2.0); }

bool contains(const std::vector<std::string>& remarks, const std::string& words) {
  return std::any_of(remarks.begin(), remarks.end(),
                     [&](const std::string& r) { return r.find(words) != std::string::npos; });
}

/// y(k+1) = pole y(k) + (1 - pole) u(k), u at random levels for five samples.
Matrix lag(double pole, Index rows, double noise) {
  std::mt19937_64 random(4);
  Matrix values(rows, 2);
  double y = 0.0, u = 0.0;
  for (Index k = 0; k < rows; ++k) {
    if (k % 5 == 0) u = standardNormal(random);
    values.row(k) << y + noise * standardNormal(random), u;
    y = pole * y + (1.0 - pole) * u;
  }
  return values;
}

TsModel firstOrder(const DataSet& data, double pole) {
  TsModel model;
  model.sample_time_s = data.sample_time_s;
  model.outputs = data.outputs;
  model.inputs = data.inputs;
  OutputModel submodel;
  submodel.regressors = {{SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, 0}};
  submodel.rules = {{{}, (Vector(2) << pole, 1.0 - pole).finished(), 0.0, 0}};
  model.submodels = {submodel};
  return model;
}

TEST(RecordRemarks, AreNoneForAGoodRecord) {
  const DataSet data = recordOf(lag(0.9, 400, 0.02));
  const TsModel linear = firstOrder(data, 0.9);
  EXPECT_TRUE(recordRemarks(data, &linear).empty());
}

TEST(RecordRemarks, TellASampleTimeTooShortOrTooLong) {
  const DataSet data = recordOf(lag(0.9, 400, 0.02));
  const auto told = [&](double pole) {
    const TsModel linear = firstOrder(data, pole);
    return recordRemarks(data, &linear);
  };
  EXPECT_TRUE(contains(told(0.999), "sample time of 2 s looks short"));
  EXPECT_TRUE(contains(told(0.05), "sample time of 2 s looks long"));
  EXPECT_TRUE(contains(told(1.05), "unstable by itself: the linear model has a pole at 1.05"));
  EXPECT_FALSE(contains(told(0.999), "unstable"));
  for (const double pole : {0.2, 0.5, 0.95, 0.99})
    EXPECT_FALSE(contains(told(pole), "sample time")) << pole;
}

TEST(RecordRemarks, TellASpikeButNotACornerOrAStep) {
  Matrix values = lag(0.9, 400, 0.0);
  for (Index k = 0; k < 400; ++k) values(k, 0) = std::abs(std::sin(0.013 * static_cast<double>(k)));
  EXPECT_TRUE(outliersOf(values.col(0)).empty()) << "corners where the sign turns";
  values.col(0).tail(200).array() += 3.0;
  EXPECT_TRUE(outliersOf(values.col(0)).empty()) << "a step";
  values(120, 0) += 2.0;
  ASSERT_EQ(outliersOf(values.col(0)), std::vector<Index>{120});
  const DataSet data = recordOf(values), clean = withoutOutliers(data);
  EXPECT_TRUE(std::isnan(clean.values(120, 0)));
  EXPECT_EQ(clean.values.col(0).array().isNaN().count(), 1);
  EXPECT_TRUE(contains(recordRemarks(data, nullptr), "y: 1 outlier in row 121: left out"));
}

TEST(RecordRemarks, TellAClosedLoop) {
  Matrix values = lag(0.9, 400, 0.05);
  std::mt19937_64 random(6);
  double y = 0.0, integral = 0.0;
  for (Index k = 0; k < 400; ++k) {
    const double w = k / 80 % 2 == 0 ? 1.0 : -1.0;
    integral += 0.1 * (w - y);
    const double u = 1.2 * (w - y) + integral;
    values.row(k) << y, u;
    y = 0.9 * y + 0.1 * u + 0.05 * standardNormal(random);
  }
  EXPECT_TRUE(contains(recordRemarks(recordOf(values), nullptr), "u answers to y"));
}

TEST(RecordRemarks, TellAnInputThatHardlyMovedInGoodGrammar) {
  Matrix values = lag(0.9, 400, 0.02);
  values.col(1).setConstant(1.0);
  values(399, 1) = 2.0;
  EXPECT_TRUE(contains(recordRemarks(recordOf(values), nullptr), "u hardly moved: 1 move in 400"));
}

TEST(PredictionRemarks, OfADriftSayItOnceAndNoLag) {
  // what drifts is not in the model; the input wanders too
  std::mt19937_64 random(7);
  Matrix values = lag(0.5, 60, 0.0), predicted = values.leftCols(1);
  for (Index k = 0; k < 60; ++k) {
    values(k, 1) = 0.02 * static_cast<double>(k) + 0.1 * standardNormal(random);
    values(k, 0) += 0.05 * static_cast<double>(k) + 0.1 * standardNormal(random);
  }
  const DataSet data = recordOf(values);
  const auto remarks = predictionRemarks(firstOrder(data, 0.5), data, predicted, predicted, {});
  EXPECT_TRUE(contains(remarks, "y: residuals drift"));
  EXPECT_FALSE(contains(remarks, "a lag, a delay or a bend is missing"));
}

TEST(PredictionRemarks, TellAMissingLagOnce) {
  const DataSet data = recordOf(lag(0.5, 400, 0.01));
  Matrix predicted = data.values.leftCols(1);
  for (Index k = 4; k < 400; ++k) predicted(k, 0) -= 0.3 * data.values(k - 4, 1);
  const auto remarks = predictionRemarks(firstOrder(data, 0.5), data, predicted, predicted, {});
  EXPECT_TRUE(contains(remarks, "y: residual correlated with u at lag 4")) << remarks.size();
}

/// Remarks of a search on y(k+1) = 0.7 y(k) + u(k - 3); with `period` the input repeats itself.
std::vector<std::string> searched(Index period) {
  std::mt19937_64 random(5);
  Matrix values(200, 2);
  double y = 0.0;
  for (Index k = 0; k < 200; ++k) {
    const double u = k < period ? standardNormal(random) : values(k - period, 1);
    values.row(k) << y + 0.01 * standardNormal(random), u;
    y = 0.7 * y + values(std::max<Index>(0, k - 3), 1);
  }
  AutoParams params;
  params.states = false;
  params.budget_s = 300.0;
  return autoIdentify(recordOf(values), params).remarks;
}

TEST(RecordRemarks, TellADelayThatTheRecordCannotTell) {
  EXPECT_TRUE(contains(searched(6), "delay of u doubtful"));
  EXPECT_FALSE(contains(searched(200), "doubtful"));
}

}  // namespace fuzzy_remarks_test
}  // namespace fpc
