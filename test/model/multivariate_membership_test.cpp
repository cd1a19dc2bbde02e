#include "fmbpc/model/multivariate_membership.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "config/model_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/model/local_model.hpp"
#include "fmbpc/model/model_match.hpp"
#include "identification/multivariate_fixture.hpp"

namespace fpc {
namespace fuzzy_multivariate_membership_test {

using Eigen::Vector2d;

Matrix two(double a, double b, double c) { return (Matrix(2, 2) << a, b, b, c).finished(); }

const MultivariateMembership kTilted{Vector2d(1.0, 2.0), two(2.0, 1.0, 3.0)};

TEST(MultivariateMembership, DegreesAreThoseOfTheFormula) {
  EXPECT_EQ(kTilted.logDegree(Vector2d(1.0, 2.0)), 0.0);
  EXPECT_EQ(kTilted.logDegree(Vector2d(2.0, 1.0)), -1.5);  // 2 - 2 + 3
  EXPECT_EQ(kTilted.logDegree(Vector2d(3.0, 2.0)), -4.0);  // 8
  EXPECT_EQ(kTilted.logDegree(Vector2d(2.0, 4.0)), -9.0);  // 2 + 4 + 12
  EXPECT_NEAR(kTilted.distance(Vector2d(2.0, 1.0)), std::sqrt(3.0), 1e-15);
}

TEST(MultivariateMembership, WithADiagonalItIsTheProductOfBells) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    const TsModel bells = test::randomModel(generator, {}), one = test::multivariate(bells);
    const auto n = static_cast<Eigen::Index>(bells.submodels[0].antecedents.size());
    FiringResult a, b;
    for (const double size : {1.0, 10.0, 1e4, 1e9}) {
      const Vector z = test::randomVector(generator, n, size);
      firingWeights(bells.submodels[0], z, a);
      firingWeights(one.submodels[0], z, b);
      EXPECT_LT((a.weights - b.weights).cwiseAbs().maxCoeff(), 1e-12);
    }
  }
}

TEST(MultivariateMembership, WeightsAreSharesOfOneEverywhereWhateverTheRank) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    const auto n = static_cast<Eigen::Index>(1 + seed % 6);
    OutputModel model;
    model.rules.resize(1 + seed % 5);
    for (auto& rule : model.rules) {
      const auto rank = static_cast<Eigen::Index>(generator() % 7U) % (n + 1);
      rule.multivariate = {test::randomVector(generator, n, 3.0),
                           test::randomSemidefinite(generator, n, rank)};
      EXPECT_NO_THROW(rule.multivariate->validate("rule", n));
    }
    for (const double size : {1.0, 1e3, 1e12, 1e150, 1e300, 1.7e308}) {
      const Vector z = test::randomVector(generator, n, 0.5) * size * 2.0;
      FiringResult firing;
      firingWeights(model, z, firing);
      EXPECT_TRUE((firing.weights.array() >= 0.0).all()) << "size " << size;
      EXPECT_NEAR(firing.weights.sum(), 1.0, 1e-12) << "size " << size;
      for (const auto& rule : model.rules) EXPECT_LE(rule.multivariate->logDegree(z), 0.0);
    }
  }
}

TEST(MultivariateMembership, WhereAllDegreesVanishTheNearestRuleStandsIn) {
  OutputModel model;
  model.rules.resize(2);
  model.rules[0].multivariate = {Vector2d(0.0, 0.0), two(4.0, 0.0, 4.0)};
  model.rules[1].multivariate = {Vector2d(0.0, 0.0), two(1.0, 0.0, 1.0)};
  FiringResult firing;
  firingWeights(model, Vector2d(1e200, -1e200), firing);
  EXPECT_FALSE(firing.fired);
  EXPECT_EQ(firing.weights, Vector2d(0.0, 1.0));
  firingWeights(model, Vector2d(1e3, -1e3), firing);  // both underflow, their logarithms do not
  EXPECT_TRUE(firing.fired);
  EXPECT_EQ(firing.weights, Vector2d(0.0, 1.0));
}

TEST(MultivariateMembership, ADirectionWithoutWeightHasNoneFarAwayEither) {
  const MultivariateMembership unused{Vector2d(1.0, 5.0), two(2.0, 0.0, 0.0)};
  EXPECT_EQ(unused.logDegree(Vector2d(2.0, 1e12)), -1.0);
  const double third = 1.0 / 3.0;
  const MultivariateMembership flat{Vector2d(0.0, 0.0), two(1.0, third, third * third)};
  for (const double far : {1.0, 1e6, 1e12})
    EXPECT_EQ(flat.logDegree(Vector2d(far * third, -far)), 0.0) << far;
}

