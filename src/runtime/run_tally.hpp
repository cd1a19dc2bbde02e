// What is gathered of a run sample by sample: samples over which the plant was held, solve times.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/record.hpp"

namespace fpc {

class RunTally {
 public:
  void add(const SampleRecord& sample);

  std::uint32_t failed_samples{};
  std::string trouble;  ///< of the first of them
};

/// How the values of a run are spread, to a thousandth of a decade: quantiles without the values.
class LogHistogram {
 public:
  LogHistogram();
  void add(double value);
  std::uint64_t count() const { return count_; }
  /// The value below which the share `p` of the values lies (nearest rank); 0 without values.
  double quantile(double p) const;

 private:
  std::vector<std::uint64_t> bins_;
  std::uint64_t count_{};
};

}  // namespace fpc
