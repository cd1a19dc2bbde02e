#include "analysis/performance.hpp"

#include "analysis/running_indices.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {

OutputIndices outputIndices(VectorRef y, VectorRef setpoint, VectorRef reference,
                            double sample_time_h) {
  require(setpoint.size() == y.size(), "setpoint", "as many samples as y");
  require(reference.size() == y.size(), "reference", "as many samples as y");
  RunningOutput running(sample_time_h);
  for (Eigen::Index k = 0; k < y.size(); ++k) running.add(y[k], setpoint[k], reference[k]);
  return running.indices();
}

InputIndices inputIndices(VectorRef applied, double before) {
  RunningInput running(before);
  for (Eigen::Index k = 0; k < applied.size(); ++k) running.add(applied[k]);
  return running.indices();
}

}  // namespace fpc
