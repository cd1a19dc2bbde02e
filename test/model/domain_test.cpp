// Where data were: balls that cover them, trust that is one inside and fades outside.
#include "fmbpc/model/domain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "config/model_file.hpp"
#include "fmbpc/model/model_match.hpp"
#include "fmbpc/model/ts_model.hpp"
#include "model/process_trust.hpp"

namespace fpc {
namespace fuzzy_domain_test {

/// Data on a ring of radius 1: the middle of the box has none.
Matrix ring() {
  Matrix data;
  data.resize(400, 2);
  for (Eigen::Index k = 0; k < 400; ++k) {
    data(k, 0) = 10.0 + 5.0 * std::cos(0.37 * static_cast<double>(k));
    data(k, 1) = 3.0 + std::sin(0.37 * static_cast<double>(k));
  }
  return data;
}

/// Of y and of a second signal, which is a disturbance or an input.
TsModel model(SignalKind second = SignalKind::kDisturbance) {
  TsModel m;
  m.name = "ring";
  m.sample_time_s = 1.0;
  const double infinite = std::numeric_limits<double>::infinity();
  m.outputs = {{"y", "m", -infinite, infinite}};
  (second == SignalKind::kInput ? m.inputs : m.disturbances) = {{"u", "A", -infinite, infinite}};
  OutputModel submodel;
  submodel.regressors = {{SignalKind::kOutput, 0, 0}, {second, 0, 0}};
  Rule rule;
  rule.coefficients = Vector::Constant(2, 0.5);
  submodel.rules = {rule};
  m.submodels = {submodel};
  return m;
}

Vector at(double y, double u) { return (Vector(2) << y, u).finished(); }

TEST(Domain, EveryDatumIsInsideAndFarPointsAreNot) {
  TsModel m = model();
  const Matrix data = ring();
  m.domain = makeDomain(data, 24);
  EXPECT_EQ(m.domain.centres.cols(), 24);
  EXPECT_NEAR(m.domain.scale[0], 10.0, 0.01);
  for (Eigen::Index k = 0; k < data.rows(); ++k)
    EXPECT_EQ(trustOf(m, data.row(k).transpose()), 1.0) << k;
  EXPECT_EQ(trustOf(m, at(10.0, 3.0)), 0.0);  // inside the box, but no data there
  EXPECT_EQ(trustOf(m, at(30.0, 3.0)), 0.0);
  EXPECT_EQ(trustOf(m, at(std::nan(""), 3.0)), 0.0);
}

TEST(Domain, OneStrayRowIsNotWhereTheDataAre) {
  Matrix data = ring();
  data.row(7) << 40.0, 3.0;
  TsModel m = model();
  m.domain = makeDomain(data, 24);
  EXPECT_EQ(m.domain.centres.cols(), 23);
  EXPECT_EQ(trustOf(m, at(40.0, 3.0)), 0.0);
  for (Eigen::Index k = 0; k < data.rows(); ++k)
    EXPECT_EQ(trustOf(m, data.row(k).transpose()), k == 7 ? 0.0 : 1.0) << k;
}

TEST(Domain, TrustFallsMonotonicallyFromTheSurfaceOfABall) {
  TsModel m = model();
  m.domain.centres = at(0.0, 0.0);
  m.domain.scale = at(2.0, 4.0);
  m.domain.radius = 0.5;
  EXPECT_EQ(trustOf(m, at(1.0, 0.0)), 1.0);  // 0.5 scaled
  EXPECT_NEAR(trustOf(m, at(1.5, 0.0)), 0.5, 1e-12);
  EXPECT_NEAR(trustOf(m, at(0.0, 3.0)), 0.5, 1e-12);
  EXPECT_EQ(trustOf(m, at(2.0, 0.0)), 0.0);
  m.domain.radius = 0.05;  // of a dense record: a quarter of the ranges counts
  EXPECT_NEAR(trustOf(m, at(2.0 * (0.05 + 0.125), 0.0)), 0.5, 1e-12);
}

TEST(Domain, WithoutOneTheRangesCount) {
  TsModel m = model();
  EXPECT_FALSE(knowsDomain(m));
  EXPECT_EQ(trustOf(m, at(1e9, -1e9)), 1.0);
  m.outputs[0].lower = 0.0;
  m.outputs[0].upper = 8.0;
  EXPECT_TRUE(knowsDomain(m));
  EXPECT_EQ(trustOf(m, at(8.0, 1e9)), 1.0);
  EXPECT_NEAR(trustOf(m, at(9.0, 0.0)), 0.5, 1e-12);  // an eighth of the range beyond
  EXPECT_EQ(trustOf(m, at(-2.0, 0.0)), 0.0);
}

TEST(Domain, ASignalThatNeverMovesDoesNotCount) {
  Matrix data = ring();
  data.col(1).setConstant(2.0);
  TsModel m = model();
  m.domain = makeDomain(data, 10);
  EXPECT_EQ(trustOf(m, at(10.0, 77.0)), trustOf(m, at(10.0, 2.0)));
}

TEST(Domain, InputsCountByHowFarTheyAreBeyondAllData) {
  TsModel m = model(SignalKind::kInput);
  m.domain = makeDomain(ring(), 24);
  EXPECT_EQ(trustOf(m, at(10.0, 3.0)), 1.0);  // y = 10 was seen, and u = 3, not together
  EXPECT_EQ(trustOf(m, at(5.0, 4.0)), 1.0);
  EXPECT_EQ(trustOf(m, at(10.0, 6.0)), 0.0);
  EXPECT_EQ(processTrustOf(m, at(10.0, 6.0)), 1.0);
  EXPECT_EQ(trustOf(m, at(30.0, 3.0)), 0.0);
  EXPECT_EQ(processTrustOf(m, at(30.0, 3.0)), 0.0);
}

TEST(Domain, SurvivesItsFileAndTheOrderOfThePlant) {
  TsModel m = model(SignalKind::kInput);
  m.domain = makeDomain(ring(), 5);
  const TsModel read = parseModel(writeModel(m), "ring.yaml");
  EXPECT_EQ(read.domain.centres, m.domain.centres);
  EXPECT_EQ(read.domain.scale, m.domain.scale);
  EXPECT_EQ(read.domain.radius, m.domain.radius);
  PlantInfo plant;
  plant.sample_time_s = 1.0;
  plant.outputs = {{"y", "m", 0, 1}};
  plant.inputs = {{"v", "A", 0, 1}, {"u", "A", 0, 1}};
  const TsModel matched = matchToPlant(m, plant);
  const Vector point =
      (Vector(3) << m.domain.centres(0, 2), 1e6, m.domain.centres(1, 2)).finished();
  EXPECT_EQ(trustOf(matched, point), 1.0);
}

}  // namespace fuzzy_domain_test
}  // namespace fpc
