#include "plant/state_range.hpp"

#include "fmbpc/base/text.hpp"

namespace fpc {

std::string outsideRange(const std::vector<Quantity>& states, Eigen::Index count, VectorRef x,
                         double tolerance) {
  for (Eigen::Index i = 0; i < count; ++i) {
    const Quantity& q = states[static_cast<std::size_t>(i)];
    if (x[i] >= q.lower - tolerance && x[i] <= q.upper + tolerance) continue;
    return q.name + " = " + shortText(x[i]) + " " + q.unit + ", its range is " +
           exactText(q.lower) + " to " + exactText(q.upper);
  }
  return "";
}

}  // namespace fpc
