// Figures of the plant of vallejo2021thesis, article 1, appendix D, as an independent numerical
// reference gives them with the corrections listed in src/plant/activated_sludge.cpp.
#include <gtest/gtest.h>

#include <array>

#include "analysis/steady_state.hpp"
#include "fmbpc/plant/plant.hpp"
#include "plant/integrator.hpp"

namespace fpc {
namespace plant_activated_sludge_test {

enum State { kS, kX, kC, kXd, kXb, kXr };

class ActivatedSludge : public ::testing::Test {
 protected:
  Vector start() const {
    Vector x(6);
    x << 200.0, 2000.0, 2.0, 80.0, 600.0, 6000.0;
    return x;
  }
  Vector rates(const Vector& x, double q_r, double q_i, double s_i) const {
    Vector dxdt(6);
    plant->derivatives(x, Vector::Constant(1, q_r), Eigen::Vector2d(q_i, s_i), dxdt);
    return dxdt;
  }
  SteadyState rest(double q_r, double q_i, double s_i) const {
    const auto f = [this](VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) {
      plant->derivatives(x, u, d, dxdt);
    };
    return findSteadyState(f, start(), Vector::Constant(1, q_r), Eigen::Vector2d(q_i, s_i));
  }
  std::unique_ptr<Plant> plant = makePlant("activated_sludge");
};

TEST_F(ActivatedSludge, NominalSteadyState) {
  const SteadyState nominal = rest(570.0, 1300.0, 366.67);
  ASSERT_TRUE(nominal.ok());
  EXPECT_NEAR(nominal.x[kX], 2000.0, 0.01);
  EXPECT_NEAR(nominal.x[kXr], 6000.0, 0.01);
  EXPECT_NEAR(nominal.x[kS], 55.009, 0.001);
  EXPECT_NEAR(nominal.x[kXd], 79.996, 0.001);
  EXPECT_NEAR(nominal.x[kXb], 599.984, 0.001);
  EXPECT_NEAR(nominal.x[kC], 2.0, 0.001);
}

TEST_F(ActivatedSludge, BiomassHasAHumpOverTheRecirculation) {
  const std::array<double, 9> q_r{200, 400, 570, 800, 1000, 1300, 1600, 2000, 2200};
  const std::array<double, 9> x{1212, 1784, 2000, 2110, 2128, 2106, 2064, 2007, 1980};
  for (std::size_t i = 0; i < q_r.size(); ++i) {
    const SteadyState held = rest(q_r[i], 1300.0, 366.67);
    ASSERT_TRUE(held.ok()) << "q_r " << q_r[i];
    EXPECT_NEAR(held.x[kX], x[i], 0.5) << "q_r " << q_r[i];
  }
}

TEST_F(ActivatedSludge, GainsOfTheRecirculationAtTheNominalPoint) {
  const Vector up = rest(571.0, 1300.0, 366.67).x, down = rest(569.0, 1300.0, 366.67).x;
  EXPECT_NEAR((up[kX] - down[kX]) / 2.0, 0.83, 0.005);
  EXPECT_NEAR((up[kS] - down[kS]) / 2.0, -0.0215, 0.0001);
}

TEST_F(ActivatedSludge, AtNominalLoadBiomassCannotBeHeldAt2200ButAtHigherLoadItCan) {
  double nominal_load = 0.0, higher_load = 0.0;
  for (double q_r = 200.0; q_r <= 2200.0; q_r += 50.0) {
    nominal_load = std::max(nominal_load, rest(q_r, 1300.0, 366.67).x[kX]);
    higher_load = std::max(higher_load, rest(q_r, 1300.0, 430.0).x[kX]);
  }
  EXPECT_LT(nominal_load, 2130.0);
  EXPECT_NEAR(higher_load, 2295.0, 1.0);
}

TEST_F(ActivatedSludge, TheIntegratorComesToRestWhereNewtonDoes) {
  Integrator cvode(*plant, {});
  Vector x = start();
  const Vector u = Vector::Constant(1, 570.0);
  const Vector d = Eigen::Vector2d(1300.0, 366.67);
  for (int k = 0; k < 200; ++k) ASSERT_TRUE(cvode.advance(x, u, d, 36000.0).ok());
  EXPECT_LT((x - rest(570.0, 1300.0, 366.67).x).cwiseAbs().maxCoeff(), 1e-3);
}

// With the settler closed (no flows) only settling moves biomass, and none is lost.
TEST_F(ActivatedSludge, SettlingConservesBiomass) {
  const Vector r = rates(start(), 0.0, 0.0, 0.0);
  EXPECT_NEAR(2.0 * r[kXd] + 1.5 * r[kXb] + 1.0 * r[kXr], 0.0, 1e-9);
}

// Whatever the flows, what leaves the settler is what enters it: q x = q_out x_d + q_2 x_r at rest.
TEST_F(ActivatedSludge, TheSettlerBalanceClosesAtRest) {
  const Vector x = rest(900.0, 1500.0, 400.0).x;
  const double q_p = 36.48730242;
  EXPECT_NEAR(2400.0 * x[kX] / ((1500.0 - q_p) * x[kXd] + (900.0 + q_p) * x[kXr]), 1.0, 1e-9);
}

TEST_F(ActivatedSludge, NoSubstrateIsNoDivisionByZero) {
  Vector x = start();
  x[kS] = 0.0;
  const Vector r = rates(x, 570.0, 1300.0, 366.67);
  EXPECT_TRUE(r.allFinite());
  EXPECT_GT(r[kS], 0.0);
}

TEST_F(ActivatedSludge, ThePurgeNeverExceedsTheInflow) {
  Vector x = start();
  x[kXb] = x[kXd];  // then mixing with the layer below cannot change x_d, settling aside
  const Vector none = rates(x, 0.0, 0.0, 0.0), little = rates(x, 0.0, 20.0, 0.0);
  EXPECT_DOUBLE_EQ(none[kXd], little[kXd]);
  x[kXb] = 600.0;
  EXPECT_DOUBLE_EQ(rates(x, 0.0, 0.0, 0.0)[kXd], rates(x, 0.0, 20.0, 0.0)[kXd]);
}

TEST_F(ActivatedSludge, OxygenFeedsBackIntoNothing) {
  Vector x = start();
  const Vector before = rates(x, 570.0, 1300.0, 366.67);
  x[kC] = 7.0;
  const Vector after = rates(x, 570.0, 1300.0, 366.67);
  EXPECT_NE(before[kC], after[kC]);
  for (const int i : {kS, kX, kXd, kXb, kXr}) EXPECT_EQ(before[i], after[i]);
}

TEST_F(ActivatedSludge, ParametersReachTheEquations) {
  const Vector before = rates(start(), 570.0, 1300.0, 366.67);
  for (const auto& parameter : plant->description().parameters) {
    const double other = parameter.nominal * 0.9;
    const auto changed = makePlant("activated_sludge", {{parameter.name, other}});
    Vector after(6);
    changed->derivatives(start(), Vector::Constant(1, 570.0), Eigen::Vector2d(1300.0, 366.67),
                         after);
    EXPECT_NE(before, after) << parameter.name;
  }
}

}  // namespace plant_activated_sludge_test
}  // namespace fpc