TEST(MultivariateMembership, ProjectionsAreTheHighestDegreesOverTheOtherVariables) {
  EXPECT_NEAR(kTilted.projectedPrecision(0), 5.0 / 3.0, 1e-14);  // 2 - 1 / 3
  EXPECT_NEAR(kTilted.projectedPrecision(1), 2.5, 1e-14);        // 3 - 1 / 2
  const MultivariateMembership flat{Vector2d(0.0, 0.0), two(1.0, -2.0, 4.0)};
  EXPECT_NEAR(flat.projectedPrecision(0), 0.0, 1e-9);
  const MultivariateMembership unused{Vector2d(0.0, 0.0), two(2.0, 0.0, 0.0)};
  EXPECT_NEAR(unused.projectedPrecision(0), 2.0, 1e-14);
  EXPECT_EQ(unused.projectedPrecision(1), 0.0);
}

TEST(MultivariateMembership, ValidateNamesThePartThatIsWrong) {
  const auto expect = [](const std::string& part, Vector center, Matrix S) {
    try {
      MultivariateMembership{std::move(center), std::move(S)}.validate("rule", 2);
      ADD_FAILURE() << "accepted: " << part;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
    }
  };
  const Vector center = Vector2d(0.0, 0.0);
  expect("rule.center: expected 2 numbers", Vector::Zero(3), two(1.0, 0.0, 1.0));
  expect("2 x 2", center, Matrix::Identity(2, 3));
  expect("rule.center: expected finite", Vector2d(0.0, std::nan("")), two(1.0, 0.0, 1.0));
  expect("rule.inverse_covariance: expected finite", center, two(HUGE_VAL, 0.0, 1.0));
  expect("symmetric", center, (Matrix(2, 2) << 1.0, 0.5, 0.4, 1.0).finished());
  expect("eigenvalues", center, two(1.0, 1.001, 1.0));
  expect("eigenvalues", center, two(1.0, 0.1, 0.0));
  expect("eigenvalues", center, two(1.0, 0.0, -1e-9));
  expect("eigenvalues", center, two(1e12, 1.1, 1e-12));  // whatever the units
  EXPECT_NO_THROW((MultivariateMembership{center, two(1e12, 1.0, 1e-12)}.validate("rule", 2)));
}

TEST(MultivariateModel, RulesOfBothKindsInOneOutputAreRefused) {
  std::mt19937_64 generator(3);
  const TsModel bells = test::randomModel(generator, {}), one = test::multivariate(bells);
  const auto complaint = [](const TsModel& model) -> std::string {
    try {
      model.validate();
    } catch (const InputError& e) {
      return e.what();
    }
    return "nothing";
  };
  EXPECT_EQ(complaint(one), "nothing");
  TsModel mixed = bells;
  mixed.submodels[1] = one.submodels[1];  // another output may differ
  EXPECT_EQ(complaint(mixed), "nothing");
  mixed.submodels[1].rules[2] = bells.submodels[1].rules[2];
  EXPECT_EQ(complaint(mixed).rfind("submodels.y2.rules[2]", 0), 0U) << complaint(mixed);
  TsModel doubled = one;
  doubled.submodels[0].rules[0].antecedents = bells.submodels[0].rules[0].antecedents;
  EXPECT_EQ(complaint(doubled).rfind("submodels.y1.rules[0]", 0), 0U) << complaint(doubled);
}

