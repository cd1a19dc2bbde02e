#include "control/targets/target_layer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "control/targets/layer_fixture.hpp"

namespace fpc {
namespace control_target_layer_test {

using targets_test::limitsOf;
using targets_test::linear;
using targets_test::measured;
using targets_test::paramsOf;
using targets_test::plantOf;

Vector vec(std::initializer_list<double> values) {
  Vector v(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), v.data());
  return v;
}

TargetLayer made(const TsModel& model, const TargetParams& params) {
  TargetLayer layer(params, limitsOf(model), plantOf(model));
  layer.setModel(model);
  return layer;
}

// y = 2 u at rest; 1 more than the model says is a disturbance.
TEST(TargetLayer, TheCheapestInputThatKeepsTheZoneUnderTheDisturbance) {
  const TsModel model = linear({0.5}, Matrix::Constant(1, 1, 1.0));
  TargetParams params = paramsOf(model);
  params.outputs[0].lower = 4.0;
  params.outputs[0].upper = 6.0;
  params.inputs[0].price = 1.0;
  TargetLayer layer = made(model, params);
  Targets targets;
  layer.step(measured(vec({5.0}), vec({2.0})), vec({0.0}), targets);
  EXPECT_TRUE(targets.found);
  EXPECT_NEAR(targets.outputs[0], 4.0, 1e-7);
  EXPECT_NEAR(targets.inputs[0], 1.5, 1e-7);
  EXPECT_NEAR(targets.cost, 1.5, 1e-7);
  EXPECT_TRUE(layer.events().empty());
}

// One input, two outputs y1 = u, y2 = -u that cannot both be above 1: the lower rank alone gives
// up.
TEST(TargetLayer, TheLowerRankAloneIsGivenUp) {
  Matrix b(2, 1);
  b << 0.5, -0.5;
  const TsModel model = linear({0.5, 0.5}, b);
  TargetParams params = paramsOf(model);
  params.outputs[0].lower = params.outputs[1].lower = 1.0;
  params.outputs[0].rank = 2;
  TargetLayer layer = made(model, params);
  Targets targets;
  layer.step(measured(vec({0.0, 0.0}), vec({0.0})), vec({0.0, 0.0}), targets);
  EXPECT_NEAR(targets.outputs[1], 1.0, 1e-9);
  EXPECT_NEAR(targets.outputs[0], -1.0, 1e-9);
  EXPECT_NEAR(targets.output_lower[0], -1.0, 1e-9);  // CLP is not asked for more
  EXPECT_NEAR(targets.output_lower[1], 1.0, 1e-9);
  ASSERT_TRUE(layer.events().has(EventCode::kTargetGivenUp));
  EXPECT_STREQ(layer.events().begin()->signal, "y1");
}

// Equal ranks share: y1 = u >= 1 and y2 = -u >= 1 both give up 1.
TEST(TargetLayer, EqualRanksShare) {
  Matrix b(2, 1);
  b << 0.5, -0.5;
  const TsModel model = linear({0.5, 0.5}, b);
  TargetParams params = paramsOf(model);
  params.outputs[0].lower = params.outputs[1].lower = 1.0;
  TargetLayer layer = made(model, params);
  Targets targets;
  layer.step(measured(vec({0.0, 0.0}), vec({3.0})), vec({0.0, 0.0}), targets);
  EXPECT_NEAR(targets.inputs[0], 3.0, 1e-8);  // y1 = u - 3, y2 = 3 - u at rest
}

// A tank without outflow: level(k+1) = level + u1 - u2. u1 is paid for, u2 wants to stand at 3.
TEST(TargetLayer, AnIntegratingLevelIsHeldInBalance) {
  Matrix b(1, 2);
  b << 1.0, -1.0;
  const TsModel model = linear({1.0}, b);
  TargetParams params = paramsOf(model);
  params.inputs[0].lower = params.inputs[1].lower = 0.0;
  params.inputs[1].rest = 3.0;
  params.outputs[0].lower = 20.0;
  params.outputs[0].upper = 40.0;
  TargetLayer layer = made(model, params);
  Targets targets;
  layer.step(measured(vec({50.0}), vec({3.0, 3.0})), vec({0.0}), targets);
  EXPECT_NEAR(targets.inputs[0], targets.inputs[1], 1e-8);
  EXPECT_NEAR(targets.outputs[0], 40.0, 1e-8);
  Measurement now = measured(vec({51.0}), vec({3.0, 3.0}), 1);  // one more flows in than is known
  layer.step(now, vec({0.0}), targets);
  EXPECT_NEAR(targets.inputs[1] - targets.inputs[0], 1.0, 1e-6);
}

TEST(TargetLayer, APriceThatNothingHoldsKeepsTheLastTargetAndSaysSo) {
  TsModel model = linear({1.0}, Matrix::Constant(1, 1, 1.0));
  model.outputs[0].lower = -kInfinity;
  model.outputs[0].upper = kInfinity;
  TargetParams params = paramsOf(model);
  params.outputs[0].price = -1.0;
  TargetLayer layer = made(model, params);
  Targets targets;
  layer.step(measured(vec({5.0}), vec({0.0})), vec({0.0}), targets);
  EXPECT_FALSE(targets.found);
  EXPECT_TRUE(layer.events().has(EventCode::kTargetUnbounded));
  EXPECT_EQ(targets.outputs[0], 5.0);
}

TEST(TargetLayer, MissingNumbersKeepTheLastTarget) {
  const TsModel model = linear({0.5}, Matrix::Constant(1, 1, 1.0));
  TargetParams params = paramsOf(model);
  params.outputs[0].setpoint = true;
  TargetLayer layer = made(model, params);
  Targets targets;
  layer.step(measured(vec({0.0}), vec({0.0})), vec({4.0}), targets);
  EXPECT_NEAR(targets.inputs[0], 2.0, 1e-9);
  layer.step(measured(vec({std::nan("")}), vec({0.0}), 1), vec({8.0}), targets);
  EXPECT_FALSE(targets.found);
  EXPECT_NEAR(targets.inputs[0], 2.0, 1e-9);
  EXPECT_TRUE(layer.events().has(EventCode::kTargetNotFound));
  layer.step(measured(vec({0.0}), vec({0.0}), 2), vec({8.0}), targets);
  EXPECT_NEAR(targets.inputs[0], 4.0, 1e-9);
}

/// y(k+1) = 0.5 y + w1(u) u + w2(u) 3 u between rules at u = 0 and u = 10: at rest y = 2 u + 0.4
/// u^2.
TsModel bending() {
  TsModel model = linear({0.5}, Matrix::Constant(1, 1, 1.0));
  model.inputs[0].lower = 0.0;
  OutputModel& output = model.submodels[0];
  output.antecedents.push_back({SignalKind::kInput, 0, 0});
  output.rules.push_back(output.rules[0]);
  output.rules[1].coefficients[1] = 3.0;
  Membership low, high;
  low.shape = high.shape = MembershipShape::kTrapezoidal;
  low.parameters = {-1.0, -1.0, 0.0, 10.0};
  high.parameters = {0.0, 10.0, 11.0, 11.0};
  output.rules[0].antecedents = {low};
  output.rules[1].antecedents = {high};
  return model;
}

TEST(TargetLayer, TargetsOfBendingGainsAreIteratedToTheTarget) {
  const TsModel model = bending();
  TargetParams params = paramsOf(model);
  params.inputs[0].lower = 0.0;
  params.outputs[0].setpoint = true;
  params.iterations = 20;
  TargetLayer layer = made(model, params);
  Targets targets;
  layer.step(measured(vec({0.0}), vec({0.0})), vec({30.0}), targets);
  const double u = targets.inputs[0];
  EXPECT_NEAR(2.0 * u + 0.4 * u * u, 30.0, 1e-6);
  EXPECT_TRUE(layer.events().empty());
}

// From u = 5 on the model integrates: a target there has no rest.
TEST(TargetLayer, ATargetThatIsNotFoundLeavesTheCostOfTheLastOne) {
  TsModel model = bending();
  std::vector<Rule>& rules = model.submodels[0].rules;
  rules[0].antecedents[0].parameters = {-1.0, -1.0, 0.0, 5.0};
  rules[1].antecedents[0].parameters = {0.0, 5.0, 11.0, 11.0};
  rules[1].coefficients[0] = 1.0;
  TargetParams params = paramsOf(model);
  params.inputs[0].lower = 0.0;
  params.inputs[0].price = 1.0;
  params.outputs[0].setpoint = true;
  params.iterations = 20;
  TargetLayer layer = made(model, params);
  Targets targets;
  layer.step(measured(vec({0.0}), vec({0.0})), vec({2.0}), targets);
  ASSERT_TRUE(targets.found);
  const double cost = targets.cost;
  EXPECT_NEAR(cost, targets.inputs[0], 1e-9);
  layer.step(measured(vec({0.0}), vec({0.0}), 1), vec({100.0}), targets);
  ASSERT_FALSE(targets.found);
  EXPECT_EQ(targets.cost, cost);
}

// Two inputs do the same at nearly one price. Noise of y2 moves how much of the cheaper one is
// allowed: a vertex that wanders.
struct Course {
  double travel{};
  std::vector<double> costs;
};

Course wandering(double band) {
  Matrix b(2, 2);
  b << 0.5, 0.5, 0.01, -0.01;
  const TsModel model = linear({0.5, 0.5}, b);
  TargetParams params = paramsOf(model);
  params.outputs[0].lower = 4.0;
  params.inputs[0].lower = params.inputs[1].lower = 0.0;
  params.inputs[0].price = 1.0;
  params.inputs[1].price = 0.98;
  params.outputs[1].lower = 0.0;  // y2 = 0.02 (u1 - u2) + noise
  params.outputs[1].rank = 2;
  params.band = band;
  TargetLayer layer = made(model, params);
  Targets targets;
  auto engine = seededEngine(1, {3});
  Course course;
  for (std::uint32_t k = 0; k < 200; ++k) {
    const double noise = 0.02 * (uniform(engine) - 0.5);
    layer.step(measured(vec({4.0, noise}), vec({2.0, 2.0}), k), vec({0.0, 0.0}), targets);
    EXPECT_TRUE(targets.found) << k;
    course.costs.push_back(targets.cost);
  }
  course.travel = layer.moves().travel;
  return course;
}

TEST(TargetLayer, TheBandSavesMovesAndBoundsWhatStandingStillCosts) {
  constexpr double kBand = 0.004;
  const Course exact = wandering(0.0), banded = wandering(kBand);
  for (std::size_t k = 0; k < exact.costs.size(); ++k) {
    EXPECT_GT(banded.costs[k], exact.costs[k] - 1e-6) << k;
    EXPECT_LT(banded.costs[k], exact.costs[k] + kBand + 1e-6) << k;
  }
  EXPECT_GT(exact.travel, 0.0);
  EXPECT_LT(banded.travel, 0.8 * exact.travel);
}

}  // namespace control_target_layer_test
}  // namespace fpc
