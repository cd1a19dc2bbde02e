// The observer on a fuzzy model: a state on paper, late measurements, a constant disturbance.
#include "estimation/model_observer.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <random>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace control_model_observer_test {

/// y(k+1) = 0.8 y(k) + 0.5 u(k) + 0.1.
TsModel model() {
  TsModel m;
  m.name = "lag";
  m.sample_time_s = 1.0;
  m.outputs = {{"y", "1", 0, 1}};
  m.inputs = {{"u", "1", 0, 1}};
  OutputModel submodel;
  submodel.regressors = {{SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, 0}};
  Rule rule;
  rule.coefficients = (Vector(2) << 0.8, 0.5).finished();
  rule.offset = 0.1;
  submodel.rules = {rule};
  m.submodels = {submodel};
  return m;
}

ObserverParams params(double noise) {
  ObserverParams p;
  p.noise_std = Vector::Constant(1, noise);
  p.disturbance_std = Vector::Constant(1, 0.05);
  return p;
}

Vector one(double value) { return Vector::Constant(1, value); }

TEST(ModelObserver, AtRestItKnowsWhatTheModelLacks) {
  ModelObserver observer(LocalModel(model()), params(0.1), 0);
  observer.rest(one(2.0), one(0.4), Vector());
  EXPECT_NEAR(observer.disturbance()[0], 2.0 - (1.6 + 0.2 + 0.1), 1e-12);
  for (int k = 0; k < 20; ++k) {
    observer.advance(one(2.0), one(0.4), Vector());
    EXPECT_NEAR(observer.state()[0], 2.0, 1e-9);
    EXPECT_NEAR(observer.innovation()[0], 0.0, 1e-9);
  }
}

TEST(ModelObserver, LateMeasurementsAreRunForwardOnTheInputsSince) {
  constexpr int kDelay = 4;
  ModelObserver observer(LocalModel(model()), params(0.0), kDelay);
  std::vector<double> y(kDelay + 1, 0.5), seen;  // at rest: 0.8 * 0.5 + 0.1
  observer.rest(one(0.5), one(0.0), Vector());
  for (int k = 0; k < 60; ++k) {
    const double u = std::sin(0.3 * k);
    y.push_back(0.8 * y.back() + 0.5 * u + 0.1 + 0.2);  // 0.2 is not in the model
    observer.advance(one(y[y.size() - 1 - kDelay]), one(u), Vector());
    if (k < 20) continue;
    EXPECT_NEAR(observer.state()[0], y.back(), 1e-9) << k;
    EXPECT_NEAR(observer.disturbance()[0], 0.2, 1e-9);
    EXPECT_NEAR(observer.delayed()[0], y[y.size() - 1 - kDelay], 1e-9);
  }
}

TEST(ModelObserver, GoesOnFromAnotherOne) {
  ModelObserver first(LocalModel(model()), params(0.1), 2), second(first);
  first.rest(one(0.5), one(0.0), Vector());
  for (int k = 0; k < 10; ++k) first.advance(one(1.0), one(0.2), Vector());
  second.inherit(first);
  first.advance(one(1.1), one(0.3), Vector());
  second.advance(one(1.1), one(0.3), Vector());
  EXPECT_EQ(first.state(), second.state());
  EXPECT_EQ(first.disturbance(), second.disturbance());
}

/// y(k+1) = 0.8 y(k) + 0.5 u(k) + 2 w(k) - 1.5 w(k-1) + 0.1, and nobody measures w.
TsModel modelOfUnmeasured() {
  TsModel m = model();
  m.unmeasured = {{"w", "1", -1, 1}};
  m.submodels[0].regressors.push_back({SignalKind::kUnmeasured, 0, 0});
  m.submodels[0].regressors.push_back({SignalKind::kUnmeasured, 0, 1});
  m.submodels[0].rules[0].coefficients = (Vector(4) << 0.8, 0.5, 2.0, -1.5).finished();
  return m;
}

