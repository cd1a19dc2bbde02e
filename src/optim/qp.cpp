// The QP solver: tries the working set it remembers on a fresh factorisation (one factorisation if
// nothing changed), repairs it a few times, else runs the dual active-set method; every answer is
// polished and judged by its residual.
#include "fmbpc/optim/qp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "optim/qp_workspace.hpp"

namespace fpc {
namespace {

using qp::Index;
using qp::Side;
using qp::Sides;

constexpr int kMaxGuesses = 4;  // working sets tried before the dual method takes over
constexpr int kMaxRounds = 3;   // dual method and polish
constexpr double kAcceptedResidual = 1e-9;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

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

struct QpSolver::Workspace {
  Workspace(Index n, Index m, const QpSettings& s) : n_max(n), m_max(m), settings(s) {
    resize(n, m);
  }

  void resize(Index n, Index m);
  SolveStatus run(const QpProblem& p, bool warm);
  void begin(const QpProblem& p, bool warm);
  bool guess(const QpProblem& p, bool warm);
  SolveStatus search(const QpProblem& p);
  Index revise(const QpProblem& p);
  SolveStatus finish(const QpProblem& p);
  bool stillViolated(const QpProblem& p, Index id) const;
  double tolerance() const { return std::max(0.01 * settings.feasibility_tolerance, 1e-14); }

