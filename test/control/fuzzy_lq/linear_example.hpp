// The two-input example of taieb2017, eqs. 4-5, and its weights of table 1.
#pragma once

#include <vector>

#include "control/fuzzy_lq/quadratic_law.hpp"

namespace fpc::test {

/// States x11, x12, x21, x22.
inline AffineModel linearExample() {
  AffineModel m(4, 2, 2);
  m.A.diagonal() << 0.9401, 0.9524, 0.9083, 0.9306;
  m.B << 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0;
  m.C << -0.7664, 0.9, 0.0, 0.0, 0.0, 0.0, -0.6055, 1.3472;
  return m;
}

inline Vector linearSetpoint() { return (Vector(2) << 6.1, 12.8).finished(); }

/// The four columns.
inline std::vector<QuadraticWeights> tableOne() {
  const double numbers[4][4] = {
      {1.0, 1.0, 1.0, 1.0}, {1.0, 1.0, 0.2, 0.2}, {1.0, 0.1, 1.0, 0.1}, {0.3, 0.3, 1.0, 0.1}};
  std::vector<QuadraticWeights> columns;
  for (const auto& n : numbers)
    columns.push_back({(Vector(2) << n[0], n[1]).finished(), Vector::Zero(2),
                       (Vector(2) << n[2], n[3]).finished()});
  return columns;
}

struct LinearRun {
  Vector overshoot_percent;  ///< of the setpoint, from rest at 0
  Vector error;              ///< at the end
};

/// The printed law, both inputs together, from rest at 0.
inline LinearRun runLinearExample(const QuadraticWeights& weights, const Vector& target,
                                  int samples) {
  const AffineModel m = linearExample();
  const QuadraticLaw law = makeQuadraticLaw(m, {}, weights);
  const Vector setpoint = linearSetpoint();
  Vector x = Vector::Zero(4), highest = Vector::Zero(2), y = highest;
  for (int k = 0; k < samples; ++k) {
    const Vector u = law.reference * setpoint - law.K * x + law.target * target;
    x = (m.A * x + m.B * u).eval();
    y = m.C * x;
    highest = highest.cwiseMax(y);
  }
  return {100.0 * (highest - setpoint).cwiseQuotient(setpoint), y - setpoint};
}

}  // namespace fpc::test
