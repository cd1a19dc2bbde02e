// The curve f(x, p) = 0 in scaled coordinates z = (x / size, p / size): tangents, correction, what
// lies at a point. Source:
// keller1977.
#pragma once

#include "analysis/continuation.hpp"

namespace fpc {

/// A point of the curve with its unit tangent and stability.
struct TracedPoint {
  Vector z, tangent;  ///< n_x + 1
  BranchPoint at;
};

class Curve {
 public:
  Curve(const ContinuationProblem& problem, const ContinuationParams& params);

  /// The point of the curve at x, p with a tangent along `direction` (n_x + 1, any length).
  bool pointAt(VectorRef x, double parameter, VectorRef direction, TracedPoint& point) const;
  /// One step of arc length `step` (either sign) from a point. False if Newton fails, the curve
  /// turns too sharply or the field cannot be evaluated.
  bool step(const TracedPoint& from, double step, TracedPoint& to) const;
  Eigen::Index size() const { return sizes_.size() - 1; }  ///< n_x
  Vector scaled(VectorRef x, double parameter) const;
  const Vector& sizes() const { return sizes_; }

 private:
  bool evaluate(const Vector& z, Vector& f) const;
  bool computeJacobian(const Vector& z, Matrix& J) const;
  bool correct(const Vector& predicted, const Vector& tangent, Vector& z) const;
  bool complete(const Vector& z, VectorRef direction, TracedPoint& point) const;

  const ContinuationProblem& problem_;
  Vector sizes_;
};

/// What changes between two neighbouring points, refined by bisection and added to `found`.
void findSpecialPoints(const Curve& curve, const TracedPoint& from, double step,
                       const TracedPoint& to, bool map, std::vector<SpecialPoint>& found);

}  // namespace fpc
