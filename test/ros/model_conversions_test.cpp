// Takagi-Sugeno models survive the way through a message; broken ones are refused.
#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"
#include "same_bits.hpp"

namespace fpc {
namespace {

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
  model.outputs = {{"x", "mg/l", -kInf, kInf}};
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

}  // namespace
}  // namespace fpc
