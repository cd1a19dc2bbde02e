// The model of a search against the equations on paper and against the general evaluation of rules.
#include "model/choice_model.hpp"

#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"
#include "identification/data_set.hpp"
#include "identification/multivariate_fixture.hpp"
#include "identification/prediction.hpp"

namespace fpc {
namespace fuzzy_choice_model_test {

Matrix valves() {  // eq. 43
  Matrix P(3, 7);
  P << 0, 0.01, 0.02, 0.05, 0.1, 1, 1, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 0;
  return P;
}

Vector stepped(ChoiceModel& model, int choice, Vector state) {
  EXPECT_TRUE(model.step(choice, Vector(0), state));
  return state;
}

TEST(ChoiceModel, AtTheTopOfASetTheHybridModelIsThatRuleOfThatMode) {
  ChoiceModel model(test::shippedModel("batch_fuzzy"), valves());
  ASSERT_EQ(model.stateSize(), 2);
  EXPECT_TRUE(model.isMemoryless());
  const Eigen::Vector2d at(35.0, 40.0);  // T, Tw
  const Vector hot = stepped(model, 4, at), cold = stepped(model, 6, at);
  EXPECT_NEAR(hot[0], 0.0033 * 40.0 + 0.9967 * 35.0, 1e-12);
  EXPECT_NEAR(hot[1], 0.9429 * 40.0 + 0.0395 * 35.0 + 10.5969 * 0.1 + 0.5273, 1e-12);
  EXPECT_NEAR(cold[1], 0.9322 * 40.0 + 0.0466 * 35.0 - 7.8013 + 0.5650, 1e-12);
}

TEST(ChoiceModel, BetweenTwoSetsItIsTheirMeanAndOutsideTheirShoulder) {
  ChoiceModel model(test::shippedModel("batch_fuzzy"), valves());
  const double third = 0.9429 * 50.0 + 0.0395 * 35.0 + 0.5273;
  const double fourth = 0.9396 * 50.0 + 0.0339 * 35.0 + 1.2701;
  EXPECT_NEAR(stepped(model, 0, Eigen::Vector2d(35.0, 50.0))[1], 0.5 * (third + fourth), 1e-12);
  EXPECT_NEAR(stepped(model, 0, Eigen::Vector2d(35.0, 90.0))[1],
              0.7910 * 90.0 + 0.0225 * 35.0 + 12.0404, 1e-12);
  EXPECT_NEAR(stepped(model, 6, Eigen::Vector2d(10.0, 5.0))[1],
              0.9803 * 5.0 + 0.0025 * 10.0 - 0.0704 + 0.2707, 1e-12);
}

TEST(ChoiceModel, ColdWaterCoolsAndHotWaterHeatsEverywhere) {
  ChoiceModel model(test::shippedModel("batch_fuzzy"), valves());
  for (double Tw = 13.0; Tw <= 73.0; Tw += 1.0) {
    const Eigen::Vector2d at(Tw, Tw);
    EXPECT_LT(stepped(model, 6, at)[1], Tw) << "Tw " << Tw;
    EXPECT_GT(stepped(model, 5, at)[1], Tw) << "Tw " << Tw;
  }
}

TEST(ChoiceModel, AnInputOfNoModeTakesTheNearestRuleAndSaysSo) {
  ChoiceModel model(test::shippedModel("batch_fuzzy"), Eigen::Vector3d(0.1, 0.0, 0.0));
  Vector state = Eigen::Vector2d(35.0, 40.0);
  EXPECT_FALSE(model.step(0, Vector(0), state));
  EXPECT_TRUE(state.allFinite());
}

// The same rows as the identifier's own predictor sees them.
void expectSamePredictions(const TsModel& matched, const Matrix& choices, const DataSet& data,
                           const std::vector<int>& chosen) {
  ChoiceModel model(matched, choices);
  const auto n_y = static_cast<Eigen::Index>(matched.outputs.size());
  const auto n_u = choices.rows();
  const auto n_d = static_cast<Eigen::Index>(matched.disturbances.size());
  Vector state(model.stateSize());
  const auto row = [&](Eigen::Index k) { return Vector(data.values.row(k).transpose()); };
  const Eigen::Index start = 6;
  model.restState(row(0).head(n_y), row(0).segment(n_y, n_u), row(0).tail(n_d), state);
  for (Eigen::Index k = 1; k <= start; ++k)
    model.shiftState(row(k).head(n_y), row(k - 1).segment(n_y, n_u), row(k - 1).tail(n_d), state);
  const Matrix one_step = predictOneStep(matched, data);
  for (Eigen::Index k = start; k + 1 < data.rows(); ++k) {
    Vector next = state;
    model.step(chosen[static_cast<std::size_t>(k)], row(k).tail(n_d), next);
    for (Eigen::Index i = 0; i < n_y; ++i)
      EXPECT_NEAR(next[model.outputState(i)], one_step(k + 1, i),
                  1e-11 * (1.0 + std::abs(one_step(k + 1, i))))
          << "sample " << k;
    model.shiftState(row(k + 1).head(n_y), row(k).segment(n_y, n_u), row(k).tail(n_d), state);
  }
}

TEST(ChoiceModel, RandomModelsWithLagsAndDisturbancesPredictAsTheIdentifierDoes) {
  constexpr unsigned kSeed = 17;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 generator(kSeed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int trial = 0; trial < 20; ++trial) {
    test::RandomModelShape shape;
    shape.input_delay = trial % 2;
    const TsModel model = test::randomModel(generator, shape);
    Matrix choices(2, 4);
    for (double& value : flat(choices)) value = unit(generator);
    DataSet data;
    data.source = "random";
    data.sample_time_s = model.sample_time_s;
    data.outputs = model.outputs;
    data.inputs = model.inputs;
    data.disturbances = model.disturbances;
    data.values = Matrix(40, 5);
    std::vector<int> chosen;
    for (Eigen::Index k = 0; k < 40; ++k) {
      chosen.push_back(static_cast<int>(generator() % 4));
      for (Eigen::Index j = 0; j < 5; ++j) data.values(k, j) = unit(generator);
      data.values.row(k).segment(2, 2) = choices.col(chosen.back()).transpose();
    }
    expectSamePredictions(model, choices, data, chosen);
  }
}

TEST(ChoiceModel, WrongSizesAreRefused) {
  const TsModel model = test::shippedModel("batch_fuzzy");
  EXPECT_THROW(ChoiceModel(model, Matrix::Zero(2, 7)), InputError);
  EXPECT_THROW(ChoiceModel(model, Matrix(3, 0)), InputError);
}

TEST(ChoiceModel, MultivariateMembershipsAreRefused) {
  std::mt19937_64 generator(1);
  const TsModel model = test::multivariate(test::randomModel(generator, {}));
  EXPECT_THROW(ChoiceModel(model, Matrix::Zero(2, 3)), InputError);
}

TEST(HybridModel, FileAndBackLosesNothing) {
  for (const char* name : {"batch_fuzzy", "batch_linear"}) {
    const TsModel model = test::shippedModel(name);
    EXPECT_EQ(writeModel(parseModel(writeModel(model), "copy")), writeModel(model));
    EXPECT_EQ(model.submodels[1].rules.size(), name == std::string("batch_fuzzy") ? 10U : 2U);
  }
}

}  // namespace fuzzy_choice_model_test
}  // namespace fpc
