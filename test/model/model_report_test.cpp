#include <gtest/gtest.h>

#include <set>

#include "identification/model_fixture.hpp"

namespace fpc {
namespace fuzzy_model_report_test {

/// "s 2" for every remark whose text contains the word.
std::set<std::string> rulesWith(const std::string& word, const TsModel& model) {
  std::set<std::string> rules;
  for (const auto& remark : reportModel(model))
    if (remark.text.find(word) != std::string::npos)
      rules.insert(remark.output + " " + std::to_string(remark.rule));
  return rules;
}

TEST(ModelReport, FlagsTheRankDeficientRulesOfTheShippedModelsAndNoOthers) {
  EXPECT_EQ(rulesWith("rank-deficient", test::shippedModel("fm_1")),
            (std::set<std::string>{"s 2", "s 5"}));
  EXPECT_EQ(rulesWith("rank-deficient", test::shippedModel("fm_2")),
            (std::set<std::string>{"s 1"}));
}

TEST(ModelReport, FlagsTheBiomassRulesOfFm2ThatDrift) {
  const TsModel model = test::shippedModel("fm_2");
  EXPECT_EQ(rulesWith("pole 1.000: drifts", model), (std::set<std::string>{"x 4"}));
  EXPECT_EQ(rulesWith("pole 1.030: drifts", model), (std::set<std::string>{"x 5"}));
  EXPECT_EQ(rulesWith("drifts", test::shippedModel("fm_1")), (std::set<std::string>{"s 5"}));
}

TEST(ModelReport, FindsPolesOfHigherOrderRules) {
  TsModel model;
  model.sample_time_s = 1.0;
  model.outputs = {test::signal("y")};
  model.submodels.resize(1);
  model.submodels[0].regressors = {{SignalKind::kOutput, 0, 1}, {SignalKind::kOutput, 0, 0}};
  model.submodels[0].rules.resize(1);
  Rule& rule = model.submodels[0].rules[0];
  rule.coefficients = (Vector(2) << -0.55, 1.6).finished();  // poles 0.5 and 1.1
  ASSERT_EQ(reportModel(model).size(), 1U);
  EXPECT_EQ(reportModel(model)[0].text, "pole 1.100: drifts in free run");
  rule.coefficients = (Vector(2) << -0.81, 1.0).finished();  // a pair of modulus 0.9
  EXPECT_TRUE(reportModel(model).empty());
}

}  // namespace fuzzy_model_report_test
}  // namespace fpc
