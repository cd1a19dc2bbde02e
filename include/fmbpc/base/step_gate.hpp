// Which arriving samples are new: every node of the ring asks the same question in the same way.
#pragma once

#include <cstdint>

#include "fmbpc/base/ring.hpp"

namespace fpc {

/// What an arriving header means to a receiver that has accepted samples before.
enum class Arrival {
  kFirst,     ///< nothing was accepted before
  kNext,      ///< the sample after the last accepted one
  kRepeat,    ///< the last accepted sample again: send the cached answer again
  kGap,       ///< later than the next one: samples were lost, reset
  kNewRun,    ///< a larger run_id: the plant was restarted, reset
  kOld,       ///< an earlier step of this run: drop
  kOtherRun,  ///< a smaller run_id: drop
};

/// Counts of everything that was not simply the next sample.
struct ArrivalCounts {
  std::uint64_t accepted{}, repeated{}, gaps{}, new_runs{}, old{}, other_run{}, wrong_size{},
      not_finite{};
};

/// Remembers the last accepted sample.
class StepGate {
 public:
  Arrival classify(const StepHeader& header) const;
  /// Classifies, counts, and remembers the header if it is to be processed (first, next, gap, new
  /// run).
  Arrival pass(const StepHeader& header);
  void countWrongSize() { ++counts_.wrong_size; }
  void countNotFinite() { ++counts_.not_finite; }
  const ArrivalCounts& counts() const { return counts_; }
  const StepHeader& last() const { return last_; }
  bool empty() const { return empty_; }

 private:
  StepHeader last_{};
  bool empty_{true};
  ArrivalCounts counts_{};
};

/// True when the arrival means that memory of the past is invalid.
constexpr bool needsReset(Arrival a) {
  return a == Arrival::kFirst || a == Arrival::kGap || a == Arrival::kNewRun;
}
/// True when the sample is to be processed now.
constexpr bool isNew(Arrival a) { return needsReset(a) || a == Arrival::kNext; }

}  // namespace fpc
