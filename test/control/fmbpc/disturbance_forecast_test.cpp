// What is expected of disturbances, on numbers one can follow.
#include "control/fmbpc/disturbance_forecast.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace control_fmbpc_disturbance_forecast_test {

constexpr int kPeriod = 6, kHorizon = 4;

Vector one(double value) { return Vector::Constant(1, value); }
double daily(int k) { return std::sin(2.0 * M_PI * k / kPeriod); }

TEST(DisturbanceForecast, HoldsUntilAPeriodHasBeenSeen) {
  DisturbanceForecast forecast(1, kHorizon, kPeriod, 0.5);
  for (std::uint32_t k = 0; k < kPeriod; ++k) {
    forecast.add(k, one(k));
    EXPECT_EQ(forecast.predict(), Matrix::Constant(1, kHorizon, k)) << k;
  }
}

TEST(DisturbanceForecast, AfterAPeriodWhatRepeatsItselfIsForeseen) {
  DisturbanceForecast forecast(1, kHorizon, kPeriod, 0.5);
  for (int k = 0; k <= 2 * kPeriod; ++k) {
    forecast.add(static_cast<std::uint32_t>(k), one(daily(k)));
    if (k < kPeriod) continue;
    for (int i = 0; i < kHorizon; ++i)
      EXPECT_NEAR(forecast.predict()(0, i), daily(k + i), 1e-12) << k << " + " << i;
  }
}

TEST(DisturbanceForecast, WhatIsExpectedGoesBeforeItAtItsSampleOnly) {
  DisturbanceForecast forecast(2, kHorizon, 0, 0.5);
  const double nan = std::nan("");
  const auto at = [&](std::uint32_t k) {
    forecast.add(k, (Vector(2) << 1.0, 2.0).finished());
    return forecast.predict();
  };
  Matrix held(2, kHorizon), first = held;
  held << 1.0, 1.0, 1.0, 1.0, 2.0, 2.0, 2.0, 2.0;
  first << 1.0, 1.0, 1.0, 1.0, 2.0, 7.0, 8.0, 8.0;  // after the last one as there
  EXPECT_EQ(at(0), held);
  forecast.expect(1, 1, (Vector(3) << nan, 7.0, 8.0).finished());
  EXPECT_EQ(at(1), first);
  EXPECT_EQ(at(2), held);
  forecast.expect(4, 0, one(5.0));
  EXPECT_EQ(at(3), held);
  forecast.expect(5, 1, one(6.0));
  first << 1.0, 1.0, 1.0, 1.0, 6.0, 6.0, 6.0, 6.0;
  EXPECT_EQ(at(5), first) << "that of sample 4 is gone";
}

TEST(DisturbanceForecast, TodaysDifferenceDiesOutWithThePole) {
  DisturbanceForecast forecast(1, kHorizon, kPeriod, 0.5);
  for (int k = 0; k <= kPeriod; ++k)
    forecast.add(static_cast<std::uint32_t>(k), one(daily(k) + (k == kPeriod ? 0.8 : 0.0)));
  for (int i = 0; i < kHorizon; ++i)
    EXPECT_NEAR(forecast.predict()(0, i), daily(i) + 0.8 * std::pow(0.5, i), 1e-12);
}

TEST(DisturbanceForecast, WithoutAPeriodItHolds) {
  DisturbanceForecast forecast(2, kHorizon, 0, 0.5);
  for (std::uint32_t k = 0; k < 20; ++k) forecast.add(k, Eigen::Vector2d(k, -3.0));
  EXPECT_EQ(forecast.predict(), Eigen::Vector2d(19.0, -3.0).replicate(1, kHorizon));
}

TEST(DisturbanceForecast, SamplesThatWereMissedAreTakenToBeLikeTheNext) {
  DisturbanceForecast forecast(1, kHorizon, kPeriod, 0.0);
  forecast.add(0, one(1.0));
  forecast.add(3, one(5.0));  // 1 and 2 never came
  for (std::uint32_t k = 4; k <= kPeriod; ++k) forecast.add(k, one(0.0));
  EXPECT_EQ(forecast.predict(), (Matrix(1, kHorizon) << 0.0, 5.0, 5.0, 5.0).finished());
}

TEST(DisturbanceForecast, AGapLongerThanThePeriodLeavesTheNewestOnly) {
  DisturbanceForecast forecast(1, kHorizon, kPeriod, 0.5);
  for (std::uint32_t k = 0; k <= kPeriod; ++k) forecast.add(k, one(daily(static_cast<int>(k))));
  forecast.add(1000, one(7.0));
  EXPECT_EQ(forecast.predict(), Matrix::Constant(1, kHorizon, 7.0));
}

TEST(DisturbanceForecast, ARunThatStartsAgainForgets) {
  DisturbanceForecast forecast(1, kHorizon, kPeriod, 0.5);
  for (std::uint32_t k = 0; k <= kPeriod; ++k) forecast.add(k, one(daily(static_cast<int>(k))));
  forecast.add(0, one(2.0));
  EXPECT_EQ(forecast.predict(), Matrix::Constant(1, kHorizon, 2.0));
}

TEST(DisturbanceForecast, RefusesPeriodsShorterThanTheHorizonAndOddPoles) {
  EXPECT_THROW(DisturbanceForecast(1, 4, 3, 0.5), InputError);
  EXPECT_THROW(DisturbanceForecast(1, 4, -1, 0.5), InputError);
  EXPECT_THROW(DisturbanceForecast(1, 4, 6, 1.01), InputError);
  EXPECT_THROW(DisturbanceForecast(1, 4, 6, std::nan("")), InputError);
  EXPECT_NO_THROW(DisturbanceForecast(1, 4, 4, 1.0));
}

TEST(DisturbanceForecast, WhatRepeatsItselfIsBelievedWholly) {
  DisturbanceForecast forecast(1, kHorizon, kPeriod, 0.5, 2 * kPeriod);
  for (int k = 0; k <= 10 * kPeriod; ++k)
    forecast.add(static_cast<std::uint32_t>(k), one(daily(k)));
  EXPECT_NEAR(forecast.weight()[0], 1.0, 1e-9);
  EXPECT_NEAR(forecast.predict()(0, 2), daily(10 * kPeriod + 2), 1e-9);
}

TEST(DisturbanceForecast, AnEventThatDoesNotComeAgainIsNotBelieved) {
  DisturbanceForecast forecast(1, kHorizon, kPeriod, 0.9, 2 * kPeriod);
  const int event = 5 * kPeriod;
  for (int k = 0; k < 5 * kPeriod; ++k) forecast.add(static_cast<std::uint32_t>(k), one(1.0));
  EXPECT_EQ(forecast.weight()[0], 1.0);  // nothing to judge by
  for (int k = event; k < event + kPeriod + 2; ++k)
    forecast.add(static_cast<std::uint32_t>(k), one(k == event || k == event + 1 ? 50.0 : 1.0));
  EXPECT_LT(forecast.weight()[0], 0.6);
  forecast.add(static_cast<std::uint32_t>(event + kPeriod + 2), one(1.0));
  forecast.add(static_cast<std::uint32_t>(event + kPeriod + 3), one(1.0));
  EXPECT_LT(forecast.weight()[0], 0.3);
}

}  // namespace control_fmbpc_disturbance_forecast_test
}  // namespace fpc
