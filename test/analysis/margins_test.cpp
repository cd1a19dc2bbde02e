// Margins against loops whose margins are known on paper.
#include "analysis/margins.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace fpc {
namespace analysis_margins_test {

constexpr double kTurn = 2.0 * 3.14159265358979323846;

/// A pulse into u = -C y, y(k+1) = a y(k) + b u(k - delay), C = kp + ki / (z - 1) ... of one input.
Matrix pulse(double a, double b, int delay, double kp, double ki, int samples) {
  Matrix reached(1, samples);
  std::vector<double> past(static_cast<std::size_t>(delay) + 1, 0.0);
  double y = 0.0, integral = 0.0;
  for (int k = 0; k < samples; ++k) {
    integral += ki * y;
    const double u = -(kp * y + integral) + (k == 0 ? 1.0 : 0.0);
    reached(0, k) = u;
    past.insert(past.begin(), u);
    past.pop_back();
    y = a * y + b * past.back();
  }
  return reached;
}

/// L(z) of the same loop.
std::complex<double> loop(double a, double b, int delay, double kp, double ki, double turn) {
  const std::complex<double> z = std::polar(1.0, turn);
  const std::complex<double> plant = b * std::pow(z, -delay) / (z - a);
  return plant * (kp + ki * z / (z - 1.0));
}

/// First-order plant, proportional control: unstable when b k (of z - a + b k) passes 1 + a.
TEST(Margins, OfAProportionalLoopAreThoseOfItsPole) {
  const double a = 0.8, b = 0.2, kp = 2.0;
  const PulseResponse response({pulse(a, b, 0, kp, 0.0, 400)}, 10.0);
  EXPECT_TRUE(response.hasDecayed());
  const LoopMargins m = response.margins(0);
  EXPECT_NEAR(m.gain_upper, (1.0 + a) / (b * kp), 1e-9);
  EXPECT_EQ(m.gain_lower, 0.0);
  EXPECT_NEAR(response.growth(), a - b * kp, 1e-6);
}

/// |L| = 1 and L real, solved on the formula of L by themselves.
TEST(Margins, OfAPiLoopWithDelayAreThoseOfItsFormula) {
  const double a = 0.95, b = 0.05, kp = 1.5, ki = 0.06, sample = 6.0;
  const int delay = 5;
  const PulseResponse response({pulse(a, b, delay, kp, ki, 3000)}, sample);
  ASSERT_TRUE(response.hasDecayed());
  const auto L = [&](double turn) { return loop(a, b, delay, kp, ki, turn); };
  const auto root = [](double low, double high, const std::function<double(double)>& f) {
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high);
      ((f(middle) > 0.0) == (f(low) > 0.0) ? low : high) = middle;
    }
    return low;
  };
  const double at_one = root(1e-3, 1.0, [&](double w) { return std::abs(L(w)) - 1.0; });
  const double at_real = root(at_one, 0.6, [&](double w) { return L(w).imag(); });
  ASSERT_LT(L(at_real).real(), 0.0);
  const double phase = std::arg(-L(at_one));
  const LoopMargins m = response.margins(0);
  EXPECT_NEAR(m.gain_upper, -1.0 / L(at_real).real(), 1e-6);
  EXPECT_NEAR(m.phase_deg, phase * 360.0 / kTurn, 1e-4);
  EXPECT_NEAR(m.delay_s, phase / at_one * sample, 1e-3);
  EXPECT_NEAR(m.crossover_rad_s, at_one / sample, 1e-8);
  double peak = 0.0;
  for (double w = 1e-3; w < 3.14; w += 1e-4) peak = std::max(peak, 1.0 / std::abs(1.0 + L(w)));
  EXPECT_NEAR(response.peak(), peak, 2e-3 * peak);
}

/// So many further samples of delay as the margin says leave it stable, one more does not.
TEST(Margins, TheDelayMarginIsWhereTheLoopIsLost) {
  const double a = 0.95, b = 0.05, kp = 1.5, ki = 0.06;
  const double samples = PulseResponse({pulse(a, b, 5, kp, ki, 3000)}, 1.0).margins(0).delay_s;
  const auto more = static_cast<int>(std::floor(samples));
  EXPECT_LT(PulseResponse({pulse(a, b, 5 + more, kp, ki, 3000)}, 1.0).growth(), 1.0);
  EXPECT_GT(PulseResponse({pulse(a, b, 6 + more, kp, ki, 3000)}, 1.0).growth(), 1.0);
}

/// An unstable plant: the gain may neither grow nor shrink beyond z - a + b k inside the circle.
TEST(Margins, AnUnstablePlantHasALeastGain) {
  const double a = 1.1, b = 1.0, kp = 0.6;
  const PulseResponse response({pulse(a, b, 0, kp, 0.0, 300)}, 1.0);
  const LoopMargins m = response.margins(0);
  EXPECT_NEAR(m.gain_lower, (a - 1.0) / (b * kp), 1e-3);
  EXPECT_NEAR(m.gain_upper, (a + 1.0) / (b * kp), 1e-6);
}

TEST(Margins, ALoopThatGrowsSaysSo) {
  const PulseResponse response({pulse(0.8, 0.2, 0, 12.0, 0.0, 300)}, 1.0);
  EXPECT_FALSE(response.hasDecayed());
  EXPECT_NEAR(response.growth(), std::abs(0.8 - 0.2 * 12.0), 1e-6);
}

TEST(Margins, WithoutFeedbackThereIsNoLimit) {
  const PulseResponse response({pulse(0.8, 0.2, 0, 0.0, 0.0, 100)}, 1.0);
  EXPECT_TRUE(std::isinf(response.margins(0).gain_upper));
  EXPECT_TRUE(std::isinf(response.margins(0).delay_s));
  EXPECT_EQ(response.margins(0).phase_deg, 180.0);
  EXPECT_NEAR(response.peak(), 1.0, 1e-12);
}

}  // namespace analysis_margins_test
}  // namespace fpc
