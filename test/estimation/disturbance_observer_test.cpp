// The observer against answers known on paper: a level whose disturbance is constant.
#include "estimation/disturbance_observer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/random.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace control_disturbance_observer_test {

ObserverParams params(double noise, double change) {
  ObserverParams p;
  p.noise_std = Vector::Constant(1, noise);
  p.disturbance_std = Vector::Constant(1, change);
  return p;
}

/// x(k+1) = 0.9 x + u + d of one output, predicted by hand.
struct Level {
  explicit Level(const ObserverParams& p) : observer(p, 1, {0}) {}
  void see(double y, double u) {
    state[0] = 0.9 * state[0] + u;
    observer.addDisturbance(state);
    observer.predict(Matrix::Constant(1, 1, 0.9));
    ok = observer.correct(Vector::Constant(1, y), state);
  }
  DisturbanceObserver observer;
  Vector state = Vector::Zero(1);
  bool ok{true};
};

TEST(DisturbanceObserver, WithoutNoiseItIsTheRawDifference) {
  Level level(params(0.0, 1.0));
  double y = 0.0;
  for (int k = 0; k < 20; ++k) {
    const double u = std::sin(0.7 * k), d = k < 10 ? 0.5 : -1.0;
    const double expected = 0.9 * y + u;
    y = expected + d;
    level.see(y, u);
    ASSERT_TRUE(level.ok);
    EXPECT_NEAR(level.state[0], y, 1e-12);
    EXPECT_NEAR(level.observer.disturbance()[0], d, 1e-9) << k;
  }
}

TEST(DisturbanceObserver, SteadyGainSolvesTheRiccatiEquation) {
  const double r = 0.3, q = 0.05;
  Level level(params(r, q));
  for (int k = 0; k < 2000; ++k) level.see(0.0, 0.0);
  // P = F (P - P C' (C P C' + R)^-1 C P) F' + Q by plain iteration.
  Matrix F(2, 2), P = Matrix::Identity(2, 2);
  F << 0.9, 1.0, 0.0, 1.0;
  Vector gain(2);
  for (int k = 0; k < 5000; ++k) {
    gain = P.col(0) / (P(0, 0) + r * r);
    const Matrix rest = P - gain * P.row(0);
    P = F * rest * F.transpose();
    P(1, 1) += q * q;
  }
  gain = P.col(0) / (P(0, 0) + r * r);
  EXPECT_NEAR(level.observer.gain()(0, 0), gain[0], 1e-9);
  EXPECT_NEAR(level.observer.gain()(1, 0), gain[1], 1e-9);
}

/// Standard deviation of the estimate of a constant d = 1 after it has settled.
double spread(const ObserverParams& p, double noise) {
  Level level(p);
  std::mt19937_64 engine = seededEngine(7, {1});
  double y = 0.0, sum = 0.0;
  constexpr int kSamples = 4000;
  for (int k = 0; k < kSamples; ++k) {
    y = 0.9 * y + 1.0;
    level.see(y + noise * standardNormal(engine), 0.0);
    if (k >= kSamples / 2) sum += std::pow(level.observer.disturbance()[0] - 1.0, 2);
  }
  return std::sqrt(sum / (kSamples / 2));
}

TEST(DisturbanceObserver, StatedNoiseIsNotTakenForDisturbance) {
  EXPECT_LT(spread(params(0.1, 0.01), 0.1), 0.2 * spread(params(0.0, 0.01), 0.1));
}

TEST(DisturbanceObserver, ADisturbanceThatChangesIsFollowedInTheEnd) {
  Level level(params(0.1, 0.01));
  double y = 0.0;
  for (int k = 0; k < 400; ++k) {
    y = 0.9 * y + (k < 200 ? 1.0 : 3.0);
    level.see(y, 0.0);
  }
  EXPECT_NEAR(level.observer.disturbance()[0], 3.0, 1e-3);
}

TEST(DisturbanceObserver, AnOutputThatIsNotFiniteChangesNothing) {
  Level level(params(0.1, 0.01));
  level.see(1.0, 0.0);
  const double d = level.observer.disturbance()[0];
  level.see(std::nan(""), 0.0);
  EXPECT_FALSE(level.ok);
  EXPECT_EQ(level.observer.disturbance()[0], d);
  level.see(1.0, 0.0);
  EXPECT_TRUE(level.ok);
  EXPECT_TRUE(std::isfinite(level.observer.disturbance()[0]));
}

