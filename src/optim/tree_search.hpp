// Exact search for the cheapest sequence of discrete choices: branch and bound over the tree of
// evolution, whose nodes are the states that sequences of choices reach.
#pragma once

#include <cstdint>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// What a search asks of a process. A level of the tree is one choice, held for as long as it
/// likes.
class TreeProblem {
 public:
  virtual ~TreeProblem() = default;
  /// Cost >= 0 of taking `choice` at `level` (from 0) after `before` (the choice one level up, -1
  /// at level 0), infinite (or NaN) if that is not allowed. Moves `state` on, in place.
  virtual double advance(int level, int before, int choice, Eigen::Ref<Vector> state) = 0;
  /// No more than what the way from `state`, which stands at the beginning of `level`, to the last
  /// level must cost. May stop as soon as it exceeds `enough`. May change `state`.
  virtual double leastCostToGo(int level, Eigen::Ref<Vector> state, double enough);
};

struct TreeSearchParams {
  int levels{4};            ///< H_Z
  bool cost_to_go{false};   ///< bound = cost so far + leastCostToGo; false: cost so far only
  std::uint64_t budget{0};  ///< nodes after which the best sequence so far is taken; 0: none
  void validate(int choices) const;  ///< @throws InputError naming the field
};

enum class TreeStatus {
  kOptimal,
  kBudget,      ///< stopped by the budget: the best sequence found so far
  kImpossible,  ///< no sequence is allowed (or none was found within the budget)
};

struct TreeResult {
  TreeStatus status{TreeStatus::kImpossible};
  double cost{};             ///< of the sequence
  std::vector<int> choices;  ///< one per level; the first one is to be applied
  std::uint64_t nodes{};     ///< states computed, allowed or not
  std::uint64_t bounds{};    ///< calls of leastCostToGo
  bool usable() const { return status != TreeStatus::kImpossible; }
};

/// Depth first, children in order of their bound. A node is left out if its bound exceeds the best
/// cost known, so that the result equals that of enumeration: the lowest cost and, where sequences
/// cost the same to the last bit, the first of them in lexicographic order.
/// Source: karer2007, sections 4.1-4.4; the bound by the cost to go is
/// an addition.
class TreeSearch {
 public:
  /// @throws InputError naming the field.
  TreeSearch(Eigen::Index state_size, int choices, TreeSearchParams params);
  /// No allocation.
  const TreeResult& search(TreeProblem& problem, VectorRef start);
  /// Nodes of the full tree: n + n^2 + ... + n^levels.
  static double fullTree(int choices, int levels);

 private:
  struct Child {
    double cost, bound;
    int choice;
  };
  struct Level {
    Matrix states;  // n_x n_choices, those of the children
    std::vector<Child> children;
  };

  void explore(int level, int before, double cost, VectorRef state);
  void expand(int level, int before, double cost, VectorRef state);
  bool mustStop();
  void keep(double cost);
  bool comesBefore() const;

  int n_choices_;
  TreeSearchParams params_;
  std::vector<Level> levels_;
  std::vector<int> path_;
  Vector scratch_;
  TreeProblem* problem_{nullptr};
  bool found_{false}, stopped_{false};
  TreeResult result_;
};

}  // namespace fpc