TEST(ModelObserver, EstimatesWhatNobodyMeasures) {
  constexpr int kDelay = 3;
  ObserverParams known = params(0.0);
  known.disturbance_std[0] = 1e-6;
  known.estimated = {{"w", 1.0, 0.0}};
  ModelObserver observer(LocalModel(modelOfUnmeasured()), known, kDelay);
  std::vector<double> y(kDelay + 1, 0.5);
  observer.rest(one(0.5), one(0.0), Vector());
  double before = 0.0;
  for (int k = 0; k < 30; ++k) {
    const double w = 0.3, u = std::sin(0.3 * k);
    y.push_back(0.8 * y.back() + 0.5 * u + 2.0 * w - 1.5 * before + 0.1);
    before = w;
    observer.advance(one(y[y.size() - 1 - kDelay]), one(u), Vector());
    if (k < kDelay) {
      EXPECT_EQ(observer.estimated(0), 0.0) << "it was not there before the start";
    } else {
      EXPECT_NEAR(observer.estimated(0), w, 1e-6) << k;
      EXPECT_NEAR(observer.state()[0], y.back(), 1e-5) << k;
    }
  }
}

/// What rested at an unknown output, walked 25 samples and is then read eleven times, by least
/// squares over where it rested and each change of w; u = 0.
struct WalkBeforeStart {
  static constexpr int kWalked = 25, kRead = 10, kUnknown = 1 + kWalked + kRead;
  static constexpr double kNoise = 0.05, kWalk = 0.02;

  /// y at the start and later, then w at the end. theta: y at rest, changes of w.
  static Vector course(const Vector& theta) {
    Vector seen(kRead + 2);
    double y = theta[0], w = 0.0, before = 0.0;
    for (int k = 0; k < kWalked + kRead; ++k) {
      if (k >= kWalked) seen[k - kWalked] = y;
      y = 0.8 * y + 2.0 * w - 1.5 * before + 0.2 * theta[0];
      before = w;
      w += theta[1 + k];
    }
    seen[kRead] = y;
    seen[kRead + 1] = w;
    return seen;
  }

  static Vector leastSquares(const Vector& readings) {
    Matrix A = Matrix::Zero(readings.size() + kUnknown - 1, kUnknown);
    Vector b = Vector::Zero(A.rows());
    for (int j = 0; j < kUnknown; ++j)
      A.col(j).head(readings.size()) =
          course(Vector::Unit(kUnknown, j)).head(readings.size()) / kNoise;
    b.head(readings.size()) = readings / kNoise;
    for (int j = 1; j < kUnknown; ++j) A(readings.size() + j - 1, j) = 1.0 / kWalk;
    return A.colPivHouseholderQr().solve(b);
  }
};

TEST(ModelObserver, BeginsWithAProcessThatHasMovedBeforeTheStart) {
  using Walk = WalkBeforeStart;
  ObserverParams moving = params(Walk::kNoise);
  moving.disturbance_std[0] = 0.0;
  moving.estimated = {{"w", 5.0 * Walk::kWalk, Walk::kWalk}};  // 5^2 = 25 samples
  TsModel wide = modelOfUnmeasured();
  wide.outputs[0].lower = -1e6;
  ModelObserver observer(LocalModel(wide), moving, 0);
  std::mt19937_64 engine(7);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 20; ++round) {
    Vector theta(Walk::kUnknown);
    for (double& value : theta) value = Walk::kWalk * normal(engine);
    theta[0] = 10.0 * normal(engine);
    Vector readings = Walk::course(theta).head(Walk::kRead + 1);
    for (double& value : readings) value += Walk::kNoise * normal(engine);
    observer.rest(one(readings[0]), one(0.0), Vector());
    for (int k = 1; k <= Walk::kRead; ++k) observer.advance(one(readings[k]), one(0.0), Vector());
    const Vector best = Walk::course(Walk::leastSquares(readings));
    EXPECT_NEAR(observer.state()[0], best[Walk::kRead], 1e-7);
    EXPECT_NEAR(observer.estimated(0), best[Walk::kRead + 1], 1e-7);
  }
}

