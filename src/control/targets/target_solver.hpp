// Where a plant is to rest: ranked limits strictly one rank after the other, then prices, then
// resting values. Linear in the unknowns; see SteadyModel for where the rows come from.
#pragma once

#include <memory>
#include <vector>

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

/// Bounds of the unknowns hold always. A row is asked to be lower <= row . v <= upper; what cannot
/// be kept is given up, the higher number of `rank` first.
/// Symbols: n unknowns, m rows
struct TargetProblem {
  Vector lower, upper;          ///< n, of the unknowns
  Vector unit;                  ///< n, > 0: how far a move of each counts as one
  Matrix rows;                  ///< m n
  Vector row_lower, row_upper;  ///< m, infinite if absent
  Vector row_unit;              ///< m, > 0: how much given up counts as one
  std::vector<int> rank;        ///< m, 1 is kept first
  Vector price;                 ///< n, of one of each unknown; negative: it earns
  Vector rest;                  ///< n, where the unknowns go if prices leave them free
  double band{};                ///< of the cost: so far above the least one may rest, >= 0
  TargetProblem() = default;
  TargetProblem(Eigen::Index n, Eigen::Index m);
};

struct TargetSolution {
  SolveStatus status{SolveStatus::kNotRun};
  Vector v;             ///< n
  Vector given_up;      ///< m, row . v beyond its limit: > 0 above the upper one, < 0 below
  double cost{};        ///< price . v
  double least_cost{};  ///< the least that the ranked limits allow
  bool usable() const { return status == SolveStatus::kSolved; }
};

/// Of each rank in turn the least sum of (given up / row_unit)^2, ties of a rank shared; limits of
/// the ranks before are kept as they were found. Then the least cost; then the least sum of
/// ((v - rest) / unit)^2 at a cost within the band. Solved by QpSolver, warm from sample to sample.
/// No allocation in solve() for one size and one list of ranks.
class TargetSolver {
 public:
  TargetSolver(Eigen::Index n, std::vector<int> ranks);
  ~TargetSolver();
  TargetSolver(TargetSolver&&) noexcept;
  /// Problems of the size and ranks of the constructor. Status: invalid problem for numbers that
  /// are not finite and lower > upper; numerical error where a price drives an unknown without a
  /// limit, or a solver fails.
  const TargetSolution& solve(const TargetProblem& problem);
  const TargetSolution& solution() const;  ///< of the last solve()

 private:
  struct Workspace;
  std::unique_ptr<Workspace> work_;
};

}  // namespace fpc
