// The plans of the nonlinear controller beside those of an unrelated solver: NLopt's sequential
// quadratic programming (kraft1994) on the same cost and limits.
#include <nlopt.h>

#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "control/mpc/fixture.hpp"

namespace fpc {
namespace control_horizon_nmpc_nlopt_test {

constexpr double kMove = 0.6;

double planCost(unsigned n, const double* x, double* gradient, void* data) {
  PlanCost& cost = *static_cast<PlanCost*>(data);
  Vector plan = Eigen::Map<const Vector>(x, n);
  const double value = cost.cost(plan);
  for (unsigned j = 0; gradient != nullptr && j < n; ++j) {
    const double kept = plan[j];
    plan[j] = kept + 1e-6;
    const double up = cost.cost(plan);
    plan[j] = kept - 1e-6;
    gradient[j] = (up - cost.cost(plan)) / 2e-6;
    plan[j] = kept;
  }
  return value;
}

struct MoveSide {
  unsigned at;
  double sign;
};

double moveSide(unsigned n, const double* x, double* gradient, void* data) {
  const MoveSide& side = *static_cast<const MoveSide*>(data);
  for (unsigned j = 0; gradient != nullptr && j < n; ++j)
    gradient[j] = j == side.at ? side.sign : j + 1 == side.at ? -side.sign : 0.0;
  return side.sign * (x[side.at] - x[side.at - 1]) - kMove;
}

TEST(NmpcBesideNlopt, SlsqpFindsNoBetterPlanAndTheSameInput) {
  int limited = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 generator(seed);
    std::uniform_real_distribution<double> draw(0.0, 1.0);
    const double level = 0.5 + 3.0 * draw(generator), asked = 0.5 + 3.0 * draw(generator);
    const double before = 3.0 * draw(generator);
    const NmpcParams params = test::tankParams(10, 3, 0.02);
    Nmpc law(params, test::tankLimits(kMove), test::tankInfo(), std::make_unique<test::Tank>());
    double sent = 0.0;
    test::runTank(
        law, test::Tank(), level, asked, 1,
        [&](std::uint32_t, double, double, const ControllerOutput& output) {
          sent = output.input[0];
          ASSERT_TRUE(output.ok);
        },
        before);
    test::Tank model;
    PlanCost cost(model, params.horizon);
    cost.start(Vector::Constant(1, level), Vector::Zero(1), Vector(0), Vector::Constant(1, before),
               Matrix::Constant(1, 10, asked));
    const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> opt(
        nlopt_create(NLOPT_LD_SLSQP, 3), &nlopt_destroy);
    const double lower[] = {std::max(0.0, before - kMove), 0.0, 0.0};
    const double upper[] = {std::min(3.0, before + kMove), 3.0, 3.0};
    nlopt_set_min_objective(opt.get(), planCost, &cost);
    nlopt_set_lower_bounds(opt.get(), lower);
    nlopt_set_upper_bounds(opt.get(), upper);
    MoveSide sides[] = {{1, 1.0}, {1, -1.0}, {2, 1.0}, {2, -1.0}};
    for (MoveSide& side : sides) nlopt_add_inequality_constraint(opt.get(), moveSide, &side, 1e-12);
    nlopt_set_xtol_rel(opt.get(), 1e-10);
    nlopt_set_maxeval(opt.get(), 1000);
    double x[] = {before, before, before}, value = 0.0;
    const nlopt_result code = nlopt_optimize(opt.get(), x, &value);
    ASSERT_TRUE(code > 0 || code == NLOPT_ROUNDOFF_LIMITED) << code;
    const double here = cost.cost(law.plan());
    EXPECT_LE(here, value + 1e-8 * (1.0 + value));
    EXPECT_NEAR(sent, x[0], 1e-4);
    limited += sent == lower[0] || sent == upper[0] ? 1 : 0;
  }
  EXPECT_GE(limited, 10);
}

}  // namespace control_horizon_nmpc_nlopt_test
}  // namespace fpc
