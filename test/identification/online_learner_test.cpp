#include "identification/online_learner.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "fmbpc/base/input_error.hpp"
#include "identification/identify_fixture.hpp"
#include "identification/model_fixture.hpp"
#include "identification/prediction.hpp"

namespace fpc {
namespace fuzzy_online_learner_test {

/// Measurement k of the record: y(k), u(k-1).
Measurement sample(const Matrix& record, Eigen::Index k) {
  Measurement m;
  m.header.step = static_cast<std::uint32_t>(k);
  m.outputs = Vector::Constant(1, record(k, 0));
  m.input_applied = Vector::Constant(1, k > 0 ? record(k - 1, 1) : 0.0);
  m.disturbances = Vector(0);
  return m;
}

OnlineParams every(int samples) {
  OnlineParams params;
  params.every = samples;
  return params;
}

/// Steps at which models were due.
std::vector<std::uint32_t> feed(OnlineLearner& learner, const Matrix& record,
                                Eigen::Index first = 0) {
  std::vector<std::uint32_t> due;
  for (Eigen::Index k = first; k < record.rows(); ++k)
    if (learner.take(sample(record, k), k == first ? Arrival::kFirst : Arrival::kNext))
      due.push_back(static_cast<std::uint32_t>(k));
  return due;
}

TsModel wrongModel() {
  TsModel model = test::knownModel();
  for (Rule& rule : model.submodels[0].rules) {
    rule.coefficients.setZero();
    rule.offset = 0.0;
  }
  return model;
}

TEST(OnlineLearner, ModelsAreDueAtMultiplesOfTheStepWhereverItJoins) {
  const Matrix record = test::knownRecord(100, 3);
  const PlantInfo plant = test::infoOf(test::knownModel());
  OnlineLearner early(wrongModel(), plant, every(25)), late(wrongModel(), plant, every(25));
  EXPECT_EQ(feed(early, record), (std::vector<std::uint32_t>{25, 50, 75}));
  EXPECT_EQ(feed(late, record, 60), (std::vector<std::uint32_t>{75}));
}

TEST(OnlineLearner, LearnsAProcessItDidNotKnow) {
  OnlineParams params = every(100);
  params.rls = {1.0, 1e6, 1e8};
  OnlineLearner learner(wrongModel(), test::infoOf(test::knownModel()), params);
  feed(learner, test::knownRecord(2000, 3));
  const TsModel learned = learner.model();
  ASSERT_EQ(learner.samples(), 1999u);
  EXPECT_NE(learned.source.find("online from 1999 samples"), std::string::npos);
  const OutputModel truth = test::knownModel().submodels[0];
  const Matrix record = test::knownRecord(500, 9);
  const DataSet data = makeDataSet(record, test::knownStructure(), "test");
  const Matrix predicted = predictOneStep(learned, data);
  EXPECT_GT(fitFigures(record.col(0), predicted.col(0)).vaf, 99.0);
  EXPECT_EQ(learned.submodels[0].rules[0].antecedents[0].parameters,
            truth.rules[0].antecedents[0].parameters);
}

TEST(OnlineLearner, NothingLearnedNothingDue) {
  const Matrix record = test::knownRecord(40, 3);
  OnlineLearner learner(wrongModel(), test::infoOf(test::knownModel()), every(10));
  for (Eigen::Index k = 0; k < 40; ++k)  // every sample after a gap: no past to learn from
    EXPECT_FALSE(learner.take(sample(record, k), Arrival::kGap));
  EXPECT_EQ(learner.samples(), 0u);
}

TEST(OnlineLearner, BadParametersAreNamed) {
  const PlantInfo plant = test::infoOf(test::knownModel());
  EXPECT_THROW(OnlineLearner(wrongModel(), plant, every(0)), InputError);
  OnlineParams params;
  params.rls.forgetting = 0.0;
  EXPECT_THROW(OnlineLearner(wrongModel(), plant, params), InputError);
}

}  // namespace fuzzy_online_learner_test
}  // namespace fpc
