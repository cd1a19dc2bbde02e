// Takagi-Sugeno models survive the way through a message; broken ones are refused.
#include <gtest/gtest.h>

#include <functional>

#include "fmbpc/base/input_error.hpp"
#include "same_bits.hpp"

namespace fpc {
namespace ros_model_conversions_test {

TsModel smallModel() {
  const auto set = [](MembershipShape shape, std::vector<double> p) {
    return Membership{shape, p};
  };
  OutputModel submodel;
  submodel.antecedents = {{SignalKind::kOutput, 0, 0}, {SignalKind::kDisturbance, 0, 0}};
  submodel.regressors = {{SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, 1}};
  Rule rule;
  rule.antecedents = {set(MembershipShape::kExponential, {0.0, 1.0, 2.0, 3.0}),
                      set(MembershipShape::kGaussian, {1.0 / 3.0, 0.1})};
  rule.coefficients = Eigen::Vector2d(0.9, -0.1);
  rule.offset = 1e-300;
  rule.data_count = 18446744073709551615u;
  Rule other = rule;
  other.antecedents = {set(MembershipShape::kTriangular, {0.0, 1.0, 2.0}),
                       set(MembershipShape::kTrapezoidal, {0.0, 1.0, 2.0, 3.0})};
  submodel.rules = {rule, other};
  TsModel model;
  model.name = "small";
  model.source = "made up";
  model.sample_time_s = 720.0;
  model.outputs = {{"x", "mg/l", -kInfinity, kInfinity}};
  model.inputs = {{"q_r", "m3/h", 0.0, 1600.0}};
  model.disturbances = {{"q_i", "m3/h", 700.0, 2300.0}};
  model.submodels = {submodel};
  return model;
}

TEST(ModelConversions, FuzzyModelSurvives) {
  const TsModel m = smallModel();
  const TsModel r = fromMsg(sent(toMsg(m)));
  EXPECT_EQ(m.name, r.name);
  EXPECT_EQ(m.source, r.source);
  EXPECT_TRUE(sameBits(m.sample_time_s, r.sample_time_s));
  EXPECT_TRUE(sameSignals(m.outputs, r.outputs));
  EXPECT_TRUE(sameSignals(m.inputs, r.inputs));
  EXPECT_TRUE(sameSignals(m.disturbances, r.disturbances));
  ASSERT_EQ(1u, r.submodels.size());
  EXPECT_EQ(m.submodels[0].antecedents, r.submodels[0].antecedents);
  EXPECT_EQ(m.submodels[0].regressors, r.submodels[0].regressors);
  ASSERT_EQ(2u, r.submodels[0].rules.size());
  for (std::size_t i = 0; i < 2; ++i) {
    const Rule& a = m.submodels[0].rules[i];
    const Rule& b = r.submodels[0].rules[i];
    EXPECT_EQ(a.antecedents, b.antecedents);
    EXPECT_TRUE(sameNumbers(a.coefficients, b.coefficients));
    EXPECT_TRUE(sameBits(a.offset, b.offset));
    EXPECT_EQ(a.data_count, b.data_count);
  }
}

TsModel multivariateModel() {
  TsModel model = smallModel();
  for (Rule& rule : model.submodels[0].rules) {
    rule.antecedents.clear();
    rule.multivariate = {Eigen::Vector2d(1.0 / 3.0, -1e-300),
                         (Matrix(2, 2) << 2.0, 1.0 / 7.0, 1.0 / 7.0, 1.0 / 3.0).finished()};
  }
  model.submodels[0].rules[1].multivariate->inverse_covariance.setZero();
  return model;
}

TEST(ModelConversions, MultivariateMembershipsSurvive) {
  const TsModel m = multivariateModel();
  const TsModel r = fromMsg(sent(toMsg(m)));
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& a = m.submodels[0].rules[i].multivariate;
    const auto& b = r.submodels[0].rules[i].multivariate;
    ASSERT_TRUE(b.has_value());
    EXPECT_TRUE(sameNumbers(a->center, b->center));
    EXPECT_TRUE(sameMatrix(a->inverse_covariance, b->inverse_covariance));
    EXPECT_TRUE(r.submodels[0].rules[i].antecedents.empty());
  }
  EXPECT_FALSE(fromMsg(sent(toMsg(smallModel()))).submodels[0].rules[0].multivariate);
}

TEST(ModelConversions, BrokenMultivariateMembershipsAreRefused) {
  const auto refuse = [](const std::function<void(fmbpc::FuzzyRule&)>& spoil) {
    fmbpc::FuzzyModel msg = toMsg(multivariateModel());
    spoil(msg.submodels[0].rules[0]);
    EXPECT_THROW(fromMsg(msg), InputError);
  };
  refuse([](auto& rule) { rule.center.pop_back(); });
  refuse([](auto& rule) { rule.inverse_covariance.pop_back(); });
  refuse([](auto& rule) { rule.center.clear(); });
  refuse([](auto& rule) { rule.inverse_covariance[1] = 5.0; });  // not symmetric
  refuse([](auto& rule) { rule.inverse_covariance[0] = -1.0; });
  refuse([](auto& rule) {  // mixed with the other rule
    rule = toMsg(smallModel()).submodels[0].rules[0];
  });
}

TEST(ModelConversions, BrokenFuzzyModelsAreRefused) {
  fmbpc::FuzzyModel unknown_shape = toMsg(smallModel());
  unknown_shape.submodels[0].rules[0].antecedents[0].shape = 4;
  EXPECT_THROW(fromMsg(unknown_shape), InputError);
  fmbpc::FuzzyModel unknown_kind = toMsg(smallModel());
  unknown_kind.submodels[0].regressors[0].kind = 0;
  EXPECT_THROW(fromMsg(unknown_kind), InputError);
  fmbpc::FuzzyModel short_rule = toMsg(smallModel());
  short_rule.submodels[0].rules[1].coefficients.pop_back();
  EXPECT_THROW(fromMsg(short_rule), InputError);
}

}  // namespace ros_model_conversions_test
}  // namespace fpc
