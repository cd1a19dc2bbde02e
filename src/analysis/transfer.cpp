#include "analysis/transfer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

/// Coefficients 1, a_1 .. a_n of det(z I - A), Faddeev and LeVerrier.
Vector characteristic(MatrixRef A) {
  const Eigen::Index n = A.rows();
  Vector a = Vector::Zero(n + 1);
  a[0] = 1.0;
  Matrix M = Matrix::Identity(n, n);
  for (Eigen::Index k = 1; k <= n; ++k) {
    const Matrix AM = A * M;
    a[k] = -AM.trace() / static_cast<double>(k);
    M = AM + a[k] * Matrix::Identity(n, n);
  }
  return a;
}

Eigenvalues rootsOf(VectorRef polynomial) {
  const Eigen::Index n = polynomial.size() - 1;
  if (n < 1) return {};
  Matrix companion = Matrix::Zero(n, n);
  companion.diagonal(-1).setOnes();
  companion.row(0) = -polynomial.tail(n).transpose() / polynomial[0];
  return eigenvalues(companion);
}

/// Largest distance after each value of `a` took its nearest of `b`.
double distance(const Eigenvalues& a, Eigenvalues b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (const auto& value : a) {
    const auto nearest = std::min_element(b.begin(), b.end(), [&](const auto& p, const auto& q) {
      return std::abs(p - value) < std::abs(q - value);
    });
    largest = std::max(largest, std::abs(*nearest - value));
    b.erase(nearest);
  }
  return largest;
}

}  // namespace

Transfer transferOf(const AffineModel& model, Eigen::Index input, Eigen::Index output) {
  require(input >= 0 && input < model.B.cols(), "input", "an input of the model");
  require(output >= 0 && output < model.C.rows(), "output", "an output of the model");
  const Eigen::Index n = model.A.rows();
  Transfer transfer;
  transfer.poles = eigenvalues(model.A);
  Vector markov = Vector::Zero(n);
  Eigen::RowVectorXd row = model.C.row(output);
  for (Eigen::Index i = 0; i < n; ++i) {
    markov[i] = row.dot(model.B.col(input));
    if (markov[i] != 0.0 && transfer.relative_degree == 0)
      transfer.relative_degree = static_cast<int>(i) + 1;
    row = (row * model.A).eval();
  }
  if (transfer.relative_degree == 0) return transfer;
  const Vector a = characteristic(model.A);
  transfer.numerator = Vector::Zero(n - transfer.relative_degree + 1);
  for (Eigen::Index j = transfer.relative_degree; j <= n; ++j)
    for (Eigen::Index i = 0; i < j; ++i)
      transfer.numerator[j - transfer.relative_degree] += a[i] * markov[j - 1 - i];
  transfer.zeros = rootsOf(transfer.numerator);
  return transfer;
}

int smallestStableHorizon(const LinearModel& model, LoopLaw law, int limit) {
  int smallest = 0;
  for (int H = limit; H >= 1; --H) {
    law.coincidence_steps = H;
    const ClosedLoop loop = closeLoop(model, law);
    if (!loop.applicable || !(spectralRadius(loop.values) < 1.0)) break;
    smallest = H;
  }
  return smallest;
}

Propositions checkPropositions(const LinearModel& model, int long_horizon) {
  const Transfer transfer = transferOf(model.affine, 0, model.affine.C.rows() - 1);
  Propositions found;
  found.relative_degree = transfer.relative_degree;
  for (int H = 1; H < transfer.relative_degree; ++H)
    found.gain_below = std::max(found.gain_below, std::abs(forcedGain(model, H)));
  Eigenvalues expected = transfer.zeros;
  expected.resize(transfer.poles.size(), {0.0, 0.0});
  LoopLaw law;
  law.coincidence_steps = std::max(1, transfer.relative_degree);
  found.zeros_distance = distance(closeLoop(model, law).values, expected);
  law.coincidence_steps = long_horizon;
  found.poles_distance = distance(closeLoop(model, law).values, transfer.poles);
  return found;
}

LinearModel canonicalRule(double a1, double a2, double b) {
  LinearModel model{AffineModel(2, 1, 1), Matrix::Zero(1, 2)};
  model.affine.A << 0.0, 1.0, -a2, -a1;
  model.affine.B << 0.0, 1.0;
  model.affine.C << b, 0.0;
  return model;
}

}  // namespace fpc
