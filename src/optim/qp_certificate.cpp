// Farkas certificates of infeasibility: made from the combination of active normals that a
// contradictory constraint depends on, and judged with all rounding counted against them.
#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "optim/qp_sizes.hpp"
#include "optim/qp_workspace.hpp"

namespace fpc {
namespace {

using qp::Index;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// Adds y's part of sum y+ lower + y- upper, and its size.
void addSupport(double y, double lower, double upper, double& support, double& size) {
  if (y == 0.0) return;
  const double part = y * (y > 0.0 ? lower : upper);
  support += part;
  size += std::abs(part);
}

double radiusOf(const QpProblem& p, VectorRef y_x, VectorRef y_a) {
  const Index n = p.g.size(), m = p.a_lower.size();
  double support = 0.0, size = 0.0, error = 0.0;
  for (Index i = 0; i < n; ++i) addSupport(y_x(i), p.x_lower(i), p.x_upper(i), support, size);
  for (Index i = 0; i < m; ++i) addSupport(y_a(i), p.a_lower(i), p.a_upper(i), support, size);
  for (Index j = 0; j < n; ++j) {
    double sum = y_x(j), terms = std::abs(sum);
    Index count = 1;
    for (Index i = 0; i < m; ++i) {
      const double term = p.A(i, j) * y_a(i);
      if (term == 0.0) continue;
      sum += term;
      terms += std::abs(term);
      ++count;
    }
    if (count > 1)
      error += std::abs(sum) + static_cast<double>(count) * kEpsilon * terms;
    else
      error += std::abs(sum);
  }
  support -= static_cast<double>(n + m) * kEpsilon * size;
  if (!std::isfinite(support) || !(support > 0.0) || !std::isfinite(error)) return 0.0;
  return error > 0.0 ? support / error : kInfinity;
}

}  // namespace

double farkasRadius(const QpProblem& problem, VectorRef y_x, VectorRef y_a) {
  require(y_x.size() == problem.g.size() && y_a.size() == problem.a_lower.size(), "farkasRadius",
          "y_x of size n and y_a of size m");
  qp::ScaledProblem scaled;
  scaled.resize(y_x.size(), y_a.size());
  if (!scaled.scale(problem)) return radiusOf(problem, y_x, y_a);
  return radiusOf(scaled.problem(), y_x.cwiseProduct(scaled.size()), y_a);
}

namespace qp {
namespace {

constexpr int kCorrections = 2;
constexpr double kLeastRadius = 100.0;  // of 1 + |x|: what a proof of infeasibility must exclude

}  // namespace

/// normal = sum_k r_k (active normal k): the multipliers -r_k, refined, into proof_x_ and proof_a_.
void DualActiveSet::combineActive() {
  const Index n = x_.size();
  for (Index k = 0; k < q_; ++k) {
    const Index id = active_[at(k)];
    const double y = -static_cast<double>(active_side_[at(k)]) * r_(k);
    (id < n ? proof_x_(id) : proof_a_(id - n)) = y;
  }
}

/// Where x_j has a limit on the side that is needed, an error in e = y_x + A'y_a goes into y_x.
void DualActiveSet::absorbIntoBounds(const QpProblem& p) {
  for (Index j = 0; j < x_.size(); ++j) {
    const double y = proof_x_(j) - proof_error_(j);
    if (y == 0.0 || std::isfinite(y > 0.0 ? p.x_lower(j) : p.x_upper(j))) proof_x_(j) = y;
  }
}

/// Constraint id cannot be satisfied with the working set: is there a proof?
SolveStatus DualActiveSet::contradiction(const QpProblem& p, Index id, Side side) {
  const Index n = x_.size(), m = p.a_lower.size();
  culprit_ = id;
  for (Index k = 0; k < q_; ++k) {
    if (r_(k) > 0.0 && !isEquality(p, active_[at(k)])) r_(k) = 0.0;  // rounding
  }
  for (int k = 0;; ++k) {
    proof_x_.setZero();
    proof_a_.setZero();
    combineActive();
    (id < n ? proof_x_(id) : proof_a_(id - n)) = static_cast<double>(side);
    proof_error_ = proof_x_;
    if (m > 0) proof_error_.noalias() += p.A.transpose() * proof_a_;
    if (k == kCorrections || q_ == 0) break;
    d_.noalias() = J_.transpose() * proof_error_;
    auto correction = d_.head(q_);
    R_.topLeftCorner(q_, q_).triangularView<Eigen::Upper>().solveInPlace(correction);
    for (Index i = 0; i < q_; ++i) {
      const double r = r_(i) + correction(i);
      if (r <= 0.0 || isEquality(p, active_[at(i)])) r_(i) = r;
    }
  }
  absorbIntoBounds(p);
  const double needed = kLeastRadius * (1.0 + x_.lpNorm<Eigen::Infinity>());
  return radiusOf(p, proof_x_, proof_a_) >= needed ? SolveStatus::kInfeasible
                                                   : SolveStatus::kNumericalError;
}

void DualActiveSet::certificate(QpResult& result) const {
  result.y_x = proof_x_;
  result.y_a = proof_a_;
}

}  // namespace qp
}  // namespace fpc
