// The linear example of taieb2017 against its printed difference equation.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/plant/plant.hpp"

namespace fpc {
namespace plant_linear_2x2_test {

TEST(Linear2x2, MovesByThePrintedDifferenceEquation) {
  const auto plant = makePlant("linear_2x2");
  const auto stepper = plant->makeStepper(1.0);
  ASSERT_NE(stepper, nullptr);
  const auto& about = plant->description();
  Vector x = Vector::Zero(static_cast<Eigen::Index>(about.states.size()));
  Vector d(static_cast<Eigen::Index>(about.disturbances.size()));
  for (Eigen::Index i = 0; i < d.size(); ++i)
    d[i] = about.disturbances[static_cast<std::size_t>(i)].nominal;
  stepper->reset(Vector::Zero(2), d);
  double x11 = 0.0, x12 = 0.0, x21 = 0.0, x22 = 0.0;
  for (int k = 0; k < 300; ++k) {
    const Eigen::Vector2d u(std::sin(0.7 * k) + 1.0, std::cos(1.3 * k));
    x11 = 0.9401 * x11 + u[0];
    x12 = 0.9524 * x12 + u[1];
    x21 = 0.9083 * x21 + u[0];
    x22 = 0.9306 * x22 + u[1];
    stepper->advance(x, u, d);
    ASSERT_NEAR(x[0], -0.7664 * x11 + 0.9 * x12, 1e-11) << "sample " << k;
    ASSERT_NEAR(x[1], -0.6055 * x21 + 1.3472 * x22, 1e-11) << "sample " << k;
  }
}

TEST(Linear2x2, TheOutputsOfThePaperNeedNearlyOneOfEachInput) {
  const auto plant = makePlant("linear_2x2");
  const auto gain = [&](std::size_t i) { return plant->description().disturbances[i].nominal; };
  Eigen::Matrix2d K;
  K << gain(0), gain(1), gain(2), gain(3);
  const Eigen::Vector2d u = K.lu().solve(Eigen::Vector2d(6.1, 12.8));
  EXPECT_NEAR(u[0], 1.0006, 5e-5);
  EXPECT_NEAR(u[1], 0.99975, 5e-6);
}

TEST(Linear2x2, HasNoParameters) {
  EXPECT_THROW(makePlant("linear_2x2", {{"pole", 0.5}}), InputError);
}

}  // namespace plant_linear_2x2_test
}  // namespace fpc
