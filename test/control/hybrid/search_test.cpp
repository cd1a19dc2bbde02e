// The search of the batch reactor's controller against enumeration of the full tree on the states
// that the system's figures are stated for.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "control/hybrid/fixture.hpp"

namespace fpc {
namespace control_hybrid_search_test {

struct Best {
  double cost{kInfinity};
  int first{-1};
};

void enumerate(TreeProblem& problem, int levels, int level, int before, int first, double cost,
               const Vector& state, Best& best) {
  for (int choice = 0; choice < 7; ++choice) {
    Vector next = state;
    const double total = cost + problem.advance(level, before, choice, next);
    const int root = level == 0 ? choice : first;
    if (level + 1 < levels)
      enumerate(problem, levels, level + 1, choice, root, total, next, best);
    else if (total < best.cost)
      best = {total, root};
  }
}

struct Case {
  Eigen::Vector2d outputs;
  Vector input;
  double reference;
};

/// T 15..66, Tw 13..73, any previous input; reference within 2 degC of T, or one of the recipe's.
Case draw(std::mt19937_64& generator, int trial) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Case c;
  c.outputs = {15.0 + 51.0 * unit(generator), 13.0 + 60.0 * unit(generator)};
  c.input = test::batchReactorInputs().col(static_cast<Eigen::Index>(generator() % 7));
  const double recipe[] = {62.0, 26.0, 35.0};
  c.reference =
      trial % 2 == 0 ? c.outputs[0] - 2.0 + 4.0 * unit(generator) : recipe[generator() % 3];
  return c;
}

class HybridSearch : public ::testing::TestWithParam<int> {};

TEST_P(HybridSearch, EqualsEnumerationOnAThousandStatesWithFewNodes) {
  constexpr unsigned kSeed = 20070;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 generator(kSeed);
  const auto by_cost =
      test::batchReactorMpc(test::batchReactorParams(GetParam(), BranchBound::kCost));
  const auto by_reach =
      test::batchReactorMpc(test::batchReactorParams(GetParam(), BranchBound::kReach));
  ASSERT_TRUE(by_reach->boundsByReach());
  double nodes_cost = 0.0, nodes_reach = 0.0;
  for (int trial = 0; trial < 1000; ++trial) {
    const Case c = draw(generator, trial);
    const Matrix reference = (Eigen::Vector2d(c.reference, 0.0)).replicate(1, 60);
    const TreeResult a = by_cost->decide(c.outputs, c.input, Vector(0), reference);
    Best best;
    enumerate(by_cost->problem(), 4, 0, -1, -1, 0.0, c.outputs, best);
    const TreeResult b = by_reach->decide(c.outputs, c.input, Vector(0), reference);
    for (const TreeResult* result : {&a, &b}) {
      ASSERT_NEAR(result->cost, best.cost, 1e-9 * (1.0 + best.cost)) << "trial " << trial;
      ASSERT_EQ(result->choices.front(), best.first) << "trial " << trial;
    }
    nodes_cost += static_cast<double>(a.nodes) / 1000.0;
    nodes_reach += static_cast<double>(b.nodes) / 1000.0;
  }
  RecordProperty("nodes_cost", std::to_string(nodes_cost));
  RecordProperty("nodes_reach", std::to_string(nodes_reach));
  EXPECT_LE(nodes_cost, GetParam() == 44 ? 950.0 : 1200.0);
  EXPECT_LT(nodes_reach, 0.5 * nodes_cost);
  std::printf("eq. %d: mean nodes of 2800: %.0f by cost, %.0f by reach\n", GetParam(), nodes_cost,
              nodes_reach);
}

INSTANTIATE_TEST_SUITE_P(Costs, HybridSearch, ::testing::Values(44, 45));

}  // namespace control_hybrid_search_test
}  // namespace fpc
