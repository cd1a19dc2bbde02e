#include "identification/state_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "fmbpc/base/input_error.hpp"
#include "identification/auto_identify.hpp"
#include "identification/record_remarks.hpp"

namespace fpc {
namespace fuzzy_state_model_test {

using Eigen::Index;

DataSet recordOf(const Matrix& values) {
  DataSet data;
  data.source = "here";
  data.sample_time_s = 1.0;
  data.outputs = {{"y", "", values.col(0).minCoeff(), values.col(0).maxCoeff()}};
  data.inputs = {{"u", "", values.col(1).minCoeff(), values.col(1).maxCoeff()}};
  data.values = values;
  data.constant.assign(2, false);
  return data;
}

TEST(TrimmedMean, LeavesOutTheMostExtremeQuarters) {
  EXPECT_DOUBLE_EQ(trimmedMean({5.0}), 5.0);
  EXPECT_DOUBLE_EQ(trimmedMean({1.0, 3.0}), 2.0);
  EXPECT_DOUBLE_EQ(trimmedMean({1.0, 2.0, 1e9}), 2.0);
  EXPECT_DOUBLE_EQ(trimmedMean({-1e9, 1.0, 2.0, 3.0, 1e9}), 2.0);
}

TEST(Correction, PredictsAnAutoregressiveError) {
  std::mt19937_64 random(2);
  Vector e = Vector::Zero(4000);
  for (Index k = 2; k < e.size(); ++k)
    e[k] = 1.2 * e[k - 1] - 0.4 * e[k - 2] + 0.1 * standardNormal(random);
  e[100] = std::nan("");
  const Vector c = fitCorrection(e);
  EXPECT_NEAR(c[0], 1.2, 0.08);
  EXPECT_NEAR(c[1], -0.4, 0.12);
  Vector run = Vector::Zero(4), measured(4), half(1);
  measured << 1.0, 2.0, 4.0, 8.0;
  half << 0.5;
  const Vector y = corrected(measured, run, half);
  EXPECT_DOUBLE_EQ(y[1], 0.5);
  EXPECT_DOUBLE_EQ(y[3], 2.0);
}

TEST(StateModel, RefusesWhatDoesNotFit) {
  TsModel names;
  names.outputs = {{"y", "", 0.0, 1.0}};
  names.inputs = {{"u", "", 0.0, 1.0}};
  StateModel model;
  EXPECT_NO_THROW(model.validate(names));
  model.outputs.resize(1);
  EXPECT_THROW(model.validate(names), InputError);  // no member
  StateOutput& o = model.outputs.front();
  o.exogenous_shift = Vector::Zero(1);
  o.exogenous_scale = Vector::Ones(1);
  StateMember member;
  member.shape.exogenous = 1;
  member.shape.regressors = {0, 1};
  member.exogenous = {{SignalKind::kInput, 0, 0}};
  member.parameters = Vector::Zero(3);
  o.members = {member};
  EXPECT_NO_THROW(model.validate(names));
  o.members.front().parameters[1] = std::nan("");
  EXPECT_THROW(model.validate(names), InputError);
  o.members.front() = member;
  o.members.front().exogenous.front().index = 1;
  EXPECT_THROW(model.validate(names), InputError);
}

TEST(Records, AreJoinedAndThinnedWithGaps) {
  Matrix values(100, 2);
  for (Index k = 0; k < 100; ++k)
    values.row(k) << static_cast<double>(k), 1.0 - 0.1 * static_cast<double>(k);
  const DataSet one = recordOf(values);
  DataSet two = one;
  two.values *= 2.0;
  two.outputs.front().upper *= 2.0;
  const DataSet both = joinRecords({one, two});
  EXPECT_EQ(both.values.topRows(100), one.values);
  EXPECT_EQ(both.values.bottomRows(100), two.values);
  EXPECT_TRUE(both.values.middleRows(100, both.rows() - 200).array().isNaN().all());
  EXPECT_EQ(both.outputs.front().upper, 198.0);
  two.sample_time_s = 2.0;
  EXPECT_THROW(joinRecords({one, two}), InputError);
  const DataSet part = subsample(one, 20, 4);
  EXPECT_EQ(part.values.array().isFinite().count(), 40);
  EXPECT_EQ(part.values(0, 0), 0.0);
  EXPECT_EQ(part.values.col(0).array().isNaN().select(0.0, part.values.col(0)).maxCoeff(), 99.0);
}

TEST(Remarks, TellWhatIsWrongWithARecord) {
  std::mt19937_64 random(8);
  Matrix values(500, 2);
  double y = 0.0;
  for (Index k = 0; k < 500; ++k) {
    values(k, 1) = k < 250 ? 0.0 : 1.0;
    y = 0.9 * y + 0.1 * values(k, 1) + 0.001 * standardNormal(random);
    values(k, 0) = y;
  }
  values(400, 0) += 5.0;
  const DataSet data = recordOf(values);
  const auto remarks = recordRemarks(data, nullptr);
  ASSERT_EQ(remarks.size(), 2U);
  EXPECT_EQ(remarks[0], "u hardly moved: 1 move in 500 rows");
  EXPECT_EQ(remarks[1], "y: 1 outlier in row 401: left out of fits and figures");
}

TEST(Remarks, TellWherePredictionsLeaveTheData) {
  std::mt19937_64 random(8);
  Matrix values(600, 2);
  for (Index k = 0; k < 600; ++k) values.row(k) << standardNormal(random), standardNormal(random);
  const DataSet data = recordOf(values);
  TsModel model;
  model.outputs = data.outputs;
  model.inputs = data.inputs;
  Matrix run = values.leftCols(1);
  EXPECT_TRUE(predictionRemarks(model, data, Matrix::Zero(600, 1), run, {}).empty());
  run(77, 0) = 1e3;
  model.inputs.front().upper = 1.0;
  Matrix one = values.leftCols(1);
  for (Index k = 4; k < 600; ++k) one(k, 0) -= 0.5 * values(k - 3, 1);
  const auto remarks = predictionRemarks(model, data, one, run, {});
  ASSERT_EQ(remarks.size(), 3U);
  EXPECT_EQ(remarks[0], "y: unstable in free run: it leaves the data at sample 78");
  EXPECT_NE(remarks[1].find("residual correlated with u at lag 3"), std::string::npos)
      << remarks[1];
  EXPECT_NE(remarks[2].find("the model extrapolates: u is outside"), std::string::npos);
}

TEST(Remarks, TellClosedLoopData) {
  std::mt19937_64 random(3);
  Matrix values(800, 2);
  double y = 0.0, u = 0.0;
  for (Index k = 0; k < 800; ++k) {
    y = 0.8 * y + 0.2 * u + 0.1 * standardNormal(random);
    u = 0.5 * standardNormal(random) - 3.0 * y;
    values.row(k) << y, u;
  }
  bool told = false;
  for (const auto& remark : recordRemarks(recordOf(values), nullptr))
    told = told || remark.find("closed-loop data") != std::string::npos;
  EXPECT_TRUE(told);
}

}  // namespace fuzzy_state_model_test
}  // namespace fpc
