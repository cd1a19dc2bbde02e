#include "identification/known_stretches.hpp"

namespace fpc {

std::vector<Stretch> knownStretches(const DataSet& data, Eigen::Index shortest) {
  std::vector<Stretch> found;
  Eigen::Index first = -1;
  for (Eigen::Index k = 0; k <= data.rows(); ++k) {
    const bool known = k < data.rows() && data.values.row(k).array().isFinite().any();
    if (known && first < 0) first = k;
    if (known || first < 0) continue;
    if (k - first >= shortest) found.push_back({first, k});
    first = -1;
  }
  return found;
}

}  // namespace fpc
