#include "analysis/curve.hpp"

#include <Eigen/LU>
#include <cmath>
#include <exception>

#include "analysis/linearise.hpp"
#include "base/decompositions.hpp"

namespace fpc {
namespace {

constexpr int kIterations = 12;
constexpr double kTolerance = 1e-11;   // of the last Newton step, in sizes
constexpr double kSharpestTurn = 0.9;  // cosine between neighbouring tangents
constexpr double kFarthest = 0.5;      // correction, in parts of the step

int countUnstable(const Eigenvalues& values, bool map) {
  int count = 0;
  for (const auto& value : values) count += map ? std::abs(value) > 1.0 : value.real() > 0.0;
  return count;
}

}  // namespace

Curve::Curve(const ContinuationProblem& problem, const ContinuationParams& params)
    : problem_(problem), sizes_(params.state_size.size() + 1) {
  sizes_.head(size()) = params.state_size;
  sizes_[size()] =
      params.parameter_size > 0.0 ? params.parameter_size : 0.1 * (params.upper - params.lower);
}

Vector Curve::scaled(VectorRef x, double parameter) const {
  Vector z(size() + 1);
  z << x, parameter;
  return z.cwiseQuotient(sizes_);
}

bool Curve::evaluate(const Vector& z, Vector& f) const {
  const Vector plain = z.cwiseProduct(sizes_);
  f.resize(size());
  try {
    problem_.field(plain.head(size()), plain[size()], f);
  } catch (const std::exception&) {
    return false;
  }
  return f.allFinite();
}

/// n_x (n_x + 1), rows scaled to a largest entry of 1.
bool Curve::computeJacobian(const Vector& z, Matrix& J) const {
  const VectorFunction f = [this](VectorRef point, Eigen::Ref<Vector> value) {
    Vector at(size());
    if (!evaluate(point, at)) at.setConstant(std::nan(""));
    value = at;
  };
  J = jacobian(f, z, size(), Vector::Ones(z.size()));
  return J.allFinite();
}

bool Curve::correct(const Vector& predicted, const Vector& tangent, Vector& z) const {
  Vector f;
  Matrix J, full(predicted.size(), predicted.size());
  Vector rest(predicted.size());
  z = predicted;
  for (int i = 0; i < kIterations; ++i) {
    if (!evaluate(z, f) || !computeJacobian(z, J)) return false;
    const Vector rows = J.cwiseAbs().rowwise().maxCoeff();
    if (rows.minCoeff() == 0.0) return false;
    full.topRows(size()) = rows.cwiseInverse().asDiagonal() * J;
    full.bottomRows(1) = tangent.transpose();
    rest.head(size()) = f.cwiseQuotient(rows);
    rest[size()] = tangent.dot(z - predicted);
    const Vector move = full.partialPivLu().solve(rest);
    if (!move.allFinite()) return false;
    z -= move;
    if (move.norm() <= kTolerance * std::max(1.0, z.norm())) return true;
  }
  return false;
}

bool Curve::complete(const Vector& z, VectorRef direction, TracedPoint& point) const {
  Matrix J;
  if (!computeJacobian(z, J)) return false;
  const Vector rows = J.cwiseAbs().rowwise().maxCoeff();
  if (rows.minCoeff() == 0.0) return false;
  J = (rows.cwiseInverse().asDiagonal() * J).eval();
  point.z = z;
  point.tangent = svdOf(J, Eigen::ComputeFullV).matrixV().col(size());
  if (point.tangent.dot(direction) < 0.0) point.tangent = -point.tangent;
  const Vector plain = z.cwiseProduct(sizes_);
  point.at.state = plain.head(size());
  point.at.parameter = plain[size()];
  Matrix A =
      rows.asDiagonal() * J.leftCols(size()) * sizes_.head(size()).cwiseInverse().asDiagonal();
  try {
    if (problem_.linearisation) A = problem_.linearisation(point.at.state, point.at.parameter);
  } catch (const std::exception&) {
    return false;
  }
  if (!A.allFinite()) return false;
  point.at.values = eigenvalues(A);
  point.at.unstable = countUnstable(point.at.values, problem_.map);
  return true;
}

bool Curve::pointAt(VectorRef x, double parameter, VectorRef direction, TracedPoint& point) const {
  const Vector z = scaled(x, parameter);
  if (!complete(z, direction, point)) return false;
  Vector corrected;
  if (!correct(z, point.tangent, corrected)) return false;
  return complete(corrected, direction, point);
}

bool Curve::step(const TracedPoint& from, double step, TracedPoint& to) const {
  const Vector predicted = from.z + step * from.tangent;
  Vector z(from.z.size());
  if (!correct(predicted, from.tangent, z)) return false;
  if ((z - predicted).norm() > kFarthest * std::abs(step) + kTolerance) return false;
  if (!complete(z, from.tangent, to)) return false;
  return to.tangent.dot(from.tangent) >= kSharpestTurn;
}

}  // namespace fpc