TEST(ModelObserver, AnUnstableProcessHasNotMovedOutOfItsRangeBeforeTheStart) {
  TsModel unstable = modelOfUnmeasured();
  unstable.submodels[0].rules[0].coefficients[0] = 1.5;
  ObserverParams moving = params(0.05);
  moving.disturbance_std[0] = 0.0;
  moving.estimated = {{"w", 1e6, 0.001}};
  ModelObserver observer(LocalModel(unstable), moving, 0);
  observer.rest(one(0.5), one(0.0), Vector());
  observer.advance(one(0.6), one(0.0), Vector());
  EXPECT_TRUE(observer.state().allFinite());
  EXPECT_GT(observer.innovation()[0], 0.0);
  EXPECT_NE(observer.estimated(0), 0.0);
  EXPECT_LT(std::abs(observer.estimated(0)), 1.0);
}

TEST(ModelObserver, ARestInTheRunKeepsWhatNobodyMeasuresAndANewRunDoesNot) {
  ObserverParams known = params(0.001);
  known.disturbance_std[0] = 1e-6;
  known.estimated = {{"w", 1.0, 0.01}};
  ModelObserver observer(LocalModel(modelOfUnmeasured()), known, 0);
  observer.rest(one(0.5), one(0.0), Vector(), true);
  EXPECT_EQ(observer.estimated(0), 0.0) << "its first rest: a start all the same";
  const double rest = (0.1 + 0.5 * 0.3) / 0.2;
  double y = 0.5, before = 0.0;
  for (int k = 0; k < 80; ++k) {
    y = 0.8 * y + 2.0 * 0.3 - 1.5 * before + 0.1;
    before = 0.3;
    observer.advance(one(y), one(0.0), Vector());
  }
  const double found = observer.estimated(0);
  EXPECT_NEAR(found, 0.3, 1e-3);
  observer.rest(one(rest), one(0.0), Vector(), true);
  EXPECT_EQ(observer.estimated(0), found);
  EXPECT_NEAR(observer.disturbance()[0], 0.0, 1e-3) << "the estimate explains why it rests there";
  for (int k = 0; k < 20; ++k) observer.advance(one(rest), one(0.0), Vector());
  EXPECT_NEAR(observer.estimated(0), 0.3, 1e-3);
  ModelObserver forgetful = observer;
  forgetful.forget();
  forgetful.rest(one(rest), one(0.0), Vector(), true);
  EXPECT_EQ(forgetful.estimated(0), 0.0) << "as its first rest";
  observer.rest(one(rest), one(0.0), Vector());
  EXPECT_EQ(observer.estimated(0), 0.0);
}

TEST(ModelObserver, FollowsAWalkOfWhatNobodyMeasures) {
  ObserverParams known = params(0.001);
  known.disturbance_std[0] = 0.0;  // whether w was there at rest stays open
  known.estimated = {{"w", 1.0, 0.05}};
  ModelObserver observer(LocalModel(modelOfUnmeasured()), known, 0);
  observer.rest(one(0.5), one(0.0), Vector());
  double y = 0.5, before = 0.0, found = 0.0;
  for (int k = 0; k < 200; ++k) {
    const double w = k < 100 ? 0.3 : -0.2;
    if (k == 100) found = observer.estimated(0);
    y = 0.8 * y + 2.0 * w - 1.5 * before + 0.1;
    before = w;
    observer.advance(one(y), one(0.0), Vector());
  }
  EXPECT_NEAR(observer.estimated(0) - found, -0.5, 0.01);
  EXPECT_NEAR(observer.innovation()[0], 0.0, 0.01);
}

TEST(ModelObserver, NamesAnEstimatedDisturbanceThatTheModelLacks) {
  ObserverParams known = params(0.1);
  known.estimated = {{"v", 1.0, 0.0}};
  try {
    ModelObserver(LocalModel(modelOfUnmeasured()), known, 0);
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("controller.observer.estimated.v"), std::string::npos)
        << e.what();
  }
}

}  // namespace control_model_observer_test
}  // namespace fpc
