#include "fmbpc/base/input_limits.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

void InputLimits::validate(Eigen::Index n_u) const {
  const std::string count = std::to_string(n_u) + " numbers";
  require(lower.size() == n_u, "actuator.input_lower", count);
  require(upper.size() == n_u, "actuator.input_upper", count);
  require(move.size() == n_u, "actuator.move_upper", count);
  for (Eigen::Index i = 0; i < n_u; ++i) {
    require(std::isfinite(lower[i]), "actuator.input_lower", "finite numbers");
    require(std::isfinite(upper[i]), "actuator.input_upper", "finite numbers");
    require(lower[i] <= upper[i], "actuator.input_upper", "numbers not below input_lower");
    require(move[i] > 0.0, "actuator.move_upper", "numbers > 0");
  }
}

bool InputLimits::clip(Eigen::Ref<Vector> input, VectorRef previous) const {
  bool move_gave_way = false;
  for (Eigen::Index i = 0; i < input.size(); ++i) {
    if (std::isnan(input[i])) input[i] = std::isnan(previous[i]) ? lower[i] : previous[i];
    const double from = previous[i] - move[i], to = previous[i] + move[i];
    input[i] = std::clamp(std::clamp(input[i], from, to), lower[i], upper[i]);
    move_gave_way = move_gave_way || input[i] < from || input[i] > to;
  }
  return move_gave_way;
}

}  // namespace fpc
