// The dual active-set method (goldfarb1983, section 3) for bounds and two-sided
// rows: starting from the minimum on a working set whose multipliers have their signs, violated
// constraints enter one at a time. Bounds enter before rows, because they are cheap to look at.
#include <algorithm>
#include <cmath>

#include "optim/qp_kernels.hpp"
#include "optim/qp_workspace.hpp"

namespace fpc::qp {
namespace {

constexpr double kBlockingTolerance =
    1e-12;  // of |normal|: a smaller r of a dependent normal is noise

}  // namespace

void DualActiveSet::resize(Index n, Index m) {
  J_.setZero(n, n);
  R_.setZero(n, n);
  for (Vector* v : {&x_, &u_, &normal_, &d_, &z_, &r_, &c_, &scale_}) v->setZero(n);
  ax_.setZero(m);
  proof_x_.setZero(n);
  proof_a_.setZero(m);
  proof_error_.setZero(n);
  error_.setZero(n);
  inverse_scale_.setZero(n);
  row_metric_.setZero(m);
  active_.assign(at(n), 0);
  active_side_.assign(at(n), kOff);
  ignored_.assign(at(n + m), 0);
  q_ = 0;
}

bool DualActiveSet::start(const QpProblem& p, const Vector& g, KktSystem& kkt, Sides& sides) {
  if (!kkt.factorFree(p, sides) || !kkt.complete()) return false;
  const Index n = p.g.size(), m = p.a_lower.size();
  scale_ = (p.H.diagonal() + kkt.shift()).cwiseSqrt();
  inverse_scale_ = scale_.cwiseInverse();
  rows_measured_ = false;
  culprit_ = -1;
  seed(p, kkt, sides);
  for (const bool equalities :
       {true, false}) {  // an equality must not be kept out by an inequality
    for (Index id = n; id < n + m; ++id) {
      if (sides[at(id)] == kOff || isEquality(p, id) != equalities) continue;
      setNormal(p, id, sides[at(id)]);
      transformNormal(id, sides[at(id)]);
      if (dependent(kNearlyDependent)) {  // enters later if it is violated
        sides[at(id)] = kOff;
        continue;
      }
      product(J_.rightCols(n - q_), d_.tail(n - q_), z_);
      append(id, sides[at(id)]);
    }
  }
  return restart(p, g, sides);
}

bool DualActiveSet::restart(const QpProblem& p, const Vector& g, Sides& sides) {
  std::fill(ignored_.begin(), ignored_.end(), char{0});
  minimise(p, g);
  dropWrongSigns(p, g, sides);
  return x_.allFinite();
}

void DualActiveSet::dropWrongSigns(const QpProblem& p, const Vector& g, Sides& sides) {
  for (;;) {
    Index worst = -1;
    double most = 0.0;
    for (Index k = 0; k < q_; ++k) {
      if (isEquality(p, active_[at(k)]) || !(u_(k) * R_(k, k) * R_(k, k) < most)) continue;
      most = u_(k) * R_(k, k) * R_(k, k);
      worst = k;
    }
    if (worst < 0) return;
    remove(worst, sides);
    minimise(p, g);
  }
}

void DualActiveSet::measureRows(const QpProblem& p) {
  if (rows_measured_) return;
  row_metric_.setZero();
  addSquares(p.A.data(), p.A.rows(), p.A.cols(), inverse_scale_.data(), row_metric_.data());
  row_metric_ = row_metric_.cwiseSqrt().cwiseInverse();
  rows_measured_ = true;
}

/// The constraint outside the working set that is violated most in the metric diag(H)^-1; -1 if
/// none is.
Index DualActiveSet::mostViolated(const QpProblem& p, double tolerance, RowNoise& noise,
                                  const Sides& sides, Side& side) {
  const Index n = p.g.size(), m = p.a_lower.size();
  const double x_largest = x_.lpNorm<Eigen::Infinity>();
  Index worst = -1;
  double most = 0.0;
  const auto consider = [&](Index id, double below, double above, double metric) {
    const double violation = std::max(below, above);
    if (!(violation * metric > most) || sides[at(id)] != kOff || ignored_[at(id)]) return;
    const Side violated = below > above ? kLower : kUpper;
    if (noise.within(p, id, violation, tolerance, x_, x_largest, limitOf(p, id, violated))) return;
    if (noise.covers(p, id, violation, x_)) return;
    most = violation * metric;
    worst = id;
    side = violated;
  };
  for (Index i = 0; i < n; ++i) consider(i, p.x_lower(i) - x_(i), x_(i) - p.x_upper(i), scale_(i));
  if (worst >= 0 || m == 0) return worst;
  product(p.A, x_, ax_);
  measureRows(p);
  for (Index row = 0; row < m; ++row)
    consider(n + row, p.a_lower(row) - ax_(row), ax_(row) - p.a_upper(row), row_metric_(row));
  return worst;
}

/// The first constraint whose multiplier reaches zero as the new one's grows, and that step length.
Index DualActiveSet::blocking(const QpProblem& p, bool dependent, double& step) const {
  Index first = -1;
  step = kInfinity;
  const double norm = dependent ? d_.norm() : 0.0;
  for (Index k = 0; k < q_; ++k) {
    if (!(r_(k) > 0.0) || isEquality(p, active_[at(k)])) continue;
    if (dependent && r_(k) * R_.col(k).head(k + 1).norm() <= kBlockingTolerance * norm) continue;
    const double length = std::max(u_(k), 0.0) / r_(k);
    if (!(length < step)) continue;
    step = length;
    first = k;
  }
  return first;
}

/// One major iteration: partial steps until the constraint is in the working set.
SolveStatus DualActiveSet::add(const QpProblem& p, const QpSettings& settings, RowNoise& noise,
                               Index id, Side side, Sides& sides, int& iterations) {
  const Index n = p.g.size();
  const double limit = limitOf(p, id, side), sign = static_cast<double>(side);
  double u_new = 0.0;
  setNormal(p, id, side);
  for (;;) {
    if (iterations >= settings.max_iterations) return SolveStatus::kIterationLimit;
    ++iterations;
    transformNormal(id, side);
    const bool blocked = dependent(kDependent);
    r_.head(q_) = d_.head(q_);
    if (q_ > 0) R_.topLeftCorner(q_, q_).triangularView<Eigen::Upper>().solveInPlace(r_.head(q_));
    double step = kInfinity;
    const Index leaving = blocking(p, blocked, step);
    const double violation = sign * limit - (id < n ? sign * x_(id) : normal_.dot(x_));
    if (!std::isfinite(violation) || !d_.allFinite()) return SolveStatus::kNumericalError;
    if (blocked && leaving < 0) {
      if (violation > settings.feasibility_tolerance * feasibilityScale(p, id, x_, limit) &&
          !noise.covers(p, id, violation, x_))
        return contradiction(p, id, side);
      ignored_[at(id)] = 1;
      return SolveStatus::kSolved;
    }
    const auto null_part = d_.tail(n - q_);
    const double full = blocked ? kInfinity : std::max(violation, 0.0) / null_part.squaredNorm();
    const double t = std::min(step, full);
    if (!blocked) {
      product(J_.rightCols(n - q_), null_part, z_);
      x_ += t * z_;
    }
    u_.head(q_) -= t * r_.head(q_);
    u_new += t;
    if (full <= step) {
      append(id, side);
      u_(q_ - 1) = u_new;
      sides[at(id)] = side;
      return SolveStatus::kSolved;
    }
    remove(leaving, sides);
  }
}

SolveStatus DualActiveSet::run(const QpProblem& p, const QpSettings& settings, double tolerance,
                               RowNoise& noise, Sides& sides, int& iterations) {
  for (;;) {
    Side side = kOff;
    const Index id = mostViolated(p, tolerance, noise, sides, side);
    if (id < 0) return SolveStatus::kSolved;
    const SolveStatus status = add(p, settings, noise, id, side, sides, iterations);
    if (status != SolveStatus::kSolved) return status;
  }
}

void DualActiveSet::multipliers(Index n, QpResult& result) const {
  result.y_x.setZero();
  result.y_a.setZero();
  for (Index k = 0; k < q_; ++k) {
    const double y = static_cast<double>(active_side_[at(k)]) * u_(k);
    const Index id = active_[at(k)];
    (id < n ? result.y_x(id) : result.y_a(id - n)) = y;
  }
}

}  // namespace fpc::qp
