// The factors of the dual active-set method: J and R with J'N = [R; 0] and J'H J = I (goldfarb1983,
// section 4). A bound's normal is a unit vector, so its transform is a row of J.
// Constraints enter by a Householder reflection of the null-space columns (the step z is half of
// the product that it needs) and leave by Givens rotations.
#include <cmath>

#include "optim/qp_kernels.hpp"
#include "optim/qp_workspace.hpp"

namespace fpc::qp {
void DualActiveSet::setNormal(const QpProblem& p, Index id, Side side) {
  if (id >= p.g.size()) normal_ = static_cast<double>(side) * p.A.row(id - p.g.size()).transpose();
}

/// d = J' normal
void DualActiveSet::transformNormal(Index id, Side side) {
  if (id < x_.size()) {
    d_ = static_cast<double>(side) * J_.row(id).transpose();
  } else {
    transposedProduct(J_, normal_, d_);
  }
}

/// Whether the sine of the angle of d to the working set, in the metric of H^-1, is that small.
bool DualActiveSet::dependent(double tolerance) const {
  const Index n = d_.size();
  return q_ == n || !(d_.tail(n - q_).norm() > tolerance * d_.norm());
}

/// J and R of the bounds in the working set: with fixed unknowns last in L, L^-T read backwards has
/// them first.
void DualActiveSet::seed(const QpProblem& p, const KktSystem& kkt, const Sides& sides) {
  const Index n = p.g.size();
  const Matrix& L = kkt.cholesky();
  if (kkt.diagonal()) {
    J_.setZero();
    for (Index j = 0; j < n; ++j) J_(kkt.order()[at(j)], n - 1 - j) = 1.0 / L(j, j);
  } else {
    Matrix& inverse = R_;  // L^-T, upper triangular, for the moment
    inverseTransposed(L.data(), n, inverse.data());
    for (Index j = 0; j < n; ++j) {
      double* column = J_.data() + (n - 1 - j) * n;
      for (Index i = 0; i < n; ++i) column[kkt.order()[at(i)]] = inverse(i, j);
    }
  }
  q_ = 0;
  for (Index j = n; j-- > kkt.freeCount();) {
    const Index i = kkt.order()[at(j)];
    active_[at(q_)] = i;
    active_side_[at(q_)] = sides[at(i)];
    ++q_;
  }
  for (Index k = 0; k < q_; ++k) {
    R_.col(k).head(k + 1) =
        static_cast<double>(active_side_[at(k)]) * J_.row(active_[at(k)]).head(k + 1).transpose();
  }
}

/// x and u of the working set: R'c = b, x = J_1 c - J_2 J_2'g, R u = c + J_1'g.
void DualActiveSet::minimise(const QpProblem& p, const Vector& g) {
  const Index n = p.g.size();
  for (Index k = 0; k < q_; ++k) {
    c_(k) =
        static_cast<double>(active_side_[at(k)]) * limitOf(p, active_[at(k)], active_side_[at(k)]);
  }
  transposedProduct(J_, g, d_);
  c_.tail(n - q_) = -d_.tail(n - q_);
  if (q_ > 0) {
    const auto R = R_.topLeftCorner(q_, q_).triangularView<Eigen::Upper>();
    auto c = c_.head(q_);
    auto u = u_.head(q_);
    R.transpose().solveInPlace(c);
    u = c + d_.head(q_);
    R.solveInPlace(u);
  }
  product(J_, c_, x_);
}

/// Takes the constraint with transform d and step z into the working set.
void DualActiveSet::append(Index id, Side side) {
  const Index n = x_.size(), null_size = n - q_;
  auto v = d_.tail(null_size);
  const double norm = v.norm();
  const double alpha = v(0) > 0.0 ? -norm : norm;
  R_.col(q_).head(q_) = d_.head(q_);
  R_(q_, q_) = alpha;
  const double beta = 1.0 / (norm * (norm + std::abs(v(0))));
  c_ = beta * (z_ - alpha * J_.col(q_));  // beta J_2 v
  v(0) -= alpha;
  subtractOuter(c_.data(), n, v.data(), null_size, J_.data() + q_ * n, n);
  active_[at(q_)] = id;
  active_side_[at(q_)] = side;
  ++q_;
}

void DualActiveSet::remove(Index k, Sides& sides) {
  sides[at(active_[at(k)])] = kOff;
  for (Index j = k; j + 1 < q_; ++j) {
    R_.col(j).head(j + 2) = R_.col(j + 1).head(j + 2);
    active_[at(j)] = active_[at(j + 1)];
    active_side_[at(j)] = active_side_[at(j + 1)];
    u_(j) = u_(j + 1);
  }
  --q_;
  const Index n = x_.size();
  for (Index j = k; j < q_; ++j) {
    const double norm = std::hypot(R_(j, j), R_(j + 1, j));
    const double c = R_(j, j) / norm, s = R_(j + 1, j) / norm;
    R_(j, j) = norm;
    R_(j + 1, j) = 0.0;
    for (Index l = j + 1; l < q_; ++l) {
      const double a = R_(j, l), b = R_(j + 1, l);
      R_(j, l) = c * a + s * b;
      R_(j + 1, l) = c * b - s * a;
    }
    rotate(J_.data() + j * n, J_.data() + (j + 1) * n, n, c, s);
  }
}

}  // namespace fpc::qp
