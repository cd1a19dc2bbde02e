#include "control/clp/cost.hpp"

#include "control/clp/closed_loop_paradigm.hpp"
#include "control/power_of_two.hpp"

#include <algorithm>
#include <cmath>

namespace fpc {

ClpCost::ClpCost(const ClpParams& params, const ClpSizes& s)
    : sizes_(s),
      lq_(params.cost == ClpCostKind::kLq),
      weight_output_(lq_ ? params.weight_state_output : params.weight_tracking),
      weight_input_(lq_ ? params.weight_input : params.weight_perturbation),
      root_output_(weight_output_.cwiseSqrt()),
      root_input_(weight_input_.cwiseSqrt()),
      state_factor_(s.inputs(), lq_ ? s.n_x : 0),
      terminal_(s.inputs(), s.n_x),
      output_error_(s.n_y, s.n_c),
      input_error_(s.n_u, s.n_c),
      error_(s.n_x),
      terminal_error_(Vector::Zero(s.n_x)),
      adjoint_(s.n_x),
      next_adjoint_(s.n_x) {
  tracks_ = (weight_output_.array() > 0.0).any();
  factor_ = Matrix::Zero(s.inputs(), (tracks_ ? s.n_y : 0) + (lq_ ? 0 : s.n_u));
}

void ClpCost::fill(const PredictiveAction& now, const ClpPrediction& prediction, const ClpAim* aim,
                   ClpProblem& problem) {
  stackFactor(prediction, problem.input_scale);
  fillHessian(aim, problem.input_scale, problem.qp.H);
  findResiduals(now, prediction, aim, problem);
  fillGradient(now, aim, problem.qp.g);
  scale(problem);
}

// Rows run backwards in time, columns are scaled: factor(p) belongs to the pulse n_c - 1 - i of
// input p = (i, a).
void ClpCost::stackFactor(const ClpPrediction& prediction, const Vector& unit) {
  const Eigen::Index n = sizes_.inputs(), n_u = sizes_.n_u;
  const Eigen::Index n_tracked = tracks_ ? sizes_.n_y : 0;
  for (Eigen::Index p = 0; p < n; ++p) {
    const Eigen::Index a = p % n_u, pulse = n - n_u - p + 2 * a;
    for (Eigen::Index o = 0; o < n_tracked; ++o) {
      factor_(p, o) = unit[a] * root_output_[o] * prediction.output_pulse(o, pulse);
    }
    for (Eigen::Index x = 0; x < state_factor_.cols(); ++x) {
      state_factor_(p, x) = unit[a] * prediction.state_pulse(x, pulse);
    }
    for (Eigen::Index b = 0; b < n_u && !lq_; ++b) {  // blocks I, K B, K A B, ... of T
      const double effect = pulse < n_u ? (a == b) : prediction.law_pulse(b, pulse - n_u);
      factor_(p, n_tracked + b) = unit[a] * root_input_[b] * effect;
    }
  }
}

// Lower triangle: H(i, j) = H(i+1, j+1) + factor(i)' factor(j), then what is not Toeplitz.
void ClpCost::fillHessian(const ClpAim* aim, const Vector& unit, Matrix& H) {
  const Eigen::Index n = sizes_.inputs(), n_u = sizes_.n_u;
  for (Eigen::Index q = n - 1; q >= 0; --q) {
    const Eigen::Index below = n - q, shared = std::max<Eigen::Index>(below - n_u, 0);
    auto column = H.col(q).segment(q, below);
    column.setZero();
    if (shared > 0) column.head(shared) = H.col(q + n_u).segment(q + n_u, shared);
    for (Eigen::Index r = 0; r < factor_.cols(); ++r) {
      column += factor_(q, r) * factor_.col(r).tail(below);
    }
  }
  if (aim == nullptr) return;
  terminal_.noalias() = state_factor_.lazyProduct(aim->P);
  for (Eigen::Index q = 0; q < n; ++q) {
    H(q, q) += weight_input_[q % n_u] * unit[q % n_u] * unit[q % n_u];
    for (Eigen::Index x = 0; x < sizes_.n_x; ++x) {
      H.col(q).segment(q, n - q) += terminal_(q, x) * state_factor_.col(x).tail(n - q);
    }
  }
}

// What the cost weighs at U = 0: outputs in output_error_, inputs or perturbations in input_error_,
// times their weight.
void ClpCost::findResiduals(const PredictiveAction& now, const ClpPrediction& prediction,
                            const ClpAim* aim, ClpProblem& problem) {
  const Eigen::Index n_c = sizes_.n_c;
  problem.cost_constant = 0.0;
  for (Eigen::Index i = 0; i < n_c; ++i) {
    if (tracks_) {
      error_ = prediction.state_free.col(i + 1);
      if (aim != nullptr) error_ -= aim->x_ss;
      output_error_.col(i) = now.C.lazyProduct(error_);
      if (aim == nullptr) output_error_.col(i) += now.offset_output - now.reference.col(i);
      problem.cost_constant += weight_output_.dot(output_error_.col(i).cwiseAbs2());
      output_error_.col(i).array() *= weight_output_.array();
    }
    if (aim != nullptr) {
      input_error_.col(i) = -aim->u_ss;
    } else {
      input_error_.col(i) = prediction.perturbation_free.col(i);
    }
    problem.cost_constant += weight_input_.dot(input_error_.col(i).cwiseAbs2());
    input_error_.col(i).array() *= weight_input_.array();
  }
  if (aim == nullptr) return;
  error_ = prediction.state_free.col(n_c) - aim->x_ss;
  terminal_error_.noalias() = aim->P.lazyProduct(error_);
  problem.cost_constant += error_.dot(terminal_error_);
}

// g(j) = w(j) + B' l(j+1),  l(i) = C' W e(i) + K' w(i) + A' l(i+1): K' w only where w weighs the
// perturbation.
void ClpCost::fillGradient(const PredictiveAction& now, const ClpAim* aim, Vector& g) {
  const Eigen::Index n_u = sizes_.n_u;
  adjoint_ = terminal_error_;
  for (Eigen::Index j = sizes_.n_c - 1; j >= 0; --j) {
    if (tracks_) adjoint_ += now.C.transpose().lazyProduct(output_error_.col(j));
    g.segment(j * n_u, n_u) = input_error_.col(j) + now.B.transpose().lazyProduct(adjoint_);
    next_adjoint_.noalias() = now.A.transpose().lazyProduct(adjoint_);
    if (aim == nullptr) next_adjoint_ += now.K.transpose().lazyProduct(input_error_.col(j));
    adjoint_.swap(next_adjoint_);
  }
}

void ClpCost::scale(ClpProblem& problem) const {
  const Eigen::Index n = sizes_.inputs(), n_u = sizes_.n_u;
  Matrix& H = problem.qp.H;
  problem.cost_scale = powerOfTwoNear(H.diagonal().head(n).maxCoeff());
  for (Eigen::Index q = 0; q < n; ++q) {
    problem.qp.g[q] *= problem.input_scale[q % n_u] / problem.cost_scale;
    H.col(q).segment(q, n - q) /= problem.cost_scale;
    H.row(q).segment(q, n - q) = H.col(q).segment(q, n - q).transpose();
  }
}

}  // namespace fpc
