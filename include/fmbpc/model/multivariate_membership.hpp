// A fuzzy set on all antecedent variables at once: an ellipsoid of any direction, evaluated in the
// log domain. Source: babuska1998, sec. 4.4.
#pragma once

#include <string>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// mu(z) = exp(-(z - c)' S (z - c) / 2), S symmetric and positive semidefinite. A row of zeros is a
/// variable that does not matter; with S = 0 the membership is 1 everywhere.
struct MultivariateMembership {
  Vector center;              ///< c, in the units of the n_a antecedent variables
  Matrix inverse_covariance;  ///< S (n_a x n_a), in inverse products of those units

  /// log(mu(z)) <= 0, -inf where it is too far to tell. Never NaN for finite z. No allocation.
  double logDegree(VectorRef z) const;
  /// d log(mu) / dz of one variable, 0 where mu is 0. No allocation.
  double logSlope(VectorRef z, Eigen::Index variable) const;
  /// Mahalanobis distance to the centre, finite wherever it is a number at all: orders rules when
  /// none fires. No allocation.
  double distance(VectorRef z) const;
  /// p of the projection on one variable: its highest degree over all values of the others is
  /// exp(-p (z - c)^2 / 2). 0 if the variable does not matter.
  double projectedPrecision(Eigen::Index variable) const;
  /// @throws InputError naming `where`: sizes other than n_a, numbers that are not finite, an S
  /// that is not symmetric or has a negative eigenvalue beyond rounding.
  void validate(const std::string& where, Eigen::Index n_a) const;
  bool operator==(const MultivariateMembership& other) const;
};

}  // namespace fpc
