// Series with holes: runs of numbers between NaN, and simple figures of what is there.
#pragma once

#include <cmath>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

struct FiniteRun {
  Eigen::Index first{}, count{};
};

inline std::vector<FiniteRun> finiteRuns(const std::vector<double>& values) {
  std::vector<FiniteRun> all;
  bool open = false;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const bool is = std::isfinite(values[k]);
    if (is && !open) all.push_back({static_cast<Eigen::Index>(k), 0});
    if (is) ++all.back().count;
    open = is;
  }
  return all;
}

/// The numbers among them.
inline std::vector<double> finiteOnly(const std::vector<double>& values) {
  std::vector<double> some;
  for (const double v : values)
    if (std::isfinite(v)) some.push_back(v);
  return some;
}

/// Of the numbers among them; NaN without any.
inline double meanOf(const std::vector<double>& values) {
  double sum = 0.0, count = 0.0;
  for (const double v : values)
    if (std::isfinite(v)) {
      sum += v;
      count += 1.0;
    }
  return count > 0.0 ? sum / count : kNaN;
}

inline double stdOf(const std::vector<double>& values) {
  const double mean = meanOf(values);
  double sum = 0.0, count = 0.0;
  for (const double v : values)
    if (std::isfinite(v)) {
      sum += (v - mean) * (v - mean);
      count += 1.0;
    }
  return count > 1.0 ? std::sqrt(sum / (count - 1.0)) : kNaN;
}

/// Means of `factor` values each; NaN where one of them is. The rest at the end is left out.
inline std::vector<double> blockMeans(const std::vector<double>& values, Eigen::Index factor) {
  if (factor <= 1) return values;
  std::vector<double> means(values.size() / static_cast<std::size_t>(factor));
  for (std::size_t i = 0; i < means.size(); ++i) {
    double sum = 0.0;
    for (Eigen::Index j = 0; j < factor; ++j)
      sum += values[i * static_cast<std::size_t>(factor) + static_cast<std::size_t>(j)];
    means[i] = sum / static_cast<double>(factor);
  }
  return means;
}

}  // namespace fpc
