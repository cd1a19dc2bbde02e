// Models that run away where no data were.
#include "identification/auto_stress.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"

namespace fpc {
namespace fuzzy_auto_stress_test {

using Eigen::Index;

/// y+ = a y + (1 - a) u; with two rules, the second one at u = `edge` with a pole of its own.
Fitted model(Index rules, double edge, double pole) {
  Fitted f;
  f.shape.states = 1;
  f.shape.exogenous = 1;
  f.shape.regressors = {0, 1};
  f.shape.rules = rules;
  f.finite = true;
  if (rules == 1) {
    f.parameters = (Vector(3) << 0.8, 0.2, 0.0).finished();
    return f;
  }
  f.shape.antecedents = {1};
  f.parameters.resize(f.shape.parameterCount());
  f.parameters << 0.8, 0.2, 0.0, pole, 0.2, 0.0, 0.0, edge, std::log(0.3), std::log(0.3);
  return f;
}

/// Inputs between -1 and 1, outputs likewise.
RecurrentData record(Index rows) {
  std::mt19937_64 random(2);
  RecurrentData r;
  r.y.resize(rows);
  r.v.resize(1, rows);
  double y = 0.0;
  for (Index k = 0; k < rows; ++k) {
    r.y[k] = y;
    r.v(0, k) = k % 4 == 0 ? 2.0 * uniform(random) - 1.0 : r.v(0, k - 1);
    y = 0.8 * y + 0.2 * r.v(0, k);
  }
  return r;
}

TEST(AutoStress, ARuleBeyondTheDataMustNotBeUnstable) {
  const RecurrentData data = record(300);
  const std::vector<Stretch> all{{0, 300}};
  const Fitted line = model(1, 0.0, 0.0);
  EXPECT_TRUE(endures(model(2, 1.5, 0.7), line, data, all));
  EXPECT_FALSE(endures(model(2, 1.5, 1.2), line, data, all)) << "within 15 % beyond the inputs";
  EXPECT_FALSE(endures(model(2, -1.5, 1.2), line, data, all));
  EXPECT_TRUE(endures(model(2, 9.0, 1.2), line, data, all)) << "out of reach";
}

TEST(AutoStress, AnExcursionThatLinearMakesTooIsAllowed) {
  const RecurrentData data = record(300);
  const std::vector<Stretch> all{{0, 300}};
  Fitted steep = model(1, 0.0, 0.0), fuzzy = model(2, 1.5, 0.8);
  for (const Index gain : {1, 4}) fuzzy.parameters[gain] = 2.0;  // ten times the data's gain
  EXPECT_FALSE(endures(fuzzy, steep, data, all));
  steep.parameters[1] = 1.0;
  EXPECT_TRUE(endures(fuzzy, steep, data, all));
}

TEST(AutoStress, ASecondRestBeyondTheDataMustNotHoldWhatStartsAtTheirEdge) {
  const RecurrentData data = record(300);
  Fitted fuzzy =
      model(2, 0.9, 0.8);  // the second rule holds for high y and rests at `rest` for u = 0
  fuzzy.shape.antecedents = {0};
  const auto resting = [&](double rest) {
    fuzzy.parameters[5] = 0.2 * rest;
    return endures(fuzzy, model(1, 0.0, 0.0), data, {{0, 300}});
  };
  EXPECT_TRUE(resting(1.0));
  EXPECT_FALSE(resting(3.0)) << "within three ranges of y, so that larger inputs alone pass it";
}

TEST(AutoStress, GapsAreSteppedOver) {
  RecurrentData data = record(300);
  data.y.segment(50, 20).setConstant(std::numeric_limits<double>::quiet_NaN());
  data.v.middleCols(50, 20).setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(endures(model(2, 1.5, 0.7), model(1, 0.0, 0.0), data, {{0, 300}}));
}

}  // namespace fuzzy_auto_stress_test
}  // namespace fpc
