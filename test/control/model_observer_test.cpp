// The observer on a fuzzy model: a state on paper, late measurements, a constant disturbance.
#include "fmbpc/control/model_observer.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace control_model_observer_test
}  // namespace fpc
