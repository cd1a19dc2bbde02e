// The answer of the dual active-set method, refined with its own factors: what is left of the KKT
// equations on the data as given is solved for by J and R (goldfarb1983, section 4) and added.
#include <cmath>
#include <limits>

#include "optim/qp_kernels.hpp"
#include "optim/qp_workspace.hpp"

namespace fpc::qp {
namespace {

constexpr int kMostRefinements = 3;
constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();

}  // namespace

/// Errors of the KKT equations, of the gradient into error_, of the working set into c_ (a bound's
/// is zero). @return whether they are down to rounding
bool DualActiveSet::refineErrors(const QpProblem& p, const KktSystem& kkt, QpResult& result,
                                 const Vector& Ax) {
  const Index n = x_.size();
  error_ = kkt.aty() - kkt.hx() - p.g;
  bool small = true;
  for (Index k = 0; k < q_; ++k) {
    const Index id = active_[at(k)];
    c_(k) = 0.0;
    if (id < n) {  // the multiplier of a bound is what is left of the gradient
      result.y_x(id) = -error_(id);
      error_(id) = 0.0;
      continue;
    }
    const double limit = limitOf(p, id, active_side_[at(k)]), error = limit - Ax(id - n);
    c_(k) = static_cast<double>(active_side_[at(k)]) * error;
    if (!small || std::abs(error) <= kRounding * std::abs(limit)) continue;
    double terms = std::abs(limit);
    for (Index j = 0; j < n; ++j) terms += std::abs(p.A(id - n, j) * result.x(j));
    small = std::abs(error) <= kRounding * terms;
  }
  const double largest = (kkt.hx().cwiseAbs() + p.g.cwiseAbs() + kkt.aty().cwiseAbs()).maxCoeff();
  return small && error_.lpNorm<Eigen::Infinity>() <= kRounding * largest;
}

/// H dx - N du = error, N'dx = c: R'b = c, dx = J [b; J_2'error], R du = b - J_1'error.
void DualActiveSet::refineStep(QpResult& result) {
  const Index n = x_.size();
  transposedProduct(J_, error_, d_);
  if (q_ > 0) {
    const auto R = R_.topLeftCorner(q_, q_).triangularView<Eigen::Upper>();
    auto b = c_.head(q_);
    R.transpose().solveInPlace(b);
    r_.head(q_) = b - d_.head(q_);
    auto du = r_.head(q_);
    R.solveInPlace(du);
    u_.head(q_) += du;
  }
  c_.tail(n - q_) = d_.tail(n - q_);
  addProduct(1.0, J_, c_, result.x);
  for (Index k = 0; k < q_; ++k) {
    if (active_[at(k)] >= n)
      result.y_a(active_[at(k)] - n) = static_cast<double>(active_side_[at(k)]) * u_(k);
  }
}

bool DualActiveSet::refine(const QpProblem& p, KktSystem& kkt, QpResult& result, Vector& Ax) {
  const Index n = x_.size();
  result.x = x_;
  multipliers(n, result);
  for (int correction = 0;; ++correction) {
    for (Index k = 0; k < q_; ++k) {
      const Index id = active_[at(k)];
      if (id < n) result.x(id) = limitOf(p, id, active_side_[at(k)]);
    }
    kkt.evaluate(p, result);
    if (p.a_lower.size() > 0) product(p.A, result.x, Ax);
    if (refineErrors(p, kkt, result, Ax)) return true;
    if (correction == kMostRefinements) return false;
    refineStep(result);
  }
}

}  // namespace fpc::qp
