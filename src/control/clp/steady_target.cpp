#include "control/clp/steady_target.hpp"

#include <utility>

namespace fpc {

SteadyTarget::SteadyTarget(Eigen::Index n_x, Eigen::Index n_u, std::vector<int> outputs)
    : outputs_(std::move(outputs)),
      system_(n_x + n_u, n_x + n_u),
      factors_(n_x + n_u, n_x + n_u),
      right_side_(n_x + n_u),
      solution_(n_x + n_u),
      state_(Vector::Zero(n_x)),
      input_(Vector::Zero(n_u)) {}

bool SteadyTarget::solve(const PredictiveAction& now) {
  const Eigen::Index n_x = state_.size(), n_u = input_.size();
  system_.setZero();
  system_.topLeftCorner(n_x, n_x) = now.A;
  system_.topLeftCorner(n_x, n_x).diagonal().array() -= 1.0;
  system_.topRightCorner(n_x, n_u) = now.B;
  right_side_.head(n_x) = -now.offset_state;
  for (Eigen::Index r = 0; r < n_u; ++r) {
    const int output = outputs_[static_cast<std::size_t>(r)];
    system_.row(n_x + r).head(n_x) = now.C.row(output);
    right_side_[n_x + r] = now.setpoint[output] - now.offset_output[output];
  }
  factors_.compute(system_);
  if (!factors_.isInvertible()) return false;
  const auto& rows = factors_.permutationP().indices();  // by hand: FullPivLU::solve allocates
  const auto& columns = factors_.permutationQ().indices();
  for (Eigen::Index i = 0; i < rows.size(); ++i) solution_[rows[i]] = right_side_[i];
  factors_.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(solution_);
  factors_.matrixLU().triangularView<Eigen::Upper>().solveInPlace(solution_);
  right_side_.swap(solution_);
  for (Eigen::Index i = 0; i < columns.size(); ++i) solution_[columns[i]] = right_side_[i];
  state_ = solution_.head(n_x);
  input_ = solution_.tail(n_u);
  return solution_.allFinite();
}

}  // namespace fpc
