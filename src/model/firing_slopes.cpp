#include "model/firing_slopes.hpp"

namespace fpc {
namespace {

using Eigen::Index;

double logSlope(const Rule& rule, VectorRef z, Index variable) {
  if (rule.multivariate) return rule.multivariate->logSlope(z, variable);
  return rule.antecedents[static_cast<std::size_t>(variable)].logSlope(z[variable]);
}

}  // namespace

void firingSlopes(const OutputModel& model, VectorRef z, const FiringResult& firing,
                  Matrix& slopes) {
  slopes.setZero();
  if (!firing.fired) return;
  for (Index i = 0; i < slopes.cols(); ++i) {
    double mean = 0.0;
    for (Index r = 0; r < slopes.rows(); ++r) {
      const double weight = firing.weights[r];
      if (weight == 0.0) continue;  // its own slope may be of a set that has ended
      slopes(r, i) = logSlope(model.rules[static_cast<std::size_t>(r)], z, i);
      mean += weight * slopes(r, i);
    }
    for (Index r = 0; r < slopes.rows(); ++r)
      slopes(r, i) = firing.weights[r] * (slopes(r, i) - mean);
  }
}

}  // namespace fpc
