// Membership functions in the log domain. Source of the exponential shape: the tables A1 and A2 of
// vallejo2021thesis, read as left foot, left shoulder, right shoulder, right foot.
#include "fmbpc/model/membership.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {
namespace {

constexpr double kOutside = -kInfinity;
constexpr double kFootDecay = 7.0;  // mu = exp(-7) at the feet of the exponential shape
constexpr double kGaussianSupport =
    3.0;  // [widths] where a bell counts as ended, for distances only

const std::vector<std::string>& shapeNames() {
  static const std::vector<std::string> names{"exponential", "gaussian", "triangular",
                                              "trapezoidal"};
  return names;
}

/// Logarithm of a flank that is 1 at `shoulder` and has its foot `width` away; `beyond` is the way
/// past the shoulder.
double exponentialFlank(double beyond, double width) {
  if (beyond <= 0.0) return 0.0;
  if (width <= 0.0) return kOutside;
  const double ratio = beyond / width;
  return -kFootDecay * ratio * ratio;
}

double linearFlank(double beyond, double width) {
  if (beyond <= 0.0) return 0.0;
  return beyond < width ? std::log1p(-beyond / width) : kOutside;
}

/// Of the flanks' logarithms by `beyond`.
double exponentialSlope(double beyond, double width) {
  return beyond >= 0.0 && width > 0.0 ? -2.0 * kFootDecay * beyond / (width * width) : 0.0;
}
double linearSlope(double beyond, double width) {
  return beyond >= 0.0 && beyond < width ? -1.0 / (width - beyond) : 0.0;
}

/// Feet and shoulders of any shape (a bell ends at three widths).
std::array<double, 4> corners(MembershipShape shape, const std::vector<double>& p) {
  switch (shape) {
    case MembershipShape::kGaussian:
      return {p[0] - kGaussianSupport * p[1], p[0], p[0], p[0] + kGaussianSupport * p[1]};
    case MembershipShape::kTriangular:
      return {p[0], p[1], p[1], p[2]};
    default:
      return {p[0], p[1], p[2], p[3]};
  }
}

}  // namespace

MembershipShape membershipShape(const std::string& name) {
  const auto& names = shapeNames();
  const auto found = std::find(names.begin(), names.end(), name);
  require(found != names.end(), "membership '" + name + "'", "one of " + join(names));
  return static_cast<MembershipShape>(found - names.begin());
}

const std::string& name(MembershipShape shape) {
  return shapeNames()[static_cast<std::size_t>(shape)];
}

std::size_t parameterCount(MembershipShape shape) {
  switch (shape) {
    case MembershipShape::kGaussian:
      return 2;
    case MembershipShape::kTriangular:
      return 3;
    default:
      return 4;
  }
}

double Membership::logDegree(double z) const {
  if (shape == MembershipShape::kGaussian) {
    const double ratio = (z - parameters[0]) / parameters[1];
    return -0.5 * ratio * ratio;
  }
  const auto c = corners(shape, parameters);
  const bool left = z < c[1];
  const double beyond = left ? c[1] - z : z - c[2];
  const double width = left ? c[1] - c[0] : c[3] - c[2];
  return shape == MembershipShape::kExponential ? exponentialFlank(beyond, width)
                                                : linearFlank(beyond, width);
}

double Membership::logSlope(double z) const {
  if (shape == MembershipShape::kGaussian)
    return -(z - parameters[0]) / (parameters[1] * parameters[1]);
  const auto c = corners(shape, parameters);
  const bool left = z < c[1];
  const double beyond = left ? c[1] - z : z - c[2];
  const double width = left ? c[1] - c[0] : c[3] - c[2];
  const double slope = shape == MembershipShape::kExponential ? exponentialSlope(beyond, width)
                                                              : linearSlope(beyond, width);
  return left ? -slope : slope;
}

double Membership::distance(double z) const {
  const auto c = corners(shape, parameters);
  const double width = c[3] - c[0];
  const double outside = std::max({c[0] - z, z - c[3], 0.0});
  return width > 0.0 ? outside / width : outside;
}

void Membership::validate(const std::string& where) const {
  const std::size_t count = parameterCount(shape);
  require(parameters.size() == count, where,
          std::to_string(count) + " parameters for " + name(shape));
  for (const double p : parameters) require(std::isfinite(p), where, "finite parameters");
  if (shape == MembershipShape::kGaussian) {
    require(parameters[1] > 0.0, where, "a width > 0 as second parameter of gaussian");
    return;
  }
  require(std::is_sorted(parameters.begin(), parameters.end()), where,
          "parameters from left to right, none smaller than the one before");
  require(std::isfinite(parameters.back() - parameters.front()), where, "a set of finite width");
}

bool Membership::operator==(const Membership& other) const {
  return shape == other.shape && parameters == other.parameters;
}

}  // namespace fpc
