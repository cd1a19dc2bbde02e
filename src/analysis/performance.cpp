#include "fmbpc/analysis/performance.hpp"

#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kMoved = 1e-9;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

OutputIndices outputIndices(VectorRef y, VectorRef setpoint, VectorRef reference,
                            double sample_time_h) {
  require(setpoint.size() == y.size(), "setpoint", "as many samples as y");
  require(reference.size() == y.size(), "reference", "as many samples as y");
  require(std::isfinite(sample_time_h) && sample_time_h > 0.0, "sample_time_h", "a number > 0");
  OutputIndices sums;
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    const double e = setpoint[k] - y[k];
    const double e_reference = reference[k] - y[k];
    const double t = static_cast<double>(k) * sample_time_h;
    sums.ise += e * e;
    sums.iae += std::abs(e);
    sums.itae += t * std::abs(e);
    sums.itse += t * e * e;
    sums.ise_reference += e_reference * e_reference;
  }
  if (y.size() > 0) sums.rmse = std::sqrt(sums.ise / static_cast<double>(y.size()));
  return sums;
}

InputIndices inputIndices(VectorRef applied, double before) {
  InputIndices result;
  result.min = result.max = before;
  if (applied.size() == 0) return result;
  result.min = applied.hasNaN() ? kNan : applied.minCoeff();
  result.max = applied.hasNaN() ? kNan : applied.maxCoeff();
  for (Eigen::Index k = 0; k < applied.size(); ++k) {
    const double move = std::abs(applied[k] - (k == 0 ? before : applied[k - 1]));
    result.travel += move;
    result.effort += move * move;
    result.energy += applied[k] * applied[k];
    result.switches += move > kMoved;
  }
  result.mean_abs_move = result.travel / static_cast<double>(applied.size());
  return result;
}

}  // namespace fpc
