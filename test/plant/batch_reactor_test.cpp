// The batch reactor against what is known on paper: mixing, balances, and the exact solution of its
// equations, which are linear while the valves stand still.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "analysis/steady_state.hpp"
#include "fmbpc/plant/plant.hpp"
#include "plant/integrator.hpp"

namespace fpc {
namespace plant_batch_reactor_test {

class BatchReactor : public ::testing::Test {
 protected:
  Vector rates(double T, double Tw, double kM, double kC, double kH) const {
    Vector dxdt(2);
    plant->derivatives(Eigen::Vector2d(T, Tw), Eigen::Vector3d(kM, kC, kH), d, dxdt);
    return dxdt;
  }
  const Eigen::Vector3d d{12.0, 75.0, 20.0};
  std::unique_ptr<Plant> plant = makePlant("batch_reactor");
};

TEST_F(BatchReactor, ItsRatesAreThoseThatAgreeWithThePublishedModels) {
  EXPECT_NEAR(rates(0.0, 1.0, 0.0, 0.0, 1.0)[0], 3.305e-4, 1e-11);
  EXPECT_NEAR(rates(20.0, 20.0, 1.0, 0.0, 1.0)[1], 0.0374 * 55.0, 1e-12);
  EXPECT_NEAR(rates(21.0, 20.0, 0.0, 0.0, 1.0)[1], 0.0041, 1e-15);
  EXPECT_NEAR(rates(21.0, 21.0, 0.0, 0.0, 1.0)[1], -0.0012, 1e-15);
}

TEST_F(BatchReactor, TheOnOffValvesDecideWhichWaterEnters) {
  EXPECT_GT(rates(40.0, 40.0, 0.1, 0.0, 1.0)[1], 0.0);
  EXPECT_LT(rates(40.0, 40.0, 0.1, 1.0, 0.0)[1], 0.0);
  const double closed = rates(40.0, 40.0, 0.0, 0.0, 1.0)[1];
  EXPECT_EQ(rates(40.0, 40.0, 0.1, 0.0, 0.0)[1], closed);
  const double both = rates(40.0, 40.0, 0.1, 1.0, 1.0)[1];  // the pump's flow is shared
  EXPECT_NEAR(both - closed, 0.0374 * 0.1 * (43.5 - 40.0), 1e-15);
}

TEST_F(BatchReactor, WithTheMixingValveClosedItCoolsToTheAmbient) {
  const auto f = [&](VectorRef x, VectorRef u, VectorRef w, Eigen::Ref<Vector> dxdt) {
    plant->derivatives(x, u, w, dxdt);
  };
  const auto rest = findSteadyState(f, Eigen::Vector2d(60.0, 65.0), Eigen::Vector3d(0, 0, 1), d);
  ASSERT_TRUE(rest.ok());
  EXPECT_NEAR(rest.x[0], 20.0, 1e-9);
  EXPECT_NEAR(rest.x[1], 20.0, 1e-9);
}

// Symbols: x = [T Tw] - rest, dx/dt = M x, whose exponential has a closed form for 2 x 2.
TEST_F(BatchReactor, TheIntegratorFollowsTheExactSolution) {
  const double inflow = 0.0374 * 0.1, a = 0.0041, b = 0.0012, c = 3.305e-4;
  const double rest = (inflow * 75.0 + b * 20.0) / (inflow + b);
  Eigen::Matrix2d M;
  M << -c, c, a, -(inflow + a + b);
  const double mean = 0.5 * M.trace();
  const double root = std::sqrt(mean * mean - M.determinant());
  const double t = 3600.0;
  const Eigen::Matrix2d exponential =
      std::exp(mean * t) * (std::cosh(root * t) * Eigen::Matrix2d::Identity() +
                            std::sinh(root * t) / root * (M - mean * Eigen::Matrix2d::Identity()));
  const Eigen::Vector2d start(20.0, 30.0);
  const Eigen::Vector2d exact =
      exponential * (start - Eigen::Vector2d::Constant(rest)) + Eigen::Vector2d::Constant(rest);
  IntegratorParams tight;
  tight.relative_tolerance = tight.absolute_tolerance = 1e-11;
  Integrator cvode(*plant, tight);
  Vector x = start;
  for (int k = 0; k < 360; ++k)
    ASSERT_TRUE(cvode.advance(x, Eigen::Vector3d(0.1, 0.0, 1.0), d, 10.0).ok());
  EXPECT_LT((x - exact).cwiseAbs().maxCoeff(), 1e-5);
}

// Heat that enters and leaves is what the two masses store.
TEST_F(BatchReactor, TheHeatBalanceCloses) {
  const Vector r = rates(35.0, 52.0, 0.05, 0.0, 1.0);
  const double stored = 5.21028744e6 * r[0] + 420000.0 * r[1];
  const double entering = 3.74 * 4200.0 * 0.05 * (75.0 - 52.0) + 504.0 * (20.0 - 52.0);
  EXPECT_NEAR(stored, entering, 1e-6);
}

}  // namespace plant_batch_reactor_test
}  // namespace fpc