ObserverParams atInput(double noise, double change) {
  ObserverParams p = params(noise, 1.0);
  p.input_std = Vector::Constant(1, change);
  return p;
}

// x1+ = 0.9 x1 + x2, x2+ = 0.5 x2 + 2 (u + d), y = x1: a disturbance that shows two samples later.
TEST(DisturbanceObserver, AtTheInputTheSteadyGainSolvesTheRiccatiEquation) {
  const double r = 0.3, q = 0.05;
  Matrix A(2, 2), E(2, 1), F = Matrix::Identity(3, 3), P = Matrix::Identity(3, 3);
  A << 0.9, 1.0, 0.0, 0.5;
  E << 0.0, 2.0;
  F.topLeftCorner(2, 2) = A;
  F.topRightCorner(2, 1) = E;
  DisturbanceObserver observer(atInput(r, q), 2, {0});
  Vector state = Vector::Zero(2), gain(3);
  for (int k = 0; k < 2000; ++k) {
    observer.predict(A, E);
    ASSERT_TRUE(observer.correct(Vector::Zero(1), state));
  }
  for (int k = 0; k < 5000; ++k) {
    gain = P.col(0) / (P(0, 0) + r * r);
    P = (F * (P - gain * P.row(0)) * F.transpose()).eval();
    P(2, 2) += q * q;
  }
  gain = P.col(0) / (P(0, 0) + r * r);
  for (Eigen::Index i = 0; i < 3; ++i) EXPECT_NEAR(observer.gain()(i, 0), gain[i], 1e-9) << i;
}

TEST(DisturbanceObserver, AtTheInputAConstantOneIsFound) {
  Matrix A(2, 2), E(2, 1);
  A << 0.9, 1.0, 0.0, 0.5;
  E << 0.0, 2.0;
  DisturbanceObserver observer(atInput(0.3, 0.05), 2, {0});
  Vector state = Vector::Zero(2), truth = state;
  for (int k = 0; k < 400; ++k) {
    truth = (A * truth + E * 0.7).eval();
    state = (A * state + E * observer.disturbance()).eval();
    observer.predict(A, E);
    ASSERT_TRUE(observer.correct(truth.head(1), state));
  }
  EXPECT_NEAR(observer.disturbance()[0], 0.7, 1e-6);
  EXPECT_NEAR(state[1], truth[1], 1e-6);
}

// After reset() with a root r the first gain is P c / (c' P c + R), P = r r'.
TEST(DisturbanceObserver, AStartTakesTheCovarianceItIsGiven) {
  DisturbanceObserver observer(atInput(0.3, 0.05), 2, {0});
  observer.reset((Matrix(2, 1) << 0.4, -2.0).finished());
  observer.predict(Matrix::Identity(2, 2), Matrix::Zero(2, 1));
  Vector state = Vector::Zero(2);
  ASSERT_TRUE(observer.correct(Vector::Ones(1), state));
  EXPECT_NEAR(state[0], 0.16 / (0.16 + 0.09), 1e-12);
  EXPECT_NEAR(state[1], -0.8 / (0.16 + 0.09), 1e-12);
}

TEST(DisturbanceObserver, MistakesNameTheirKey) {
  const auto errorWith = [](ObserverParams p) -> std::string {
    try {
      p.validate(1);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(errorWith(params(-1.0, 1.0)).find("noise_std"), std::string::npos);
  EXPECT_NE(errorWith(params(1.0, 0.0)).find("disturbance_std"), std::string::npos);
  ObserverParams p = params(1.0, 0.0);
  p.estimated = {{"load", 1.0, 0.1}};
  EXPECT_EQ(errorWith(p), "");
  EXPECT_EQ(errorWith(atInput(1.0, 0.0)), "");
  EXPECT_NE(errorWith(atInput(1.0, -1.0)).find("input_std"), std::string::npos);
  p = atInput(1.0, 1.0);
  p.input_std = Vector::Ones(2);  // two that one output shows
  EXPECT_NE(errorWith(p).find("input_std"), std::string::npos);
}

}  // namespace control_disturbance_observer_test
}  // namespace fpc
