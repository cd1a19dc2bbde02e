// Median, quantile, and what samples say against chance. The distributions are Boost.Math's.
#pragma once

#include <cstddef>
#include <vector>

namespace fpc {

/// Between the values at the places around share (n - 1) of the sorted ones, joined linearly;
/// share: 0 (smallest) to 1 (largest). NaN without values. Source: hyndman1996, type 7
double quantile(std::vector<double> values, double share);
double median(std::vector<double> values);  ///< quantile(values, 0.5)

/// z with P(|N(0, 1)| < z) = confidence, 0 <= confidence < 1.
double normalBound(double confidence);
/// t with P(|T| < t) = confidence for Student's T of `freedom` degrees, 0 <= confidence < 1.
double studentBound(double confidence, double freedom);
/// P(B <= k), B binomial(n, share).
double binomialAtMost(std::size_t k, std::size_t n, double share);

}  // namespace fpc
