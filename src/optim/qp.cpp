// The QP solver's public side: what it accepts, and what a solve forgets and remembers.
#include "optim/qp.hpp"

#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "optim/qp_solver.hpp"

namespace fpc {
namespace {

using qp::Index;

bool limitsValid(const Vector& lower, const Vector& upper) {
  for (Index i = 0; i < lower.size(); ++i) {
    if (!(lower(i) <= upper(i)) || lower(i) == kInfinity || upper(i) == -kInfinity) return false;
  }
  return true;
}

bool sizesValid(const QpProblem& p, Index n_max, Index m_max) {
  const Index n = p.g.size(), m = p.a_lower.size();
  return n >= 1 && n <= n_max && m <= m_max && p.H.rows() == n && p.H.cols() == n &&
         p.x_lower.size() == n && p.x_upper.size() == n && p.a_upper.size() == m &&
         p.A.rows() == m && (m == 0 || p.A.cols() == n);
}

}  // namespace

QpProblem::QpProblem(Eigen::Index n, Eigen::Index m)
    : H(Matrix::Identity(n, n)),
      g(Vector::Zero(n)),
      x_lower(Vector::Constant(n, -kInfinity)),
      x_upper(Vector::Constant(n, kInfinity)),
      A(Matrix::Zero(m, n)),
      a_lower(Vector::Constant(m, -kInfinity)),
      a_upper(Vector::Constant(m, kInfinity)) {}

void QpSettings::validate() const {
  require(max_iterations >= 1, "max_iterations", "an integer >= 1");
  require(feasibility_tolerance >= 1e-14 && feasibility_tolerance <= 1e-3, "feasibility_tolerance",
          "a number in 1e-14..1e-3");
}

QpSolver::QpSolver(Eigen::Index n, Eigen::Index m, const QpSettings& settings) {
  require(n >= 1 && m >= 0, "QpSolver", "n >= 1 unknowns and m >= 0 rows");
  settings.validate();
  work_ = std::make_unique<Workspace>(n, m, settings);
}

QpSolver::~QpSolver() = default;
QpSolver::QpSolver(QpSolver&&) noexcept = default;
QpSolver& QpSolver::operator=(QpSolver&&) noexcept = default;

SolveStatus QpSolver::Workspace::solve(const QpProblem& p, bool warm) {
  kkt.setHessian(p.H);
  noise.reset();
  const SolveStatus status = run(p, warm);
  const bool failed = status == SolveStatus::kInfeasible || status == SolveStatus::kNumericalError;
  return warm && failed ? run(p, false) : status;  // a working set that misled must not decide
}

void QpSolver::forget() { work_->remembered = false; }

const QpResult& QpSolver::solve(const QpProblem& problem, bool warm) {
  Workspace& w = *work_;
  QpResult& result = w.result;
  result.iterations = 0;
  result.active = 0;
  result.kkt_residual = kInfinity;
  if (!sizesValid(problem, w.n_max, w.m_max) || !limitsValid(problem.x_lower, problem.x_upper) ||
      !limitsValid(problem.a_lower, problem.a_upper) || !problem.g.allFinite()) {
    result.status = SolveStatus::kInvalidProblem;
    w.remembered = false;
    return result;
  }
  const Index n = problem.g.size(), m = problem.a_lower.size();
  if (result.x.size() != n || result.y_a.size() != m) w.resize(n, m);
  const bool scaled = w.scaled.scale(problem);
  result.status = w.solve(scaled ? w.scaled.problem() : problem, warm && w.remembered);
  if (scaled) {
    result.x.array() *= w.scaled.size().array();
    result.y_x.array() /= w.scaled.size().array();
  }
  // A solved problem has finite H x and A x, so only a failure can hide data that are not finite.
  if (result.status != SolveStatus::kSolved && !(problem.H.allFinite() && problem.A.allFinite())) {
    result.status = SolveStatus::kInvalidProblem;
  }
  w.remembered = result.status == SolveStatus::kSolved;
  return result;
}

}  // namespace fpc
