#include "fmbpc/model/multivariate_membership.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/decompositions.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kAsymmetry = 1e-12;          // relative, of an entry that should equal another
constexpr double kNegativeEigenvalue = 1e-9;  // of S with a unit diagonal

/// f^2 (z - c)' S (z - c). What is below the rounding error of the sum is 0, so that a direction
/// without weight has none far away either.
double quadraticForm(const MultivariateMembership& set, VectorRef z, double f) {
  const Index n = set.center.size();
  double sum = 0.0, size = 0.0;
  for (Index i = 0; i < n; ++i) {
    const double away = f * z[i] - f * set.center[i];
    double row = 0.5 * set.inverse_covariance(i, i) * away, row_size = std::abs(row);
    for (Index j = 0; j < i; ++j) {
      const double term = set.inverse_covariance(i, j) * (f * z[j] - f * set.center[j]);
      row += term;
      row_size += std::abs(term);
    }
    sum += 2.0 * away * row;
    size += 2.0 * std::abs(away) * row_size;
  }
  if (!std::isfinite(size)) return std::numeric_limits<double>::infinity();
  const double rounding =
      static_cast<double>(2 * n) * std::numeric_limits<double>::epsilon() * size;
  return sum <= rounding ? 0.0 : sum;
}

/// S in units in which its diagonal is 1 (0 where it is 0).
Matrix withUnitDiagonal(const Matrix& S) {
  const Vector root = S.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Vector scale = root.unaryExpr([](double r) { return r > 0.0 ? 1.0 / r : 0.0; });
  return scale.asDiagonal() * S * scale.asDiagonal();
}

bool isSymmetric(const Matrix& S) {
  for (Index i = 0; i < S.rows(); ++i)
    for (Index j = 0; j < i; ++j)
      if (std::abs(S(i, j) - S(j, i)) > kAsymmetry * std::max(std::abs(S(i, j)), std::abs(S(j, i))))
        return false;
  return true;
}

bool isSemidefinite(const Matrix& S) {
  if ((S.diagonal().array() < 0.0).any()) return false;
  for (Index i = 0; i < S.rows(); ++i)
    if (S(i, i) == 0.0 && (S.row(i).array() != 0.0).any()) return false;
  const Matrix scaled = withUnitDiagonal(S);
  const Vector values = symmetricEigenOf(scaled, Eigen::EigenvaluesOnly).eigenvalues();
  return values.minCoeff() >= -kNegativeEigenvalue * static_cast<double>(S.rows());
}

}  // namespace

double MultivariateMembership::logDegree(VectorRef z) const {
  const double form = quadraticForm(*this, z, 1.0);
  return std::isfinite(form) ? -0.5 * form : -std::numeric_limits<double>::infinity();
}

double MultivariateMembership::logSlope(VectorRef z, Index variable) const {
  double slope = 0.0;
  for (Index i = 0; i < center.size(); ++i)
    slope -= inverse_covariance(variable, i) * (z[i] - center[i]);
  return std::isfinite(slope) && std::isfinite(logDegree(z)) ? slope : 0.0;
}

double MultivariateMembership::distance(VectorRef z) const {
  const double size = std::max(z.cwiseAbs().maxCoeff(), center.cwiseAbs().maxCoeff());
  if (!(size > 0.0)) return 0.0;
  return std::sqrt(quadraticForm(*this, z, 1.0 / size)) * size;
}

double MultivariateMembership::projectedPrecision(Index variable) const {
  const Index n = center.size();
  const double own = inverse_covariance(variable, variable);
  if (n == 1 || own <= 0.0) return own;
  // Schur complement; in units of a unit diagonal the eigenvalues of the rest can be compared.
  Matrix S = withUnitDiagonal(inverse_covariance);
  S.row(variable).swap(S.row(n - 1));
  S.col(variable).swap(S.col(n - 1));
  const Eigen::SelfAdjointEigenSolver<Matrix> rest =
      symmetricEigenOf(S.topLeftCorner(n - 1, n - 1));
  const Vector shadow = rest.eigenvectors().transpose() * S.col(n - 1).head(n - 1);
  double left = S(n - 1, n - 1);
  for (Index i = 0; i + 1 < n; ++i)
    if (rest.eigenvalues()[i] > kNegativeEigenvalue)
      left -= shadow[i] * shadow[i] / rest.eigenvalues()[i];
  return own * std::max(left, 0.0);
}

void MultivariateMembership::validate(const std::string& where, Index n_a) const {
  const std::string size = std::to_string(n_a);
  require(n_a > 0, where, "no multivariate membership where there is no antecedent");
  require(center.size() == n_a, where + ".center", size + " numbers");
  require(inverse_covariance.rows() == n_a && inverse_covariance.cols() == n_a,
          where + ".inverse_covariance", size + " x " + size + " numbers");
  require(center.allFinite(), where + ".center", "finite numbers");
  require(inverse_covariance.allFinite(), where + ".inverse_covariance", "finite numbers");
  require(isSymmetric(inverse_covariance), where + ".inverse_covariance", "a symmetric matrix");
  require(isSemidefinite(inverse_covariance), where + ".inverse_covariance",
          "a matrix without negative eigenvalues");
}

bool MultivariateMembership::operator==(const MultivariateMembership& other) const {
  return center.size() == other.center.size() && center == other.center &&
         inverse_covariance.rows() == other.inverse_covariance.rows() &&
         inverse_covariance.cols() == other.inverse_covariance.cols() &&
         inverse_covariance == other.inverse_covariance;
}

}  // namespace fpc
