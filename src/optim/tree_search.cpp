#include "optim/tree_search.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

// A bound is a sum in another order than the cost it stays below: rounding must not cut the
// optimum.
constexpr double kRounding = 1.0 - 1e-9;

}  // namespace

double TreeProblem::leastCostToGo(int, Eigen::Ref<Vector>, double) { return 0.0; }

void TreeSearchParams::validate(int choices) const {
  require(levels >= 1 && levels <= 1000, "levels", "a number from 1 to 1000");
  const auto first_leaf = static_cast<std::uint64_t>(levels) * static_cast<std::uint64_t>(choices);
  require(budget == 0 || budget >= first_leaf, "budget",
          "0 (none) or at least " + std::to_string(first_leaf) + " nodes, the way to a first leaf");
}

TreeSearch::TreeSearch(Eigen::Index state_size, int choices, TreeSearchParams params)
    : n_choices_(choices), params_(params) {
  require(state_size >= 1, "state_size", "a number >= 1");
  require(choices >= 1, "choices", "a number >= 1");
  params_.validate(choices);
  const auto n_levels = static_cast<std::size_t>(params_.levels);
  levels_.resize(n_levels);
  for (Level& level : levels_) {
    level.states = Matrix::Zero(state_size, choices);
    level.children.resize(static_cast<std::size_t>(choices));
  }
  path_.assign(n_levels, 0);
  result_.choices.assign(n_levels, 0);
  scratch_ = Vector::Zero(state_size);
}

double TreeSearch::fullTree(int choices, int levels) {
  double nodes = 0.0, at_level = 1.0;
  for (int level = 0; level < levels; ++level) nodes += at_level *= choices;
  return nodes;
}

bool TreeSearch::mustStop() {
  if (params_.budget > 0 && result_.nodes + levels_.front().children.size() > params_.budget)
    stopped_ = true;
  return stopped_;
}

bool TreeSearch::comesBefore() const {
  return std::lexicographical_compare(path_.begin(), path_.end(), result_.choices.begin(),
                                      result_.choices.end());
}

void TreeSearch::keep(double cost) {
  if (found_ && !(cost < result_.cost || (cost == result_.cost && comesBefore()))) return;
  found_ = true;
  result_.cost = cost;
  std::copy(path_.begin(), path_.end(), result_.choices.begin());
}

// All children of a node with their bounds, the most promising first.
void TreeSearch::expand(int level, int before, double cost, VectorRef state) {
  Level& here = levels_[static_cast<std::size_t>(level)];
  const bool leaves = level + 1 == params_.levels;
  for (int choice = 0; choice < n_choices_; ++choice) {
    Child& child = here.children[static_cast<std::size_t>(choice)];
    child.choice = choice;
    here.states.col(choice) = state;
    child.cost = cost + problem_->advance(level, before, choice, here.states.col(choice));
    if (!(child.cost < kInfinity)) child.cost = kInfinity;
    child.bound = child.cost;
    ++result_.nodes;
    if (!params_.cost_to_go || leaves || !(child.cost <= result_.cost) || child.cost == kInfinity)
      continue;
    scratch_ = here.states.col(choice);
    ++result_.bounds;
    const double least = problem_->leastCostToGo(level + 1, scratch_, result_.cost - child.cost);
    child.bound = std::max(child.cost, kRounding * (child.cost + least));
  }
  std::sort(here.children.begin(), here.children.end(), [](const Child& a, const Child& b) {
    return a.bound < b.bound || (a.bound == b.bound && a.choice < b.choice);
  });
}

void TreeSearch::explore(int level, int before, double cost, VectorRef state) {
  if (mustStop()) return;
  expand(level, before, cost, state);
  const Level& here = levels_[static_cast<std::size_t>(level)];
  for (const Child& child : here.children) {
    if (child.bound > result_.cost || child.cost == kInfinity || stopped_) return;
    path_[static_cast<std::size_t>(level)] = child.choice;
    if (level + 1 == params_.levels)
      keep(child.cost);
    else
      explore(level + 1, child.choice, child.cost, here.states.col(child.choice));
  }
}

const TreeResult& TreeSearch::search(TreeProblem& problem, VectorRef start) {
  problem_ = &problem;
  found_ = stopped_ = false;
  result_.cost = kInfinity;
  result_.nodes = result_.bounds = 0;
  explore(0, -1, 0.0, start);
  result_.status = !found_    ? TreeStatus::kImpossible
                   : stopped_ ? TreeStatus::kBudget
                              : TreeStatus::kOptimal;
  return result_;
}

}  // namespace fpc
