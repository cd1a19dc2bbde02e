// The reactor with two inputs of taieb2017: steady inputs, signs, relation to cstr.
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/steady_state.hpp"
#include "plant/integrator.hpp"
#include "plant/simulation_fixture.hpp"

namespace fpc {
namespace plant_mimo_cstr_test {

using Eigen::Vector2d;

const Vector kFeed = Eigen::Vector3d(1.0, 350.0, 350.0);

Vector rates(const Vector& x, const Vector& u, const Vector& d = kFeed,
             const PlantParameters& parameters = {}) {
  Vector dxdt(2);
  makePlant("mimo_cstr", parameters)->derivatives(x, u, d, dxdt);
  return dxdt;
}

/// Inputs at rest at x, from the two balances on paper; qc by bisection of the cooling that is
/// left.
Vector2d steadyInputs(double Ca, double T) {
  const double reaction = 7.2e10 * Ca * std::exp(-1e4 / T);
  const double q = 100.0 * reaction / (1.0 - Ca);
  const double cooling = (200.0 * reaction - q / 100.0 * (T - 350.0)) / (T - 350.0);
  double lower = 1e-6, upper = 1e4;
  for (int i = 0; i < 200; ++i) {
    const double qc = 0.5 * (lower + upper);
    (0.01 * qc * (1.0 - std::exp(-700.0 / qc)) > cooling ? upper : lower) = qc;
  }
  return {q, lower};
}

TEST(MimoCstr, RestsAtTheInputsOfItsBalances) {
  const double pairs[][2] = {{0.1, 441.0}, {0.05, 450.0}, {0.15, 430.0}, {0.25, 416.0}};
  for (const auto& [Ca, T] : pairs) {
    const Vector2d u = steadyInputs(Ca, T);
    EXPECT_TRUE(u[0] > 50.0 && u[0] < 150.0 && u[1] > 50.0 && u[1] < 200.0) << u.transpose();
    EXPECT_LT(rates(Vector2d(Ca, T), u).norm(), 1e-9) << Ca << " " << T;
  }
}

TEST(MimoCstr, ThePairsOfThePaperNeedFlowsFromHalfALitreToTwoThousand) {
  const double pairs[][4] = {{0.1, 480.0, 717.0, 307.0},
                             {0.05, 365.0, 0.48, 5.6},
                             {0.15, 495.0, 2140.0, 481.0},
                             {0.25, 465.0, 1098.0, 407.0}};
  for (const auto& [Ca, T, q, qc] : pairs) {
    const Vector2d u = steadyInputs(Ca, T);
    EXPECT_NEAR(u[0], q, 0.005 * q);
    EXPECT_NEAR(u[1], qc, 0.005 * qc);
    EXPECT_LT(rates(Vector2d(Ca, T), u).norm(), 1e-8) << Ca << " " << T;
  }
}

TEST(MimoCstr, NominalInputsHoldTheStartOfThePaper) {
  const auto plant = makePlant("mimo_cstr");
  const auto f = [&](VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) {
    plant->derivatives(x, u, d, dxdt);
  };
  const SteadyState rest =
      findSteadyState(f, Vector2d(0.1, 438.5), Vector2d(100.0, 103.4066), kFeed);
  ASSERT_TRUE(rest.ok());
  EXPECT_NEAR(rest.x[0], 0.1, 1e-5);
  EXPECT_NEAR(rest.x[1], 438.54, 0.005);
}

TEST(MimoCstr, TheReactionHeatsAndTheJacketCools) {
  const double reaction = 7.2e10 * 0.5 * std::exp(-1e4 / 400.0);
  const Vector alone = rates(Vector2d(0.5, 400.0), Vector2d(0.0, 0.0));
  EXPECT_NEAR(alone[0], -reaction, 1e-12 * reaction);
  EXPECT_NEAR(alone[1], 200.0 * reaction, 1e-10 * reaction) << "200 K per mol/l, upwards";
  EXPECT_LT(rates(Vector2d(0.0, 400.0), Vector2d(0.0, 100.0))[1], 0.0);
}

// Without the jacket, Ca and T / 200 K add up to what the feed brings, whatever reacts.
TEST(MimoCstr, EnergyOfTheReactionIsConserved) {
  const auto plant = makePlant("mimo_cstr");
  IntegratorParams tight;
  tight.relative_tolerance = tight.absolute_tolerance = 1e-11;
  Integrator cvode(*plant, tight);
  Vector x = Vector2d(0.8, 380.0);
  const double sum = x[0] + x[1] / 200.0, feed = 1.0 + 350.0 / 200.0;
  ASSERT_TRUE(cvode.advance(x, Vector2d(80.0, 0.0), kFeed, 90.0).ok());
  EXPECT_NEAR(x[0] + x[1] / 200.0, feed + (sum - feed) * std::exp(-0.8 * 1.5), 1e-8);
}

TEST(MimoCstr, IsTheSingleInputReactorWhenTheFeedIsLeftAlone) {
  const auto single = makePlant("cstr");
  Vector expected(2);
  for (const double T : {360.0, 420.0, 450.0})
    for (const double Ca : {0.05, 0.3, 0.9}) {
      single->derivatives(Vector2d(Ca, T), one(90.0), Vector2d::Zero(), expected);
      const Vector both = rates(Vector2d(Ca, T), Vector2d(100.0, 90.0));
      EXPECT_LT((both - expected).norm(), 1e-12 * (1.0 + expected.norm())) << Ca << " " << T;
    }
}

TEST(MimoCstr, AHotterOrRicherFeedHeats) {
  const Vector2d x(0.1, 440.0), u(100.0, 100.0);
  const Vector plain = rates(x, u);
  EXPECT_NEAR(rates(x, u, Eigen::Vector3d(1.1, 350.0, 350.0))[0] - plain[0], 0.1, 1e-12);
  EXPECT_NEAR(rates(x, u, Eigen::Vector3d(1.0, 360.0, 350.0))[1] - plain[1], 10.0, 1e-9);
  EXPECT_GT(rates(x, u, Eigen::Vector3d(1.0, 350.0, 360.0))[1], plain[1]);
}

}  // namespace plant_mimo_cstr_test
}  // namespace fpc