TEST(MultivariateModel, ALocalModelIsThatOfTheProductOfBells) {
  std::mt19937_64 generator(5);
  const TsModel bells = test::randomModel(generator, {});
  LocalModel a(bells), b(test::multivariate(bells));
  for (int i = 0; i < 20; ++i) {
    const Vector state = test::randomVector(generator, a.affine().A.rows(), 2.0);
    const Vector d = test::randomVector(generator, 1, 2.0);
    EXPECT_EQ(a.blend(state, d), b.blend(state, d));
    EXPECT_LT((a.affine().A - b.affine().A).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((a.affine().g - b.affine().g).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(MultivariateModel, TheReportNamesVariablesWithoutInfluence) {
  std::mt19937_64 generator(6);
  TsModel model = test::multivariate(test::randomModel(generator, {}));
  auto& S = model.submodels[0].rules[1].multivariate->inverse_covariance;
  S.row(2).setZero();
  S.col(2).setZero();
  int named = 0;
  for (const auto& remark : reportModel(model))
    if (remark.text == "membership does not depend on y2(k)") {
      EXPECT_EQ(remark.output, "y1");
      EXPECT_EQ(remark.rule, 2U);
      ++named;
    }
  EXPECT_EQ(named, 1);
}

TEST(MultivariateModel, MatchedToAPlantItMeansTheSame) {
  std::mt19937_64 generator(7);
  TsModel model = test::multivariate(test::randomModel(generator, {}));
  for (auto& rule : model.submodels[0].rules)
    rule.multivariate->inverse_covariance =
        test::randomSemidefinite(generator, rule.multivariate->center.size(), 5);
  PlantInfo plant = test::infoOf(model);
  std::swap(plant.outputs[0], plant.outputs[1]);
  std::swap(plant.inputs[0], plant.inputs[1]);
  const TsModel matched = matchToPlant(model, plant);
  const auto n = static_cast<Eigen::Index>(model.submodels[0].antecedents.size());
  for (Eigen::Index i = 0; i < n; ++i)  // the order of the antecedents is the centre's
    EXPECT_EQ(matched.text(matched.submodels[1].antecedents[static_cast<std::size_t>(i)]),
              model.text(model.submodels[0].antecedents[static_cast<std::size_t>(i)]));
  const Vector z = test::randomVector(generator, n, 2.0);
  FiringResult before, after;
  firingWeights(model.submodels[0], z, before);
  firingWeights(matched.submodels[1], z, after);
  EXPECT_EQ(before.weights, after.weights);
}

const char* const kFile = R"(name: small
sample_time_s: 60
outputs: {y: K}
inputs: {u: "1"}
submodels:
  y:
    antecedents: [y(k), u(k)]
    regressors: [y(k), u(k)]
    rules:
      - when:
          center: {u(k): 2, y(k): 1}
          inverse_covariance:
            y(k): [2, 1]
            u(k): [1, 3]
        then: {y(k): 0.5, u(k): 3, offset: -1}
)";

std::string complaint(const std::string& from, const std::string& to) {
  std::string text = kFile;
  text.replace(text.find(from), from.size(), to);
  try {
    parseModel(text, "small.yaml");
  } catch (const InputError& e) {
    return e.what();
  }
  return "nothing";
}

TEST(MultivariateModelFile, ReadsWhatAPersonWrites) {
  const Rule rule = parseModel(kFile, "small.yaml").submodels[0].rules[0];
  ASSERT_TRUE(rule.multivariate.has_value());
  EXPECT_TRUE(*rule.multivariate == kTilted);
  EXPECT_TRUE(rule.antecedents.empty());
}

TEST(MultivariateModelFile, RoundTripsAreBitForBit) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    TsModel model = test::multivariate(test::randomModel(generator, {}));
    for (auto& rule : model.submodels[1].rules)
      rule.multivariate->inverse_covariance =
          test::randomSemidefinite(generator, rule.multivariate->center.size(), 3) * 1e-7;
    const std::string text = writeModel(model);
    const TsModel read = parseModel(text, "again");
    EXPECT_EQ(writeModel(read), text);
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t r = 0; r < model.submodels[i].rules.size(); ++r)
        EXPECT_TRUE(read.submodels[i].rules[r].multivariate ==
                    model.submodels[i].rules[r].multivariate);
  }
}

TEST(MultivariateModelFile, EveryMistakeNamesFileLineAndKey) {
  const auto expect = [](const std::string& from, const std::string& to,
                         const std::string& line_and_key) {
    const std::string text = complaint(from, to);
    EXPECT_EQ(text.rfind("small.yaml" + line_and_key, 0), 0U) << text;
  };
  const std::string when = "submodels.y.rules[0].when";
  expect("u(k): 2, ", "", ":11: " + when + ".center.u(k)");
  expect("u(k): 2, ", "u(k): .inf, ", ":11: " + when + ".center.u(k)");
  expect("u(k): 2, ", "u(k): 2, v: 3, ", ":11: " + when + ".center.v");
  expect("          center: {u(k): 2, y(k): 1}\n", "", ":11: " + when + ".center");
  expect("[1, 3]", "[1, 3, 4]", ":14: " + when + ".inverse_covariance.u(k)");
  expect("            u(k): [1, 3]\n", "", ":13: " + when + ".inverse_covariance.u(k)");
  expect("[1, 3]", "[0.9, 3]", ":11: " + when + ".inverse_covariance");
  expect("[1, 3]", "[1, 0.1]", ":11: " + when + ".inverse_covariance");
  expect("          center:", "          y(k): {gaussian: [0, 1]}\n          center:",
         ":11: " + when + ".y(k)");
}

}  // namespace fuzzy_multivariate_membership_test
}  // namespace fpc
