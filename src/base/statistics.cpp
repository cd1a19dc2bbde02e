#include "base/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <limits>

namespace fpc {

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  const double part = place - static_cast<double>(below);
  if (part == 0.0 || values[below] == values[above]) return values[below];  // infinite ones too
  return values[below] + part * (values[above] - values[below]);
}

double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

double normalBound(double confidence) {
  return boost::math::quantile(boost::math::normal(), 0.5 * (1.0 + confidence));
}

double studentBound(double confidence, double freedom) {
  return boost::math::quantile(boost::math::students_t(freedom), 0.5 * (1.0 + confidence));
}

double binomialAtMost(std::size_t k, std::size_t n, double share) {
  return boost::math::cdf(boost::math::binomial(static_cast<double>(n), share),
                          static_cast<double>(k));
}

}  // namespace fpc
