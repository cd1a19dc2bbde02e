// How the QP solver finds the working set: the remembered one, repaired, or the dual method.
#include <algorithm>
#include <cmath>

#include "optim/qp_kernels.hpp"
#include "optim/qp_solver.hpp"

namespace fpc {
namespace {

using qp::at;
using qp::Index;
using qp::Side;

constexpr int kMaxGuesses = 4;  // working sets tried before the dual method takes over
constexpr int kMaxRounds = 3;   // dual method and polish
constexpr double kAcceptedResidual = 1e-9;

}  // namespace

void QpSolver::Workspace::resize(Index n, Index m) {
  sides.assign(at(n + m), qp::kOff);
  next = sides;
  kkt.resize(n, m);
  dual.resize(n, m);
  noise.resize(m);
  scaled.resize(n, m);
  ax.setZero(m);
  center.setZero(n);
  gradient.setZero(n);
  result.x.setZero(n);
  result.y_x.setZero(n);
  result.y_a.setZero(m);
  remembered = false;
}

/// Whether a row equality is rounding. Any point satisfies it, so the origin does.
bool QpSolver::Workspace::saysNothing(const QpProblem& p, Index id) {
  return id >= p.g.size() && noise.covers(p, id, std::abs(qp::lowerOf(p, id)), center.setZero());
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
      side = saysNothing(p, id) ? qp::kOff : qp::kLower;
    } else if (side != qp::kOff && std::isinf(qp::limitOf(p, id, side))) {
      side = qp::kOff;
    }
  }
}

/// Compares the polished point with the constraints. @return the number of changes that `next`
/// makes to `sides`, or 1 where only the `first` counts
Index QpSolver::Workspace::revise(const QpProblem& p, bool first) {
  const Index n = p.g.size(), m = p.a_lower.size();
  const QpResult& r = result;
  const double x_scale = tolerance() * qp::gradientScale(p, kkt.hx(), r.y_x, kkt.aty());
  const double a_scale = m > 0 ? tolerance() * (1.0 + r.y_a.lpNorm<Eigen::Infinity>()) : 0.0;
  if (m > 0) qp::product(p.A, r.x, ax);
  const double x_largest = r.x.lpNorm<Eigen::Infinity>();
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
      if (noise.within(p, id, violation, tolerance(), r.x, x_largest,
                       qp::limitOf(p, id, violated)) ||
          noise.covers(p, id, violation, r.x))
        continue;
      side = violated;
    }
    ++changes;
    if (first) break;
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
    if (revise(p, k + 1 == count) == 0) return true;
  }
  return false;
}

bool QpSolver::Workspace::stillViolated(const QpProblem& p, Index id) {
  const Index n = p.g.size();
  const double value = id < n ? result.x(id) : p.A.row(id - n).dot(result.x);
  const double below = qp::lowerOf(p, id) - value, above = value - qp::upperOf(p, id);
  const double limit = below > above ? qp::lowerOf(p, id) : qp::upperOf(p, id);
  const double violation = std::max(below, above);
  return !(violation <=
           settings.feasibility_tolerance * qp::feasibilityScale(p, id, result.x, limit)) &&
         !noise.covers(p, id, violation, result.x);
}

SolveStatus QpSolver::Workspace::infeasible() {
  dual.certificate(result);
  return SolveStatus::kInfeasible;
}

void QpSolver::Workspace::evaluate(const QpProblem& p) {
  kkt.evaluate(p, result);
  if (p.a_lower.size() > 0) qp::product(p.A, result.x, ax);
}

/// The dual method from the working set, then the polish, until they agree.
SolveStatus QpSolver::Workspace::search(const QpProblem& p) {
  for (int round = 0; round < kMaxRounds; ++round) {
    if (!dual.start(p, p.g, kkt, sides)) return SolveStatus::kNumericalError;
    const SolveStatus status = dual.run(p, settings, tolerance(), noise, sides, result.iterations);
    result.x = dual.x();
    dual.multipliers(p.g.size(), result);
    if (status == SolveStatus::kIterationLimit || status == SolveStatus::kNumericalError)
      return status;
    if (status == SolveStatus::kSolved && dual.refine(p, kkt, result, ax) && revise(p, true) == 0)
      break;
    // Rows so close to dependent that only the factors of the dual method stand them.
    if (!kkt.factor(p, sides, qp::kDependent)) {
      evaluate(p);
      return status == SolveStatus::kInfeasible ? infeasible() : status;
    }
    kkt.solve(p, sides, result);
    const Index changes = revise(p, true);
    if (status == SolveStatus::kInfeasible && stillViolated(p, dual.culprit())) return infeasible();
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
      qp::scaledResidual(p, noise, result.x, result.y_x, result.y_a, kkt.hx(), kkt.aty(), ax);
  const double accepted = std::max(kAcceptedResidual, 10.0 * settings.feasibility_tolerance);
  return result.kkt_residual <= accepted ? SolveStatus::kSolved : SolveStatus::kNumericalError;
}

SolveStatus QpSolver::Workspace::run(const QpProblem& p, bool warm) {
  begin(p, warm);
  if (guess(p, warm)) {
    if (!kkt.definite() && !kkt.complete() && !kkt.regularise(p))
      return SolveStatus::kNumericalError;
    return finish(p);
  }
  if (result.iterations >= settings.max_iterations) return SolveStatus::kIterationLimit;
  if (!kkt.shifted()) {
    SolveStatus status = search(p);
    if (status == SolveStatus::kSolved) status = finish(p);
    if (status != SolveStatus::kNumericalError || !kkt.regularise(p)) return status;
  }
  return proximal(p);
}

}  // namespace fpc
