#include "config/identified_file.hpp"

#include <gtest/gtest.h>

#include "config/model_file.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace config_identified_file_test {

IdentifiedModel example() {
  IdentifiedModel m;
  m.model.name = "example";
  m.model.sample_time_s = 2.0;
  m.model.outputs = {{"y", "V", 0.0, 10.0}};
  m.model.inputs = {{"u", "V", -1.0, 1.0}};
  OutputModel line;
  line.regressors = {{SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, 1}};
  Rule rule;
  rule.coefficients = Vector::Constant(2, 0.3);
  rule.offset = 0.1;
  line.rules = {rule};
  m.model.submodels = {line};
  m.linear = {line};
  m.linear.front().rules.front().offset = 0.7;
  m.outputs = {{ModelKind::kState, 0.0, 10.0, 0.5, 0.25}};
  StateMember member;
  member.shape.companion = false;
  member.shape.states = 2;
  member.shape.exogenous = 1;
  member.shape.regressors = {0, 1, 2};
  member.shape.antecedents = {0};
  member.shape.rules = 2;
  member.shape.absolute = true;
  member.shape.lower = -3.0;
  member.shape.upper = 1.0 / 3.0;
  member.exogenous = {{SignalKind::kInput, 0, 1}};
  member.parameters = Vector::LinSpaced(member.shape.parameterCount(), -0.5, 0.5);
  member.prior = {Vector::Constant(2, 0.1), 2.0 * Matrix::Identity(2, 2), 0.01,
                  Vector::Constant(2, -4.0), Vector::Constant(2, 4.0)};
  StateOutput state;
  state.shift = 1.0 / 7.0;
  state.scale = 3.0;
  state.exogenous_shift = Vector::Constant(1, 0.2);
  state.exogenous_scale = Vector::Constant(1, 0.4);
  state.correction = Vector::Constant(4, 0.2);
  state.free_run_width = 0.4;
  state.one_step_width = 0.1;
  state.members = {member};
  m.state.outputs = {state};
  return m;
}

TEST(IdentifiedFile, IsLossless) {
  const IdentifiedModel m = example();
  const std::string text = writeIdentified(m);
  const IdentifiedModel back = parseIdentified(text, "memory");
  EXPECT_EQ(writeIdentified(back), text);
  EXPECT_EQ(back.outputs.front().best, ModelKind::kState);
  EXPECT_EQ(back.linear.front().rules.front().offset, 0.7);
  EXPECT_EQ(back.state.outputs.front().members.front().parameters,
            m.state.outputs.front().members.front().parameters);
  EXPECT_EQ(back.state.outputs.front().members.front().shape.upper, 1.0 / 3.0);
}

TEST(IdentifiedFile, KeepsHowRowsAreReadAndHowFarRunsGo) {
  IdentifiedModel m = example();
  EXPECT_EQ(writeIdentified(m).find("same_row"), std::string::npos);
  m.same_row = {true};
  m.reach = 12;
  const std::string text = writeIdentified(m);
  const IdentifiedModel back = parseIdentified(text, "memory");
  EXPECT_EQ(back.same_row, m.same_row);
  EXPECT_EQ(back.reach, 12);
  std::string other = text;
  other.replace(other.find("same_row: [u") + 11, 1, "w");
  EXPECT_THROW(parseIdentified(other, "memory"), InputError);
}

TEST(IdentifiedFile, KeepsABlendAndRefusesOneWithoutItsParts) {
  IdentifiedModel m = example();
  m.outputs.front().best = ModelKind::kBlend;
  m.outputs.front().blend_free_run_width = 0.3;
  m.outputs.front().blend_one_step_width = 0.05;
  const IdentifiedModel back = parseIdentified(writeIdentified(m), "memory");
  EXPECT_TRUE(back.has(ModelKind::kBlend));
  EXPECT_EQ(back.outputs.front().best, ModelKind::kBlend);
  EXPECT_EQ(back.outputs.front().blend_free_run_width, 0.3);
  EXPECT_EQ(back.outputs.front().blend_one_step_width, 0.05);
  IdentifiedModel no_state = m, no_width = m;
  no_state.state.outputs.clear();
  no_width.outputs.front().blend_free_run_width = 0.0;
  EXPECT_THROW(parseIdentified(writeIdentified(no_state), "memory"), InputError);
  EXPECT_THROW(parseIdentified(writeIdentified(no_width), "memory"), InputError);
}

TEST(IdentifiedFile, ABlendIsHalfOfTheRegressorsAndHalfOfTheState) {
  IdentifiedModel m = example();
  m.outputs.front() = {ModelKind::kBlend, 0.0, 0.0, 0.5, 0.25, 0.3, 0.05};
  DataSet data;
  data.outputs = m.model.outputs;
  data.inputs = m.model.inputs;
  data.sample_time_s = m.model.sample_time_s;
  data.values.resize(30, 2);
  for (Eigen::Index k = 0; k < 30; ++k)
    data.values.row(k) << 0.2 + 0.01 * k, k % 7 < 3 ? 0.5 : -0.5;
  const KindPrediction past = predictKind(m, ModelKind::kRegressors, data),
                       own = predictKind(m, ModelKind::kState, data), best = predictBest(m, data);
  const Matrix ahead = predictSteps(m, data, 2).best;
  m.outputs.front().best = ModelKind::kRegressors;
  const Matrix past_ahead = predictSteps(m, data, 2).best;
  m.outputs.front().best = ModelKind::kState;
  const Matrix own_ahead = predictSteps(m, data, 2).best;
  for (Eigen::Index k = 10; k < 20; ++k) {
    ASSERT_NE(past.free_run(k, 0), own.free_run(k, 0));
    EXPECT_EQ(best.free_run(k, 0), 0.5 * (past.free_run(k, 0) + own.free_run(k, 0)));
    EXPECT_EQ(best.one_step(k, 0), 0.5 * (past.one_step(k, 0) + own.one_step(k, 0)));
    EXPECT_EQ(ahead(k, 0), 0.5 * (past_ahead(k, 0) + own_ahead(k, 0)));
  }
  EXPECT_EQ(best.free_run_width[0], 0.3);
  EXPECT_EQ(best.one_step_width[0], 0.05);
}

TEST(IdentifiedFile, IsAModelFileForLoops) {
  const IdentifiedModel m = example();
  const TsModel model = parseModel(writeIdentified(m), "memory");
  EXPECT_EQ(writeModel(model), writeModel(m.model));
  const IdentifiedModel plain = parseIdentified(writeModel(m.model), "memory");
  EXPECT_TRUE(plain.outputs.empty());
  EXPECT_FALSE(plain.has(ModelKind::kState));
}

TEST(IdentifiedFile, RefusesTyposAndWrongSizes) {
  const std::string text = writeIdentified(example());
  const auto with = [&](const std::string& old, const std::string& now) {
    std::string other = text;
    const auto at = other.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    return other.replace(at, old.size(), now);
  };
  EXPECT_THROW(parseIdentified(with("start_noise", "start_nose"), "memory"), InputError);
  EXPECT_THROW(parseIdentified(with("best: state", "best: stade"), "memory"), InputError);
  EXPECT_THROW(parseIdentified(with("states: 2", "states: 3"), "memory"), InputError);
  EXPECT_THROW(parseIdentified(with("scaling: [", "scaling: [1, "), "memory"), InputError);
}

}  // namespace config_identified_file_test
}  // namespace fpc
