#include "fmbpc/model/ts_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "fmbpc/base/input_error.hpp"
#include "identification/model_fixture.hpp"

namespace fpc {
namespace fuzzy_ts_model_test {

OutputModel twoRules(Membership first, Membership second) {
  OutputModel model;
  model.antecedents = {{SignalKind::kOutput, 0, 0}};
  model.rules.resize(2);
  model.rules[0].antecedents = {std::move(first)};
  model.rules[1].antecedents = {std::move(second)};
  return model;
}

TEST(FiringWeights, TwoBellsShareAsTheirFormulasSay) {
  const OutputModel model =
      twoRules({MembershipShape::kGaussian, {0.0, 1.0}}, {MembershipShape::kGaussian, {2.0, 1.0}});
  FiringResult firing;
  firingWeights(model, Vector::Constant(1, 0.5), firing);
  EXPECT_TRUE(firing.fired);
  const double first = std::exp(-0.125), second = std::exp(-1.125);
  EXPECT_NEAR(firing.weights[0], first / (first + second), 1e-15);
  EXPECT_NEAR(firing.weights[1], second / (first + second), 1e-15);
}

TEST(FiringWeights, FarTailsDoNotEmptyTheRuleBase) {
  const OutputModel model =
      twoRules({MembershipShape::kGaussian, {0.0, 1.0}}, {MembershipShape::kGaussian, {2.0, 1.0}});
  FiringResult firing;
  firingWeights(model, Vector::Constant(1, 1e6), firing);  // every degree underflows to 0
  EXPECT_TRUE(firing.fired);
  EXPECT_EQ(firing.weights[0], 0.0);
  EXPECT_EQ(firing.weights[1], 1.0);
}

TEST(FiringWeights, TheNearestRuleReplacesAnEmptyRuleBase) {
  const OutputModel model = twoRules({MembershipShape::kTriangular, {0.0, 1.0, 2.0}},
                                     {MembershipShape::kTriangular, {8.0, 9.0, 10.0}});
  FiringResult firing;
  firingWeights(model, Vector::Constant(1, 6.5), firing);
  EXPECT_FALSE(firing.fired);
  EXPECT_EQ(firing.weights[0], 0.0);
  EXPECT_EQ(firing.weights[1], 1.0);
}

TEST(FiringWeights, AreNotNegativeAndSumToOneForAnyFiniteValues) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    test::RandomModelShape shape;
    shape.n_rules = 1 + static_cast<int>(seed % 7);
    TsModel model = test::randomModel(generator, shape);
    const auto shapes = {MembershipShape::kExponential, MembershipShape::kTriangular,
                         MembershipShape::kTrapezoidal};
    for (auto& rule : model.submodels[0].rules)
      for (auto& set : rule.antecedents) {
        set.shape = *(shapes.begin() + static_cast<std::ptrdiff_t>(generator() % 3));
        const Vector corners =
            test::randomVector(generator, static_cast<Eigen::Index>(parameterCount(set.shape)));
        set.parameters.assign(corners.data(), corners.data() + corners.size());
        std::sort(set.parameters.begin(), set.parameters.end());
        if (generator() % 4 == 0) set.parameters[1] = set.parameters[0];  // crisp edge
      }
    model.validate();
    const auto n = static_cast<Eigen::Index>(model.submodels[0].antecedents.size());
    for (const double size : {1.0, 10.0, 1e6, 1e150, 1e308}) {
      FiringResult firing;
      firingWeights(model.submodels[0], test::randomVector(generator, n, size / 2.0), firing);
      EXPECT_TRUE((firing.weights.array() >= 0.0).all()) << "size " << size;
      EXPECT_NEAR(firing.weights.sum(), 1.0, 1e-12) << "size " << size;
    }
  }
}

TEST(TsModel, ShippedModelsHaveSortedMembershipRows) {
  const auto countSortedRows = [](const TsModel& model) {
    int rows = 0;
    for (const auto& submodel : model.submodels)
      for (const auto& rule : submodel.rules)
        for (const auto& set : rule.antecedents) {
          EXPECT_EQ(set.shape, MembershipShape::kExponential);
          EXPECT_TRUE(std::is_sorted(set.parameters.begin(), set.parameters.end()));
          ++rows;
        }
    return rows;
  };
  EXPECT_EQ(countSortedRows(test::shippedModel("fm_1")), 51);
  EXPECT_EQ(countSortedRows(test::shippedModel("fm_2")), 40);
}

TEST(TsModel, LongestLagCountsAntecedentsAndRegressors) {
  const TsModel model = test::shippedModel("fm_1");
  EXPECT_EQ(model.maxLag(SignalKind::kInput, 0), 1);
  EXPECT_EQ(model.maxLag(SignalKind::kOutput, 1), 0);
  EXPECT_EQ(model.text({SignalKind::kInput, 0, 1}), "q_r(k-1)");
  TsModel unused = model;
  unused.disturbances.push_back(test::signal("t"));
  EXPECT_EQ(unused.maxLag(SignalKind::kDisturbance, 2), -1);
}

TEST(TsModel, ValidateNamesThePartThatIsWrong) {
  const auto complaint = [](const std::function<void(TsModel&)>& spoil) -> std::string {
    TsModel model = test::shippedModel("fm_1");
    spoil(model);
    try {
      model.validate();
    } catch (const InputError& e) {
      return e.what();
    }
    return "nothing";
  };
  EXPECT_EQ(complaint([](TsModel&) {}), "nothing");
  const auto expect = [&](const std::string& part, const std::function<void(TsModel&)>& spoil) {
    EXPECT_EQ(complaint(spoil).rfind(part, 0), 0U) << complaint(spoil);
  };
  expect("sample_time_s", [](TsModel& m) { m.sample_time_s = 0.0; });
  expect("outputs", [](TsModel& m) { m.outputs.clear(); });
  expect("submodels", [](TsModel& m) { m.submodels.pop_back(); });
  expect("inputs 'x'", [](TsModel& m) { m.inputs[0].name = "x"; });
  expect("disturbances 's(k)'", [](TsModel& m) { m.disturbances[0].name = "s(k)"; });
  expect("outputs 's'", [](TsModel& m) { m.outputs[0].lower = m.outputs[0].upper; });
  expect("submodels.x.regressors", [](TsModel& m) { m.submodels[1].regressors[0].index = 2; });
  expect("submodels.x.regressors",
         [](TsModel& m) { m.submodels[1].regressors[0] = m.submodels[1].regressors[1]; });
  expect("submodels.s.antecedents", [](TsModel& m) { m.submodels[0].antecedents[0].lag = -1; });
  expect("submodels.x.rules", [](TsModel& m) { m.submodels[1].rules.clear(); });
  expect("submodels.x.rules[1]",
         [](TsModel& m) { m.submodels[1].rules[1].antecedents.pop_back(); });
  expect("submodels.x.rules[2]",
         [](TsModel& m) { m.submodels[1].rules[2].coefficients.conservativeResize(2); });
  expect("submodels.s.rules[0]",
         [](TsModel& m) { m.submodels[0].rules[0].coefficients[0] = std::nan(""); });
  expect("submodels.s.rules[0]", [](TsModel& m) { m.submodels[0].rules[0].offset = HUGE_VAL; });
  expect("submodels.s.rules[5] antecedent 2",
         [](TsModel& m) { m.submodels[0].rules[5].antecedents[1].parameters[0] = 1e9; });
}

}  // namespace fuzzy_ts_model_test
}  // namespace fpc
