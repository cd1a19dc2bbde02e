#include "control/targets/target_solver.hpp"

#include <gtest/gtest.h>

#include "control/targets/target_reference.hpp"
#include "random/dice.hpp"

namespace fpc {
namespace {

using Eigen::Index;

/// A number of the problem: whole ones meet in corners and tie, others do not.
double entry(Dice& dice, bool whole, int most) {
  return whole ? dice.whole(-most, most) : dice.between(-most, most);
}

TargetProblem randomProblem(Dice& dice) {
  const bool whole = dice.chance(0.5);
  const Index n = dice.chance(0.1) ? 3 : dice.whole(1, 2), m = dice.whole(0, 4);
  TargetProblem p(n, m);
  for (Index i = 0; i < n; ++i) {
    p.lower[i] = entry(dice, whole, 3);
    p.upper[i] = p.lower[i] + std::abs(entry(dice, whole, 4));
    p.rest[i] = entry(dice, whole, 4);
    p.unit[i] = dice.chance(0.3) ? 2.0 : 1.0;
    if (dice.chance(0.7)) p.price[i] = entry(dice, whole, 2);
  }
  for (Index i = 0; i < m; ++i) {
    for (Index j = 0; j < n; ++j) p.rows(i, j) = entry(dice, whole, 2);
    if (i > 0 && dice.chance(0.15)) p.rows.row(i) = p.rows.row(i - 1);  // the same output twice
    const double width = dice.chance(0.3) ? 0.0 : std::abs(entry(dice, whole, 3));
    const double middle = entry(dice, whole, 5);
    if (dice.chance(0.8)) p.row_lower[i] = middle;
    if (dice.chance(0.8)) p.row_upper[i] = middle + width;
    p.row_unit[i] = dice.chance(0.3) ? 0.5 : 1.0;
    p.rank[static_cast<std::size_t>(i)] = dice.whole(1, 3);
  }
  if (dice.chance(0.3)) p.band = dice.between(0.0, 1.0);
  return p;
}

TEST(TargetSolver, EqualsBruteForceOnTenThousandRandomCases) {
  int gave_up = 0, priced = 0, tied = 0;
  for (int seed = 0; seed < 10000; ++seed) {
    Dice dice(static_cast<std::uint64_t>(seed));
    const TargetProblem p = randomProblem(dice);
    TargetSolver solver(p.price.size(), p.rank);
    const TargetSolution& found = solver.solve(p);
    ASSERT_TRUE(found.usable()) << seed;
    const TargetReference reference = bruteForce(p);
    for (Index i = 0; i < found.given_up.size(); ++i)
      ASSERT_NEAR(found.given_up[i], reference.given_up[i], 1e-6) << seed << " row " << i;
    ASSERT_NEAR(found.least_cost, p.price.any() ? reference.least_cost : 0.0, 1e-6) << seed;
    ASSERT_LE((found.v - reference.v).cwiseAbs().maxCoeff(), 1e-6)
        << seed << ": " << found.v.transpose() << ", not " << reference.v.transpose();
    gave_up += found.given_up.any();
    priced += p.price.any();
    tied += (found.given_up.array() != 0.0).count() > 1;
  }
  EXPECT_GT(gave_up, 2000);
  EXPECT_GT(priced, 5000);
  EXPECT_GT(tied, 500);
}

}  // namespace
}  // namespace fpc