  Index n_max, m_max;
  QpSettings settings;
  Sides sides, next;
  bool remembered{};
  qp::KktSystem kkt;
  qp::DualActiveSet dual;
  Vector ax;
  QpResult result;
};

void QpSolver::Workspace::resize(Index n, Index m) {
  sides.assign(at(n + m), qp::kOff);
  next = sides;
  kkt.resize(n);
  dual.resize(n, m);
  ax.setZero(m);
  result.x.setZero(n);
  result.y_x.setZero(n);
  result.y_a.setZero(m);
  remembered = false;
}

/// The first working set: the remembered one or nothing, and the equalities.
void QpSolver::Workspace::begin(const QpProblem& p, bool warm) {
  if (!warm) {
    std::fill(sides.begin(), sides.end(), qp::kOff);
    result.x.setZero();
    result.y_a.setZero();
  }
  const Index count = p.g.size() + p.a_lower.size();
  for (Index id = 0; id < count; ++id) {
    Side& side = sides[at(id)];
    if (qp::isEquality(p, id)) {
      side = qp::kLower;
    } else if (side != qp::kOff && std::isinf(qp::limitOf(p, id, side))) {
      side = qp::kOff;
    }
  }
}

/// Compares the polished point with the constraints. @return the number of changes that `next`
/// makes to `sides`
Index QpSolver::Workspace::revise(const QpProblem& p) {
  const Index n = p.g.size(), m = p.a_lower.size();
  const QpResult& r = result;
  const double x_scale = tolerance() * qp::gradientScale(p, kkt.hx(), r.y_x, kkt.aty());
  const double a_scale = m > 0 ? tolerance() * (1.0 + r.y_a.lpNorm<Eigen::Infinity>()) : 0.0;
  if (m > 0) ax.noalias() = p.A * r.x;
  Index changes = 0;
  next = sides;
  for (Index id = 0; id < n + m; ++id) {
    const double value = id < n ? r.x(id) : ax(id - n);
    Side& side = next[at(id)];
    if (side != qp::kOff) {
      const double y = static_cast<double>(side) * (id < n ? r.y_x(id) : r.y_a(id - n));
      if (y >= -(id < n ? x_scale : a_scale) || qp::isEquality(p, id)) continue;
      side = qp::kOff;
    } else {
      const double below = qp::lowerOf(p, id) - value, above = value - qp::upperOf(p, id);
      const double violation = std::max(below, above);
      if (violation <= 0.0) continue;
      const Side violated = below > above ? qp::kLower : qp::kUpper;
      if (violation <= tolerance() * qp::feasibilityScale(p, id, r.x, qp::limitOf(p, id, violated)))
        continue;
      side = violated;
    }
    ++changes;
  }
  return changes;
}

/// Solves for the working set; while wrong, exchanges all constraints that are (primal-dual active
/// set). On failure leaves the last working set that could be factored. @return whether the answer
/// was found
bool QpSolver::Workspace::guess(const QpProblem& p, bool warm) {
  const int count = warm || p.a_lower.size() == 0 ? kMaxGuesses : 1;
  for (int k = 0; k < count && result.iterations < settings.max_iterations; ++k) {
    if (!kkt.factor(p, k == 0 ? sides : next, qp::kNearlyDependent)) return false;
    if (k > 0) sides.swap(next);
    ++result.iterations;
    kkt.solve(p, sides, result);
    if (revise(p) == 0) return true;
  }
  return false;
}

bool QpSolver::Workspace::stillViolated(const QpProblem& p, Index id) const {
  const Index n = p.g.size();
  const double value = id < n ? result.x(id) : p.A.row(id - n).dot(result.x);
  const double below = qp::lowerOf(p, id) - value, above = value - qp::upperOf(p, id);
  const double limit = below > above ? qp::lowerOf(p, id) : qp::upperOf(p, id);
  return !(std::max(below, above) <=
           settings.feasibility_tolerance * qp::feasibilityScale(p, id, result.x, limit));
}

/// The dual method from the working set, then the polish, until they agree.
SolveStatus QpSolver::Workspace::search(const QpProblem& p) {
  for (int round = 0; round < kMaxRounds; ++round) {
    if (!dual.start(p, kkt, sides)) return SolveStatus::kNumericalError;
    const SolveStatus status = dual.run(p, settings, tolerance(), sides, result.iterations);
    result.x = dual.x();
    dual.multipliers(p.g.size(), result);
    if (status == SolveStatus::kIterationLimit || status == SolveStatus::kNumericalError)
      return status;
    // Rows so close to dependent that only the factors of the dual method stand them.
    if (!kkt.factor(p, sides, qp::kDependent)) {
      kkt.evaluate(p, result);
      if (p.a_lower.size() > 0) ax.noalias() = p.A * result.x;
      return status;
    }
    kkt.solve(p, sides, result);
    const Index changes = revise(p);
    if (status == SolveStatus::kInfeasible && stillViolated(p, dual.culprit())) return status;
    if (changes == 0) break;
  }
  return SolveStatus::kSolved;
}

/// Judges the point. Multipliers of the wrong sign that revise() let pass are rounding: zero.
SolveStatus QpSolver::Workspace::finish(const QpProblem& p) {
  const Index n = p.g.size(), m = p.a_lower.size();
  bool row_changed = false;
  result.active = 0;
  for (Index id = 0; id < n + m; ++id) {
    const Side side = sides[at(id)];
    if (side == qp::kOff) continue;
    ++result.active;
    double& y = id < n ? result.y_x(id) : result.y_a(id - n);
    if (y * static_cast<double>(side) >= 0.0 || qp::isEquality(p, id)) continue;
    y = 0.0;
    row_changed = row_changed || id >= n;
  }
  if (row_changed) kkt.evaluate(p, result);
  result.kkt_residual =
      qp::scaledResidual(p, result.x, result.y_x, result.y_a, kkt.hx(), kkt.aty(), ax);
  const double accepted = std::max(kAcceptedResidual, 10.0 * settings.feasibility_tolerance);
  return result.kkt_residual <= accepted ? SolveStatus::kSolved : SolveStatus::kNumericalError;
}

SolveStatus QpSolver::Workspace::run(const QpProblem& p, bool warm) {
  begin(p, warm);
  if (guess(p, warm)) {
    if (!kkt.definite() && !kkt.complete()) return SolveStatus::kNumericalError;
    return finish(p);
  }
  if (result.iterations >= settings.max_iterations) return SolveStatus::kIterationLimit;
  const SolveStatus status = search(p);
  return status == SolveStatus::kSolved ? finish(p) : status;
}

QpSolver::QpSolver(Eigen::Index n, Eigen::Index m, const QpSettings& settings) {
  require(n >= 1 && m >= 0, "QpSolver", "n >= 1 unknowns and m >= 0 rows");
  settings.validate();
  work_ = std::make_unique<Workspace>(n, m, settings);
}

QpSolver::~QpSolver() = default;
QpSolver::QpSolver(QpSolver&&) noexcept = default;
QpSolver& QpSolver::operator=(QpSolver&&) noexcept = default;

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
  w.kkt.setHessian(problem.H);
  warm = warm && w.remembered;
  result.status = w.run(problem, warm);
  if (warm && (result.status == SolveStatus::kInfeasible ||
               result.status == SolveStatus::kNumericalError)) {
    result.status = w.run(problem, false);  // a working set that misled must not decide
  }
  // A solved problem has finite H x and A x, so only a failure can hide data that are not finite.
  if (result.status != SolveStatus::kSolved && !(problem.H.allFinite() && problem.A.allFinite())) {
    result.status = SolveStatus::kInvalidProblem;
  }
  w.remembered = result.status == SolveStatus::kSolved;
  return result;
}

}  // namespace fpc
