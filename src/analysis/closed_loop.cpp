#include "analysis/closed_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/decompositions.hpp"
#include "control/fmbpc/coincidence.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {

Eigenvalues eigenvalues(MatrixRef A) {
  require(A.rows() == A.cols(), "A", "a square matrix");
  if (!A.allFinite())
    return Eigenvalues(static_cast<std::size_t>(A.rows()),
                       {std::numeric_limits<double>::quiet_NaN(), 0.0});
  if (A.rows() == 0) return {};
  const Eigen::VectorXcd found = eigenOf(A).eigenvalues();
  Eigenvalues values(found.data(), found.data() + found.size());
  std::sort(values.begin(), values.end(), [](const auto& a, const auto& b) {
    if (std::abs(a) != std::abs(b)) return std::abs(a) > std::abs(b);
    return a.imag() != b.imag() ? a.imag() > b.imag() : a.real() > b.real();
  });
  return values;
}

double spectralRadius(const Eigenvalues& values) {
  double radius = 0.0;
  for (const auto& value : values) {
    if (!std::isfinite(std::abs(value))) return std::numeric_limits<double>::quiet_NaN();
    radius = std::max(radius, std::abs(value));
  }
  return radius;
}

ClosedLoop closeLoop(const LinearModel& model, const LoopLaw& law) {
  const AffineModel& m = model.affine;
  require(law.coincidence_steps >= 1, "coincidence_steps", "an integer >= 1");
  CoincidenceGains gains(m.A.rows(), m.B.cols(), m.C.rows());
  ClosedLoop loop;
  if (law.published) {
    loop.applicable = gains.computePublished(m, law.coincidence_steps);
  } else {
    require(law.weight_output.size() == m.C.rows(), "weight_output", "one weight per output");
    require(law.weight_move.size() == m.B.cols(), "weight_move", "one weight per input");
    loop.applicable =
        gains.computeWeighted(m, law.coincidence_steps, law.weight_output, law.weight_move);
  }
  if (!loop.applicable) return loop;
  loop.F = gains.gain();
  loop.K = gains.gain() * gains.free() - gains.moveGain() * model.previous_input;
  loop.B = m.B;
  loop.A = m.A - m.B * loop.K;
  loop.values = eigenvalues(loop.A);
  return loop;
}

double forcedGain(const LinearModel& model, int horizon) {
  require(horizon >= 1, "coincidence_steps", "an integer >= 1");
  const AffineModel& m = model.affine;
  Eigen::RowVectorXd row = m.C.bottomRows(1);
  double gain = 0.0;
  for (int i = 0; i < horizon; ++i) {
    gain += row.dot(m.B.col(0));
    row = row * m.A;
  }
  return gain;
}

}  // namespace fpc
