#include "runtime/run_tally.hpp"

#include <algorithm>
#include <cmath>

namespace fpc {
namespace {

constexpr double kSmallest = 1e-4, kPerDecade = 1000.0;
constexpr std::size_t kBins = 14000;  // fourteen decades

}  // namespace

void RunTally::add(const SampleRecord& sample) {
  if (!sample.state.trouble.empty() && failed_samples++ == 0) trouble = sample.state.trouble;
}

LogHistogram::LogHistogram() : bins_(kBins) {}

void LogHistogram::add(double value) {
  const double place = kPerDecade * std::log10(std::max(value, kSmallest) / kSmallest);
  ++bins_[std::min(static_cast<std::size_t>(place), kBins - 1)];
  ++count_;
}

double LogHistogram::quantile(double p) const {
  if (count_ == 0) return 0.0;
  const auto rank = std::clamp<std::uint64_t>(
      static_cast<std::uint64_t>(std::ceil(p * static_cast<double>(count_))), 1, count_);
  std::uint64_t below = 0;
  std::size_t bin = 0;
  while ((below += bins_[bin]) < rank) ++bin;
  return kSmallest * std::pow(10.0, (static_cast<double>(bin) + 0.5) / kPerDecade);
}

}  // namespace fpc
