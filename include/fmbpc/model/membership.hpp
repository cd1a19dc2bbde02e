// One-dimensional fuzzy sets, evaluated in the log domain so that far tails never underflow to an
// empty rule base.
#pragma once

#include <string>
#include <vector>

namespace fpc {

enum class MembershipShape {
  kExponential,  ///< p1..p4: exp(-7((z-p2)/(p2-p1))^2) below p2, 1 on [p2,p3],
                 ///< exp(-7((z-p3)/(p4-p3))^2) above
  kGaussian,     ///< p1 centre, p2 width: exp(-(z-p1)^2 / (2 p2^2))
  kTriangular,   ///< p1..p3: feet and top; outside: 0
  kTrapezoidal,  ///< p1..p4: feet and shoulders
};

/// Names as in model files: exponential, gaussian, triangular, trapezoidal.
MembershipShape membershipShape(
    const std::string& name);  ///< @throws InputError with the known names
const std::string& name(MembershipShape shape);
std::size_t parameterCount(MembershipShape shape);

/// A fuzzy set on one variable. Zero widths are crisp edges.
struct Membership {
  MembershipShape shape{MembershipShape::kExponential};
  std::vector<double> parameters;

  /// log(mu(z)), -inf where mu is 0. Never NaN for finite z.
  double logDegree(double z) const;
  /// d log(mu) / dz, from the right at a corner; 0 where mu is 0 or an edge is crisp.
  double logSlope(double z) const;
  /// How far z lies outside the support [in widths of the set, or in units for crisp ones]; 0
  /// inside. Orders rules when none fires.
  double distance(double z) const;
  /// @throws InputError naming `where`: parameter count, order, finiteness, width > 0 for gaussian.
  void validate(const std::string& where) const;
  bool operator==(const Membership& other) const;
};

}  // namespace fpc
