// Outputs that depend on each other: found by the search, judged by joint free runs.
#include "identification/auto_coupling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "base/random.hpp"
#include "identification/auto_identify.hpp"
#include "identification/coupled_candidates.hpp"
#include "identification/prediction.hpp"

namespace fpc {
namespace fuzzy_auto_coupling_test {

using Eigen::Index;
/// y(k+1) from y(k), y(k-1) and the inputs.
using Law = std::function<Vector(const Vector& y, const Vector& before, const Vector& u)>;

DataSet simulate(const Law& law, Index n_y, Index n_u, Index rows, double noise,
                 std::uint64_t seed) {
  std::mt19937_64 random(seed);
  DataSet data;
  data.source = "simulated";
  data.sample_time_s = 1.0;
  data.values.resize(rows, n_y + n_u);
  Vector y = Vector::Zero(n_y), before = y, u = Vector::Zero(n_u);
  for (Index k = 0; k < rows; ++k) {
    for (Index j = 0; j < n_u; ++j)
      if (k % (6 + 5 * j) == 0) u[j] = 2.0 * uniform(random) - 1.0;
    for (Index i = 0; i < n_y; ++i) data.values(k, i) = y[i] + noise * standardNormal(random);
    data.values.row(k).tail(n_u) = u.transpose();
    const Vector next = law(y, before, u);
    before = y;
    y = next;
  }
  for (Index c = 0; c < n_y + n_u; ++c)
    (c < n_y ? data.outputs : data.inputs)
        .push_back({(c < n_y ? "y" : "u") + std::to_string(c), "", data.values.col(c).minCoeff(),
                    data.values.col(c).maxCoeff()});
  data.constant.assign(static_cast<std::size_t>(n_y + n_u), false);
  return data;
}

/// Three oscillators side by side; the first output is their sum through a lag, of order seven in
/// the input.
Vector sum(const Vector& y, const Vector& before, const Vector& u) {
  constexpr double kRadius = 0.97;
  Vector next(4);
  next[0] = 0.5 * y[0] + 0.2 * (y[1] + y[2] + y[3]);
  const double angle[] = {0.25, 0.6, 1.1}, gain[] = {0.1, 0.2, 0.4};
  for (Index i = 1; i < 4; ++i)
    next[i] = 2.0 * kRadius * std::cos(angle[i - 1]) * y[i] - kRadius * kRadius * before[i] +
              gain[i - 1] * u[0];
  return next;
}

/// The second output, slow, is how strongly the first answers to its input.
Vector product(const Vector& y, const Vector&, const Vector& u) {
  Vector next(2);
  next << 0.8 * y[0] + 0.2 * u[0] * (1.0 + y[1]), 0.97 * y[1] + 0.06 * u[1];
  return next;
}

Vector apart(const Vector& y, const Vector&, const Vector& u) {
  Vector next(2);
  next << 0.8 * y[0] + 0.2 * u[0], 0.9 * y[1] + 0.1 * u[0];
  return next;
}

AutoParams quick() {
  AutoParams p;
  p.states = false;
  p.budget_s = 300.0;
  return p;
}

bool takesOthers(const TsModel& model, int output) {
  const auto& list = model.submodels[static_cast<std::size_t>(output)].regressors;
  return std::any_of(list.begin(), list.end(), [output](const Regressor& r) {
    return r.kind == SignalKind::kOutput && r.index != output;
  });
}

double freeRunError(const TsModel& model, const DataSet& data, Index output) {
  return fitFigures(data.values.col(output), predictFreeRun(model, data).col(output)).rmse;
}

/// The same record with its first output only.
DataSet firstOnly(DataSet data) {
  const auto n_y = static_cast<Index>(data.outputs.size()), n_u = data.values.cols() - n_y;
  Matrix values(data.rows(), 1 + n_u);
  values << data.values.col(0), data.values.rightCols(n_u);
  data.values = values;
  data.outputs.resize(1);
  data.constant.assign(static_cast<std::size_t>(1 + n_u), false);
  return data;
}

TEST(AutoCoupling, OtherOutputsAreTakenWhereOneAloneIsNotEnough) {
  const DataSet data = simulate(sum, 4, 1, 240, 0.01, 1), other = simulate(sum, 4, 1, 240, 0.0, 2);
  const AutoIdentification found = autoIdentify(data, quick());
  ASSERT_TRUE(takesOthers(found.linear, 0));
  const AutoIdentification alone = autoIdentify(firstOnly(data), quick());
  EXPECT_LT(found.outputs[0].linear.mean, 0.5 * alone.outputs[0].linear.mean);
  EXPECT_LT(freeRunError(found.linear, other, 0),
            0.5 * freeRunError(alone.linear, firstOnly(other), 0));
  const auto chosen = std::find_if(found.trials.begin(), found.trials.end(), [](const auto& t) {
    return t.output == "y0" && t.kind == ModelKind::kLinear && t.chosen;
  });
  ASSERT_NE(chosen, found.trials.end());
  EXPECT_NE(chosen->structure.find("with other outputs"), std::string::npos) << chosen->structure;
  EXPECT_NE(chosen->structure.find("(y1"), std::string::npos) << chosen->structure;
  EXPECT_NEAR(chosen->free_run, found.outputs[0].linear.mean, 1e-12);
}

TEST(AutoCoupling, RulesTakeAnotherOutputToo) {
  const DataSet data = simulate(product, 2, 2, 400, 0.01, 3);
  const AutoIdentification found = autoIdentify(data, quick());
  ASSERT_TRUE(takesOthers(found.model, 0));
  EXPECT_GT(found.model.submodels[0].rules.size(), 1U);
  EXPECT_EQ(found.outputs[0].best, ModelKind::kRegressors) << found.outputs[0].verdict;
  const DataSet other = simulate(product, 2, 2, 400, 0.0, 4);
  const AutoIdentification alone = autoIdentify(firstOnly(data), quick());
  EXPECT_LT(freeRunError(found.model, other, 0),
            0.7 * freeRunError(alone.model, firstOnly(other), 0));
}

TEST(AutoCoupling, OutputsThatDoNotGainStayAlone) {
  const DataSet data = simulate(apart, 2, 1, 200, 0.05, 5);
  const AutoIdentification found = autoIdentify(data, quick());
  for (const int output : {0, 1}) {
    EXPECT_FALSE(takesOthers(found.linear, output));
    EXPECT_FALSE(takesOthers(found.model, output));
  }
}

TEST(AutoCoupling, WhatIsKnownKeepsAnOutputAlone) {
  const DataSet data = simulate(sum, 4, 1, 240, 0.01, 1);
  AutoParams params = quick();
  params.known.resize(4);
  params.known[0].max_pole = 0.99;
  const AutoIdentification found = autoIdentify(data, params);
  EXPECT_FALSE(takesOthers(found.linear, 0));
}

TEST(AutoCoupling, FormsAreOnePerSetOfOtherOutputs) {
  SearchedOutput alone;
  EXPECT_EQ(linearForms(alone, 0, 2).size(), 10U) << "five orders, one step or free run";
  const auto forms = linearForms(alone, 1, 3);
  ASSERT_EQ(forms.size(), 30U);
  EXPECT_EQ(forms.front().partners, std::vector<int>{0});
  EXPECT_EQ(forms.back().partners, (std::vector<int>{0, 2}));
  for (const auto& c : ruleForms(alone, 1, 3)) EXPECT_GT(c.rules, 1) << c.text();
  alone.data.known.max_pole = 0.9;
  EXPECT_TRUE(linearForms(alone, 1, 3).empty());
  EXPECT_TRUE(ruleForms(alone, 1, 3).empty());
}

TEST(AutoCoupling, MoreRulesAroundAChoiceWithOthersOnly) {
  Candidate c;
  c.rules = 4;
  c.antecedents = AntecedentChoice::kInputs;
  EXPECT_TRUE(nearForms(c).empty());
  c.partners = {1};
  const auto near = nearForms(c);
  ASSERT_EQ(near.size(), 3U);
  EXPECT_EQ(near[0].rules, 6);
  EXPECT_EQ(near[1].antecedents, AntecedentChoice::kOutputAndInputs);
  c.rules = 1;
  EXPECT_TRUE(nearForms(c).empty());
}

}  // namespace fuzzy_auto_coupling_test
}  // namespace fpc
