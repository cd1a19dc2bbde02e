#include "control/fmbpc/coincidence.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fmbpc/model/local_model.hpp"
#include "identification/model_fixture.hpp"

namespace fpc {
namespace control_fmbpc_coincidence_test {

TEST(CoincidenceGains, StackedPredictionEqualsSteppingTheModel) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    LocalModel local(test::randomModel(generator, {}));
    Vector state = test::randomVector(generator, local.stateSize());
    local.blend(state, test::randomVector(generator, 1));
    const AffineModel& model = local.affine();
    const Vector u = test::randomVector(generator, 2);
    CoincidenceGains gains(local.stateSize(), 2, 2);
    const int horizon = 1 + static_cast<int>(seed);
    ASSERT_TRUE(gains.computeWeighted(model, horizon, Vector::Ones(2), Vector::Ones(2)));
    const Vector stacked = gains.free() * state + gains.sum() * (model.B * u + model.g);
    PowerSum powers(local.stateSize());
    powers.compute(model.A, horizon);
    EXPECT_LT((gains.free() - model.C * powers.power()).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((gains.sum() - model.C * powers.sum()).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_LT((gains.effect() - gains.sum() * model.B).cwiseAbs().maxCoeff(), 1e-12);
    for (int i = 0; i < horizon; ++i) state = (model.A * state + model.B * u + model.g).eval();
    EXPECT_LT((model.C * state - stacked).cwiseAbs().maxCoeff(), 1e-11);
  }
}

TEST(CoincidenceGains, FarHorizonsEqualSteppingTheModel) {
  for (const int horizon : {32, 33, 48, 180, 1000}) {
    SCOPED_TRACE("horizon " + std::to_string(horizon));
    AffineModel model(3, 1, 2);
    model.A << 0.97, 0.01, 0.2, -0.03, 0.9, 0.1, 0.0, 0.0, 0.0;
    model.B << 0.4, 0.1, 1.0;
    model.C << 1.0, 0.0, 0.0, 0.0, 1.0, 0.0;
    CoincidenceGains gains(3, 1, 2);
    ASSERT_TRUE(gains.computeWeighted(model, horizon, Vector::Ones(2), Vector::Ones(1)));
    Vector state = (Vector(3) << 3.0, -2.0, 1.0).finished();
    const Vector u = Vector::Constant(1, 0.7);
    const Vector stacked = gains.free() * state + gains.sum() * model.B * u;
    for (int i = 0; i < horizon; ++i) state = (model.A * state + model.B * u).eval();
    EXPECT_LT((model.C * state - stacked).cwiseAbs().maxCoeff(), 1e-12 * stacked.norm());
    EXPECT_LT((gains.effect() - gains.sum() * model.B).norm(), 1e-12 * gains.effect().norm());
  }
}

TEST(CoincidenceGains, WeightedInputMinimisesItsCost) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    LocalModel local(test::randomModel(generator, {}));
    local.blend(test::randomVector(generator, local.stateSize()), test::randomVector(generator, 1));
    CoincidenceGains gains(local.stateSize(), 2, 2);
    const Vector w = (Vector(2) << 3.0, 0.5).finished(), l = (Vector(2) << 0.1, 0.7).finished();
    ASSERT_TRUE(gains.computeWeighted(local.affine(), 5, w, l));
    const Vector e = test::randomVector(generator, 2), before = test::randomVector(generator, 2);
    const Vector u = gains.gain() * e + gains.moveGain() * before;
    const Vector slope = gains.effect().transpose() * w.cwiseProduct(gains.effect() * u - e) +
                         l.cwiseProduct(u - before);
    EXPECT_LT(slope.cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(CoincidenceGains, ADivergingSubmodelCannotReachAnOutputThatDoesNotDependOnIt) {
  AffineModel model(2, 1, 2);
  model.A << -2.47e6, -8.91e4, 0.0, 0.95;  // FM_2, substrate rule 1
  model.B << 3.95e5, 0.03;
  model.C.setIdentity();
  CoincidenceGains gains(2, 1, 2);
  ASSERT_TRUE(gains.computePublished(model, 180));
  const double m2 = 0.03 * (1.0 - std::pow(0.95, 180)) / 0.05;
  EXPECT_NEAR(gains.gain()(0, 1), 1.0 / m2, 1e-12 / m2);
  ASSERT_TRUE(gains.computeWeighted(model, 180, Vector::Unit(2, 1), Vector::Zero(1)));
  EXPECT_NEAR(gains.gain()(0, 1), 1.0 / m2, 1e-12 / m2);
  EXPECT_FALSE(gains.computeWeighted(model, 180, Vector::Ones(2), Vector::Ones(1)));
}

TEST(CoincidenceGains, AnInputWithoutEffectIsReported) {
  AffineModel model(1, 1, 1);
  model.A << 0.9;
  model.C << 1.0;
  CoincidenceGains gains(1, 1, 1);
  EXPECT_FALSE(gains.computePublished(model, 5));
  EXPECT_FALSE(gains.computeWeighted(model, 5, Vector::Ones(1), Vector::Zero(1)));
  EXPECT_FALSE(gains.computeWeighted(model, 5, Vector::Ones(1), Vector::Ones(1)))
      << "a weight of moves does not hide it";
  EXPECT_TRUE(gains.isIdle(0));
}

TEST(CoincidenceGains, OneOfTwoInputsWithoutEffectIsNamedAndRests) {
  AffineModel model(2, 2, 2);
  model.A << 0.9, 0.0, 0.0, 0.8;
  model.B << 0.5, 0.0, 0.0, 0.3;
  model.C << 1.0, 0.0, 0.0, 1.0;
  CoincidenceGains gains(2, 2, 2);
  ASSERT_TRUE(gains.computeWeighted(model, 5, Vector::Ones(2), Vector::Ones(2)));
  EXPECT_FALSE(gains.isIdle(0) || gains.isIdle(1));
  ASSERT_TRUE(gains.computeWeighted(model, 5, Vector::Unit(2, 0), Vector::Constant(2, 1e-30)));
  EXPECT_TRUE(gains.isIdle(1)) << "the output that it moves has no weight";
  EXPECT_NEAR(gains.moveGain()(1, 1), 1.0, 1e-12);
  EXPECT_FALSE(gains.computeWeighted(model, 5, Vector::Unit(2, 0), Vector::Zero(2)));
}

TEST(CoincidenceGains, EffectsThatCancelCountAsNone) {
  AffineModel model(2, 1, 1);
  model.A << 1.0, -0.1, 0.0, 1.0;  // the input raises y by 0.1 at once and lowers it later
  model.B << 0.1, 0.4;
  model.C << 1.0, 0.0;
  CoincidenceGains gains(2, 1, 1);
  ASSERT_TRUE(gains.computePublished(model, 5));
  EXPECT_FALSE(gains.computePublished(model, 6));  // 6 * 0.1 - 15 * 0.1 * 0.4 = 0
}

// y(k+1) = 0.1 u(k) + 0.2 u(k-1) - 0.3 u(k-2) has no effect after 3 samples; a gain of 1e16 is
// rounding.
TEST(CoincidenceGains, BothLawsRefuseWhatCancels) {
  AffineModel model(3, 1, 1);
  model.A << 0.0, 0.2, -0.3, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0;  // y, u(k-1), u(k-2)
  model.B << 0.1, 1.0, 0.0;
  model.C << 1.0, 0.0, 0.0;
  CoincidenceGains gains(3, 1, 1);
  for (const int horizon : {3, 4, 7}) {
    EXPECT_FALSE(gains.computePublished(model, horizon)) << horizon;
    EXPECT_FALSE(gains.computeWeighted(model, horizon, Vector::Ones(1), Vector::Zero(1)));
    for (const double weight : {1e-30, 1e-12, 0.01, 1.0})
      EXPECT_FALSE(
          gains.computeWeighted(model, horizon, Vector::Ones(1), Vector::Constant(1, weight)));
  }
  EXPECT_TRUE(gains.computeWeighted(model, 2, Vector::Ones(1), Vector::Zero(1)));
}

TEST(CoincidenceGains, TwoInputsThatDoTheSameAreSingularWithoutMoveWeight) {
  AffineModel model(1, 2, 1);
  model.A << 0.9;
  model.B << 1.0, 1000.0;
  model.C << 1.0;
  CoincidenceGains gains(1, 2, 1);
  EXPECT_FALSE(gains.computeWeighted(model, 5, Vector::Ones(1), Vector::Zero(2)));
  EXPECT_TRUE(gains.computeWeighted(model, 5, Vector::Ones(1), Vector::Constant(2, 0.01)));
}

}  // namespace control_fmbpc_coincidence_test
}  // namespace fpc
