// Private: how the QP solver uses its parts. It tries the working set that it remembers on a fresh
// factorisation (one factorisation if nothing changed), repairs it a few times, else runs the dual
// active-set method, inside proximal-point iterations if H is only semidefinite; every answer is
// polished and judged by its residual.
#pragma once

#include <algorithm>

#include "optim/qp_sizes.hpp"
#include "optim/qp_workspace.hpp"

namespace fpc {

struct QpSolver::Workspace {
  Workspace(qp::Index n, qp::Index m, const QpSettings& s) : n_max(n), m_max(m), settings(s) {
    resize(n, m);
  }

  void resize(qp::Index n, qp::Index m);
  SolveStatus solve(const QpProblem& p, bool warm);
  SolveStatus run(const QpProblem& p, bool warm);
  void begin(const QpProblem& p, bool warm);
  bool saysNothing(const QpProblem& p, qp::Index id);
  bool guess(const QpProblem& p, bool warm);
  SolveStatus search(const QpProblem& p);
  SolveStatus proximal(const QpProblem& p);
  bool polish(const QpProblem& p);
  void evaluate(const QpProblem& p);
  qp::Index revise(const QpProblem& p, bool first);
  SolveStatus finish(const QpProblem& p);
  bool stillViolated(const QpProblem& p, qp::Index id);
  SolveStatus infeasible();
  double tolerance() const { return std::max(0.01 * settings.feasibility_tolerance, 1e-14); }

  qp::Index n_max, m_max;
  QpSettings settings;
  qp::Sides sides, next;
  bool remembered{};
  qp::KktSystem kkt;
  qp::DualActiveSet dual;
  qp::RowNoise noise;
  qp::ScaledProblem scaled;
  Vector ax;
  Vector center, gradient;  // of the proximal-point iteration
  QpResult result;
};

}  // namespace fpc
