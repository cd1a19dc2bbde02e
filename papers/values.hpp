// One figure, or the same of many runs: judged by the median, shown with the range.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace fpc::papers {

inline constexpr double kNotPrinted = std::numeric_limits<double>::quiet_NaN();

class Values {
 public:
  Values(double value) : all_{value} {}                            // NOLINT: a number is one value
  Values(std::vector<double> values) : all_{std::move(values)} {}  // NOLINT
  std::size_t count() const { return all_.size(); }
  double median() const;  ///< NaN if there is none, or if one is not finite: a run failed
  double lowest() const;  ///< NaN as the median
  double highest() const;
  const std::vector<double>& all() const { return all_; }

 private:
  bool sound() const;  ///< at least one value, all finite
  std::vector<double> all_;
};

}  // namespace fpc::papers
