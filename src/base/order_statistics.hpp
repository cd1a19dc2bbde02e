// Values by their rank: medians and quantiles that are values of the sample, never between two (as
// base/statistics.hpp joins them), found without sorting the rest.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace fpc {

/// The value that stands at `place` (from 0) once all are sorted. NaN counts as larger than every
/// number, infinity too: it is returned only where no number is left. NaN also where place is not
/// below the number of values, none included.
inline double orderStatistic(std::vector<double> values, std::size_t place) {
  if (place >= values.size()) return std::numeric_limits<double>::quiet_NaN();
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), at, values.end(),
                   [](double a, double b) { return a < b || (std::isnan(b) && !std::isnan(a)); });
  return *at;
}

/// The value at the place share (n - 1), rounded down; share: 0 (smallest) to 1 (largest). With
/// share 0.5 and an even number of values the lower one in the middle.
inline double sampleQuantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto place = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  return orderStatistic(std::move(values), place);
}

/// The value at the place n / 2, rounded down: of an even number the upper one in the middle.
inline double upperMedian(std::vector<double> values) {
  const std::size_t middle = values.size() / 2;
  return orderStatistic(std::move(values), middle);
}

}  // namespace fpc
