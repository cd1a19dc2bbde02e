#include "fmbpc/model/local_model.hpp"

#include <gtest/gtest.h>

#include <deque>

#include "identification/model_fixture.hpp"

namespace fpc {
namespace fuzzy_local_model_test {

/// Newest first: signals as a person would write them down.
struct History {
  std::deque<Vector> y, u, d;  // y(k), y(k-1)..; u(k), u(k-1)..; d(k), d(k-1)..
  double value(const Regressor& r) const {
    const auto& past = r.kind == SignalKind::kOutput ? y : r.kind == SignalKind::kInput ? u : d;
    return past[static_cast<std::size_t>(r.lag)][r.index];
  }
};

/// y_i(k+1) straight from the definition of the rules; u(k) in an antecedent reads u(k-1).
double fromRules(const OutputModel& model, const History& past) {
  Vector at(static_cast<Eigen::Index>(model.antecedents.size()));
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    Regressor variable = model.antecedents[static_cast<std::size_t>(i)];
    if (variable.kind == SignalKind::kInput && variable.lag == 0) variable.lag = 1;
    at[i] = past.value(variable);
  }
  FiringResult firing;
  firingWeights(model, at, firing);
  double sum = 0.0;
  for (std::size_t r = 0; r < model.rules.size(); ++r) {
    double consequent = model.rules[r].offset;
    for (std::size_t j = 0; j < model.regressors.size(); ++j)
      consequent += model.rules[r].coefficients[static_cast<Eigen::Index>(j)] *
                    past.value(model.regressors[j]);
    sum += firing.weights[static_cast<Eigen::Index>(r)] * consequent;
  }
  return sum;
}

TEST(LocalModel, AOneRuleModelEqualsItsLinearConsequent) {
  LocalModel local(test::shippedModel("fm_1"));
  TsModel one = local.model();
  for (auto& submodel : one.submodels) submodel.rules.resize(1);
  LocalModel linear(one);
  ASSERT_EQ(linear.stateSize(), 3);  // s, x, q_r(k-1)
  const Vector state = (Vector(3) << 60.0, 1950.0, 700.0).finished();
  const Vector d = (Vector(2) << 1300.0, 366.67).finished();
  EXPECT_TRUE(linear.blend(state, d));
  const double u = 650.0;
  const Vector next =
      linear.affine().A * state + linear.affine().B * Vector::Constant(1, u) + linear.affine().g;
  EXPECT_NEAR(next[0],
              0.854 * 60.0 - 0.0081 * 1950.0 + 0.00409 * 1300.0 + 0.0157 * 366.67 - 0.0188 * u +
                  0.0191 * 700.0 + 14.1,
              1e-10);
  EXPECT_NEAR(next[1], 0.993 * 1950.0 - 0.0208 * 1300.0 + 0.00772 * u + 43.7, 1e-10);
  EXPECT_EQ(next[2], u);
}

TEST(LocalModel, RowsStackAsTheHeaderSays) {
  std::mt19937_64 generator(1);
  const LocalModel local(test::randomModel(generator, {2, 2, 1, 2, 3, 1, 2, 3}));
  EXPECT_EQ(local.stateSize(), 2 * 3 + 2 * 2 + 2);
  EXPECT_EQ(local.outputState(0), 0);
  EXPECT_EQ(local.outputState(1, 2), 5);
  EXPECT_EQ(local.inputState(0, 1), 6);
  EXPECT_EQ(local.inputState(1, 2), 9);
  EXPECT_EQ(local.disturbanceState(0, 1), 10);
  EXPECT_EQ(local.disturbanceState(0, 2), 11);
}

TEST(LocalModel, FreeRunEqualsTheRulesWithAnyLagsAndDelays) {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    const int s = static_cast<int>(seed);
    const test::RandomModelShape shape{1 + s % 3, 1 + s % 2, s % 3,     1 + s % 4,
                                       1 + s % 3, s % 4,     1 + s % 2, 1 + s % 3};
    LocalModel local(test::randomModel(generator, shape));
    const TsModel& model = local.model();
    const Vector y0 = test::randomVector(generator, shape.n_y),
                 u0 = test::randomVector(generator, shape.n_u),
                 d0 = test::randomVector(generator, shape.n_d);
    History past;
    past.y.assign(10, y0);
    past.u.assign(10, u0);
    past.d.assign(10, d0);
    Vector state(local.stateSize());
    local.restState(y0, u0, d0, state);
    for (int k = 0; k < 30; ++k) {
      const Vector u = test::randomVector(generator, shape.n_u),
                   d = test::randomVector(generator, shape.n_d);
      past.u.push_front(u);
      past.d.push_front(d);
      Vector y(shape.n_y);
      for (Eigen::Index i = 0; i < y.size(); ++i)
        y[i] = fromRules(model.submodels[static_cast<std::size_t>(i)], past);
      past.y.push_front(y);
      Vector shifted = state;
      local.shiftState(y, u, d, shifted);
      ASSERT_TRUE(local.blend(state, d));
      state = local.affine().A * state + local.affine().B * u + local.affine().g;
      EXPECT_LT((local.affine().C * state - y).cwiseAbs().maxCoeff(), 1e-11);
      EXPECT_LT((shifted - state).cwiseAbs().maxCoeff(), 1e-11);
    }
  }
}

TEST(LocalModel, AnUnknownInputInTheAntecedentIsThePreviousOne) {
  TsModel model = test::shippedModel("fm_1");
  LocalModel local(model);
  const Vector state = (Vector(3) << 60.0, 2000.0, 1400.0).finished();
  const Vector d = (Vector(2) << 1300.0, 366.67).finished();
  local.blend(state, d);
  FiringResult expected;
  firingWeights(model.submodels[1], (Vector(3) << 2000.0, 1300.0, 1400.0).finished(), expected);
  EXPECT_EQ(local.firing()[1].weights, expected.weights);
}

TEST(LocalModel, SaysWhenNoRuleFired) {
  TsModel model = test::shippedModel("fm_1");
  for (auto& rule : model.submodels[1].rules)
    rule.antecedents[0] = {MembershipShape::kTriangular, {1900.0, 2000.0, 2100.0}};
  LocalModel local(model);
  const Vector d = (Vector(2) << 1300.0, 366.67).finished();
  EXPECT_FALSE(local.blend((Vector(3) << 60.0, 3000.0, 570.0).finished(), d));
  EXPECT_TRUE(local.affine().A.allFinite());
  EXPECT_TRUE(local.blend((Vector(3) << 60.0, 2000.0, 570.0).finished(), d));
}

}  // namespace fuzzy_local_model_test
}  // namespace fpc
