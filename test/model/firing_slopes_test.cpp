// Derivatives of fuzzy sets, of the rules' weights and of a blended model along state and input.
#include "model/firing_slopes.hpp"

#include <gtest/gtest.h>

#include "fmbpc/model/local_model.hpp"
#include "identification/multivariate_fixture.hpp"

namespace fpc {
namespace fuzzy_firing_slopes_test {

double slope(MembershipShape shape, const std::vector<double>& parameters, double z) {
  return Membership{shape, parameters}.logSlope(z);
}

TEST(FiringSlopes, OfSetsAsOnPaper) {
  EXPECT_EQ(slope(MembershipShape::kGaussian, {0.0, 2.0}, 1.0), -0.25);
  const std::vector<double> four{0.0, 1.0, 2.0, 4.0}, three{0.0, 1.0, 3.0};
  EXPECT_EQ(slope(MembershipShape::kExponential, four, 0.5), 7.0);  // 14 (1 - z)
  EXPECT_EQ(slope(MembershipShape::kExponential, four, 1.5), 0.0);
  EXPECT_EQ(slope(MembershipShape::kExponential, four, 3.0), -3.5);  // -14 (z - 2) / 4
  EXPECT_EQ(slope(MembershipShape::kTriangular, three, 0.5), 2.0);   // 1 / z
  EXPECT_EQ(slope(MembershipShape::kTriangular, three, 2.0), -1.0);  // -1 / (3 - z)
  EXPECT_EQ(slope(MembershipShape::kTriangular, three, 1.0), -0.5);  // the top: from the right
  EXPECT_EQ(slope(MembershipShape::kTriangular, three, 5.0), 0.0);
  EXPECT_EQ(slope(MembershipShape::kTrapezoidal, four, 3.0), -1.0);
  EXPECT_EQ(slope(MembershipShape::kTrapezoidal, {0.0, 0.0, 1.0, 1.0}, 2.0), 0.0);  // crisp
}

TEST(FiringSlopes, OfWeightsSumToNothingAndVanishWhereNoRuleFires) {
  OutputModel model;
  model.antecedents = {{SignalKind::kOutput, 0, 0}};
  for (const double top : {0.0, 1.0}) {
    Rule rule;
    rule.antecedents = {{MembershipShape::kTriangular, {top - 1.0, top, top + 1.0}}};
    rule.coefficients = Vector(0);
    model.rules.push_back(rule);
  }
  FiringResult firing;
  Matrix slopes(2, 1);
  firingWeights(model, Vector::Constant(1, 0.25), firing);
  firingSlopes(model, Vector::Constant(1, 0.25), firing, slopes);
  EXPECT_NEAR(slopes(0, 0), -1.0, 1e-15);  // weights 1 - z and z
  EXPECT_NEAR(slopes(1, 0), 1.0, 1e-15);
  firingWeights(model, Vector::Constant(1, 9.0), firing);
  firingSlopes(model, Vector::Constant(1, 9.0), firing, slopes);
  EXPECT_EQ(slopes, Matrix::Zero(2, 1));
}

/// xi(k+1) and its derivatives by state and input against central differences.
void expectDerivatives(const TsModel& model, std::mt19937_64& generator) {
  LocalModel local(model);
  const Eigen::Index n_x = local.stateSize(), n_u = static_cast<Eigen::Index>(model.inputs.size());
  Vector state = test::randomVector(generator, n_x), u = test::randomVector(generator, n_u);
  const Vector d =
      test::randomVector(generator, static_cast<Eigen::Index>(model.disturbances.size()));
  local.blend(state, u, d);
  Matrix A = local.affine().A, B = local.affine().B;
  local.addSlopes(state, u, d, A, B);
  const double h = 1e-5;
  const auto difference = [&](double& variable) {
    const double here = variable;
    Vector above, below;
    variable = here + h;
    local.advance(state, u, d, above);
    variable = here - h;
    local.advance(state, u, d, below);
    variable = here;
    return Vector((above - below) / (2.0 * h));
  };
  for (Eigen::Index j = 0; j < n_x; ++j)
    EXPECT_LT((difference(state[j]) - A.col(j)).cwiseAbs().maxCoeff(), 1e-7) << "state " << j;
  for (Eigen::Index a = 0; a < n_u; ++a)
    EXPECT_LT((difference(u[a]) - B.col(a)).cwiseAbs().maxCoeff(), 1e-7) << "input " << a;
}

/// Bells made into exponential sets of the same middle.
TsModel exponential(TsModel model) {
  for (auto& submodel : model.submodels)
    for (auto& rule : submodel.rules)
      for (auto& set : rule.antecedents) {
        const double c = set.parameters[0], w = set.parameters[1];
        set = {MembershipShape::kExponential, {c - 4.0 * w, c - 0.1 * w, c + 0.2 * w, c + 5.0 * w}};
      }
  return model;
}

TEST(FiringSlopes, OfABlendedModelAreItsDerivatives) {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    const int s = static_cast<int>(seed);
    const TsModel model = test::randomModel(
        generator, {1 + s % 3, 1 + s % 2, s % 3, 1 + s % 4, 1 + s % 3, s % 3, 2, 1});
    expectDerivatives(model, generator);
    expectDerivatives(exponential(model), generator);
    expectDerivatives(test::multivariate(model), generator);
  }
}

}  // namespace fuzzy_firing_slopes_test
}  // namespace fpc
