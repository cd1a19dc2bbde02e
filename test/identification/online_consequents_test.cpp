#include "identification/online_consequents.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "identification/identify_fixture.hpp"

namespace fpc {
namespace fuzzy_online_consequents_test {

const Vector kNone(0);

/// Feeds the record as measurements: y(k), u(k-1).
int feed(OnlineConsequents& online, const Matrix& record) {
  int learned = 0;
  for (Eigen::Index k = 0; k < record.rows(); ++k) {
    const double u = k > 0 ? record(k - 1, 1) : std::numeric_limits<double>::quiet_NaN();
    learned +=
        online.take(Vector::Constant(1, record(k, 0)), Vector::Constant(1, u), kNone) ? 1 : 0;
  }
  return learned;
}

/// The known model with crisp regions, so that local fits have the global answer.
TsModel crispModel(double gain = 0.4) {
  TsModel model = test::knownModel();
  model.submodels[0].rules[0].antecedents[0] = {MembershipShape::kTrapezoidal,
                                                {-10.0, -10.0, 0.0, 0.0}};
  model.submodels[0].rules[1].antecedents[0] = {MembershipShape::kTrapezoidal,
                                                {0.0, 0.0, 10.0, 10.0}};
  model.submodels[0].rules[0].coefficients[1] = gain;
  return model;
}

/// A record of a model, driven by steps.
Matrix recordOf(const TsModel& model, Eigen::Index rows, std::uint64_t seed) {
  Matrix record = test::knownRecord(rows, seed);
  FiringResult firing;
  for (Eigen::Index k = 0; k + 1 < rows; ++k) {
    firingWeights(model.submodels[0], Vector::Constant(1, record(k, 1)), firing);
    double next = 0.0;
    for (std::size_t r = 0; r < 2; ++r) {
      const Rule& rule = model.submodels[0].rules[r];
      next += firing.weights[static_cast<Eigen::Index>(r)] *
              (rule.coefficients.dot(record.row(k).transpose()) + rule.offset);
    }
    record(k + 1, 0) = next;
  }
  return record;
}

TEST(OnlineConsequents, AProcessThatHasChangedIsLearned) {
  RlsParams params;
  params.forgetting = 0.98;
  params.initial_covariance = 1.0;
  OnlineConsequents online(crispModel(0.4), params);
  EXPECT_EQ(feed(online, recordOf(crispModel(0.7), 3000, 1)), 2999);
  EXPECT_NEAR(online.model().submodels[0].rules[0].coefficients[1], 0.7, 1e-6);
  EXPECT_NEAR(online.model().submodels[0].rules[0].coefficients[0], 0.6, 1e-6);
  EXPECT_EQ(online.samples(), 2999U);
  EXPECT_NO_THROW(online.model().validate());
}

TEST(OnlineConsequents, APerfectModelStaysAsItIs) {
  OnlineConsequents online(crispModel(), {});
  feed(online, recordOf(crispModel(), 500, 2));
  for (std::size_t r = 0; r < 2; ++r)
    EXPECT_LT((online.model().submodels[0].rules[r].coefficients -
               crispModel().submodels[0].rules[r].coefficients)
                  .cwiseAbs()
                  .maxCoeff(),
              1e-9);
}

TEST(OnlineConsequents, GapsAndBadValuesTeachNothing) {
  OnlineConsequents online(crispModel(), {});
  const Matrix record = recordOf(crispModel(0.9), 20, 3);
  feed(online, record.topRows(5));
  online.forgetPast();
  const TsModel before = online.model();
  EXPECT_FALSE(online.take(Vector::Constant(1, 3.0), Vector::Constant(1, 1.0), kNone));
  EXPECT_FALSE(online.take(Vector::Constant(1, std::numeric_limits<double>::quiet_NaN()),
                           Vector::Constant(1, 1.0), kNone));
  EXPECT_FALSE(online.take(Vector::Constant(1, 3.0), Vector::Constant(1, 1.0),
                           kNone));  // its past is the bad one
  EXPECT_EQ(online.model().submodels[0].rules[0].coefficients,
            before.submodels[0].rules[0].coefficients);
  EXPECT_TRUE(online.take(Vector::Constant(1, 3.0), Vector::Constant(1, 1.0), kNone));
}

TEST(OnlineConsequents, WrongSizesAreNamed) {
  OnlineConsequents online(crispModel(), {});
  EXPECT_THROW(online.take(Vector::Zero(2), Vector::Zero(1), kNone), InputError);
  EXPECT_THROW(online.take(Vector::Zero(1), Vector::Zero(2), kNone), InputError);
  EXPECT_THROW(online.take(Vector::Zero(1), Vector::Zero(1), Vector::Zero(1)), InputError);
}

}  // namespace fuzzy_online_consequents_test
}  // namespace fpc
