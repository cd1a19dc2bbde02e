// Branch and bound against enumeration on random trees, ties, dead ends and budgets included.
#include "optim/tree_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace optim_tree_search_test {

/// x(k+1) = a x + b(choice), cost (x - target(level))^2 + a charge for some pairs of choices.
struct RandomTree final : TreeProblem {
  RandomTree(std::mt19937_64& generator, int n, int n_levels, bool ties, bool forbidden)
      : choices(n), levels(n_levels) {
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const auto draw = [&] { return ties ? std::round(2.0 * unit(generator)) : unit(generator); };
    b = Vector(n).unaryExpr([&](double) { return draw(); });
    target = Vector(n_levels).unaryExpr([&](double) { return 2.0 * draw(); });
    charge = Matrix(n + 1, n).unaryExpr([&](double) { return std::max(draw(), 0.0); });
    if (forbidden)
      for (double& c : flat(charge))
        if (unit(generator) > 0.3) c = kInfinity;
  }
  double advance(int level, int before, int choice, Eigen::Ref<Vector> state) override {
    state[0] = 0.5 * state[0] + b[choice];
    const double error = state[0] - target[level];
    return charge(before + 1, choice) + error * error;
  }
  double leastCostToGo(int level, Eigen::Ref<Vector> state, double) override {
    double least = 0.0, low = state[0], high = low;
    for (int k = level; k < levels; ++k) {
      low = 0.5 * low + b.minCoeff();
      high = 0.5 * high + b.maxCoeff();
      const double error = std::max({0.0, target[k] - high, low - target[k]});
      least += error * error;
    }
    return least;
  }
  void enumerate(int level, int before, double cost, const Vector& state, std::vector<int>& path) {
    for (int choice = 0; choice < choices; ++choice) {
      Vector next = state;
      const double total = cost + advance(level, before, choice, next);
      path[static_cast<std::size_t>(level)] = choice;
      if (level + 1 < levels) {
        enumerate(level + 1, choice, total, next, path);
      } else if (total < best) {
        best = total;
        best_path = path;
      }
    }
  }
  int choices, levels;
  Vector b, target;
  Matrix charge;
  double best{kInfinity};
  std::vector<int> best_path;
};

class TreeSearchKinds : public ::testing::TestWithParam<std::tuple<bool, bool, bool>> {};

TEST_P(TreeSearchKinds, EqualsEnumerationBitForBit) {
  const auto [bound, ties, forbidden] = GetParam();
  constexpr unsigned kSeed = 31;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 generator(kSeed);
  int impossible = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const int n = 1 + static_cast<int>(generator() % 5),
              levels = 1 + static_cast<int>(generator() % 5);
    RandomTree tree(generator, n, levels, ties, forbidden);
    const Vector start = Vector::Constant(1, 0.25);
    std::vector<int> path(static_cast<std::size_t>(levels));
    tree.enumerate(0, -1, 0.0, start, path);
    TreeSearch search(1, n, {levels, bound, 0});
    const TreeResult& result = search.search(tree, start);
    ASSERT_EQ(result.usable(), tree.best < kInfinity) << "trial " << trial;
    impossible += !result.usable();
    if (!result.usable()) continue;
    EXPECT_EQ(result.status, TreeStatus::kOptimal);
    EXPECT_EQ(result.cost, tree.best) << "trial " << trial;
    EXPECT_EQ(result.choices, tree.best_path) << "trial " << trial;
    EXPECT_LE(static_cast<double>(result.nodes), TreeSearch::fullTree(n, levels));
  }
  EXPECT_EQ(impossible > 0, forbidden);
}

INSTANTIATE_TEST_SUITE_P(All, TreeSearchKinds,
                         ::testing::Combine(::testing::Bool(), ::testing::Bool(),
                                            ::testing::Bool()));

TEST(TreeSearch, TheFullTreeIsCountedWithoutItsRoot) {
  EXPECT_EQ(TreeSearch::fullTree(7, 4), 2800.0);
  EXPECT_EQ(TreeSearch::fullTree(3, 1), 3.0);
}

TEST(TreeSearch, ABudgetGivesTheBestSequenceSoFarAndSaysSo) {
  std::mt19937_64 generator(7);
  for (int trial = 0; trial < 50; ++trial) {
    RandomTree tree(generator, 4, 5, false, false);
    const Vector start = Vector::Zero(1);
    const TreeResult best = TreeSearch(1, 4, {5, false, 0}).search(tree, start);
    double before = kInfinity;
    for (const std::uint64_t budget : {20U, 40U, 80U, 160U, 2000U}) {
      const TreeResult cut = TreeSearch(1, 4, {5, false, budget}).search(tree, start);
      ASSERT_TRUE(cut.usable());
      EXPECT_LE(cut.nodes, budget);
      EXPECT_LE(cut.cost, before);
      EXPECT_EQ(cut.status == TreeStatus::kOptimal, cut.nodes == best.nodes);
      before = cut.cost;
    }
    EXPECT_EQ(before, best.cost);
  }
}

TEST(TreeSearch, StatesThatAreNotFiniteAreDeadEnds) {
  struct Exploding final : TreeProblem {
    double advance(int, int, int choice, Eigen::Ref<Vector> state) override {
      if (choice == 0) state[0] = std::nan("");
      return state[0] * state[0] + 1.0;
    }
  } tree;
  TreeSearch search(1, 2, {3, false, 0});
  const TreeResult& result = search.search(tree, Vector::Zero(1));
  ASSERT_TRUE(result.usable());
  EXPECT_EQ(result.choices, (std::vector<int>{1, 1, 1}));
}

TEST(TreeSearch, EachParameterIsChecked) {
  EXPECT_THROW(TreeSearch(0, 2, {}), InputError);
  EXPECT_THROW(TreeSearch(1, 0, {}), InputError);
  EXPECT_THROW(TreeSearch(1, 2, {0, false, 0}), InputError);
  EXPECT_THROW(TreeSearch(1, 2, {4, false, 7}), InputError);
  EXPECT_NO_THROW(TreeSearch(1, 2, {4, false, 8}));
}

}  // namespace optim_tree_search_test
}  // namespace fpc
