#include "control/clp/prediction.hpp"

#include "control/clp/closed_loop_paradigm.hpp"

namespace fpc {

ClpPrediction::ClpPrediction(const ClpSizes& s)
    : sizes(s),
      state_pulse(s.n_x, s.inputs()),
      output_pulse(s.n_y, s.inputs()),
      law_pulse(s.n_u, s.inputs()),
      state_free(s.n_x, s.n_c + 1),
      law_offset(Matrix::Zero(s.n_u, s.n_c)),
      perturbation_free(s.n_u, s.n_c) {}

void ClpPrediction::compute(const PredictiveAction& now) {
  const Eigen::Index n_u = sizes.n_u;
  state_pulse.leftCols(n_u) = now.B;
  state_free.col(0) = now.state;
  for (Eigen::Index i = 0; i < sizes.n_c; ++i) {
    state_free.col(i + 1) = now.offset_state;
    state_free.col(i + 1) += now.A.lazyProduct(state_free.col(i));
    if (i == 0) continue;
    state_pulse.middleCols(i * n_u, n_u).noalias() =
        now.A.lazyProduct(state_pulse.middleCols((i - 1) * n_u, n_u));
  }
  output_pulse.noalias() = now.C.lazyProduct(state_pulse);
  law_pulse.noalias() = now.K.lazyProduct(state_pulse);
  perturbation_free = -law_offset;
  perturbation_free += now.K.lazyProduct(state_free.leftCols(sizes.n_c));
}

void ClpPrediction::stack(ClpProblem& problem) const {
  const Eigen::Index n_x = sizes.n_x, n_u = sizes.n_u, n_c = sizes.n_c;
  Matrix& X = problem.state_from_input;
  Matrix& T = problem.perturbation_from_input;
  for (Eigen::Index k = 0; k < n_c; ++k) {
    X.block(k * n_x, 0, n_x, n_u) = state_pulse.middleCols(k * n_u, n_u);
    if (k + 1 == n_c) break;
    T.block((k + 1) * n_u, 0, n_u, n_u) = law_pulse.middleCols(k * n_u, n_u);
  }
  for (Eigen::Index j = 1; j < n_c; ++j) {  // each block column is the first one, moved down
    const Eigen::Index left = n_c - j;
    X.block(j * n_x, j * n_u, left * n_x, n_u) = X.topLeftCorner(left * n_x, n_u);
    T.block(j * n_u, j * n_u, left * n_u, n_u) = T.topLeftCorner(left * n_u, n_u);
  }
  problem.state_free = flat(state_free).tail(n_x * n_c);
  problem.perturbation_free = flat(perturbation_free);
}

}  // namespace fpc
