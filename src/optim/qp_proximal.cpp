// Semidefinite Hessians: the proximal-point method (rockafellar1976). Each step minimises the cost
// plus 1/2 (x - c)'D(x - c) around the last point c by the dual method, warm in its factors, D
// being small against H. As soon as the working set is right, the polish, whose factors hold H + D
// and whose residuals are those of the problem as given, ends it.
#include <cmath>
#include <limits>

#include "optim/qp_solver.hpp"

namespace fpc {
namespace {

constexpr int kMaxSteps = 60;
constexpr int kStepsPerShift = 6;  // then D is made smaller
constexpr double kShiftFactor = 1e-2;
constexpr double kGoodResidual = 1e-12;  // a larger one is accepted when it no longer shrinks
constexpr double kShrinking = 0.1;

}  // namespace

/// @return whether the working set of the dual method gives a point that satisfies everything
bool QpSolver::Workspace::polish(const QpProblem& p) {
  if (!kkt.factor(p, sides, qp::kDependent)) return false;
  kkt.solve(p, sides, result);
  return revise(p, true) == 0 && finish(p) == SolveStatus::kSolved;
}

SolveStatus QpSolver::Workspace::proximal(const QpProblem& p) {
  center = result.x;
  if (!center.allFinite()) center.setZero();
  ++result.iterations;
  if (polish(p)) return SolveStatus::kSolved;  // the first working set is often the right one
  bool fresh = true, renewed = false;
  double residual = std::numeric_limits<double>::infinity();
  for (int step = 1; step <= kMaxSteps; ++step) {
    gradient = p.g - kkt.shift().cwiseProduct(center);
    if (!(fresh ? dual.start(p, gradient, kkt, sides) : dual.restart(p, gradient, sides)))
      return SolveStatus::kNumericalError;
    const SolveStatus status = dual.run(p, settings, tolerance(), noise, sides, result.iterations);
    if (status == SolveStatus::kInfeasible) return infeasible();
    if (status == SolveStatus::kNumericalError && !renewed) {
      fresh = renewed = true;  // the factors may have gathered rounding: once more with new ones
      continue;
    }
    if (status != SolveStatus::kSolved) return status;
    result.x = center = dual.x();
    dual.multipliers(p.g.size(), result);
    if (polish(p)) return SolveStatus::kSolved;
    result.x = center;
    dual.multipliers(p.g.size(), result);
    evaluate(p);
    const double before = residual;
    const bool accepted = finish(p) == SolveStatus::kSolved;
    residual = result.kkt_residual;
    if (accepted && (residual <= kGoodResidual || residual > kShrinking * before))
      return SolveStatus::kSolved;
    fresh = step % kStepsPerShift == 0 && kkt.reduceShift(kShiftFactor);
  }
  return SolveStatus::kNumericalError;
}

}  // namespace fpc
