// Which arriving samples are new: every node of the exchange asks the same question in the same
// way.
#pragma once

#include <cstdint>
#include <optional>

#include "fmbpc/base/exchange.hpp"

namespace fpc {

/// What an arriving header means to a receiver that has accepted samples before.
enum class Arrival {
  kFirst,     ///< nothing was accepted before
  kNext,      ///< the sample after the last accepted one
  kRepeat,    ///< the last accepted sample again: send the cached answer again
  kGap,       ///< later than the next one: samples were lost, reset
  kNewRun,    ///< another run, announced (or, without announcements, a larger run_id): reset
  kResync,    ///< earlier than the last accepted one, but what the plant goes on from: reset
  kOld,       ///< an earlier step of this run: drop
  kSuspect,   ///< so far ahead that it is taken only when it comes again: drop
  kOtherRun,  ///< a run that was not announced: drop
};

/// Counts of everything that was not simply the next sample.
struct ArrivalCounts {
  std::uint64_t accepted{}, repeated{}, gaps{}, new_runs{}, resyncs{}, old{}, suspect{},
      other_run{}, wrong_size{}, not_finite{};
};

/// Remembers the last accepted sample. No single message can lead it astray:
/// - a step more than kFarthest ahead is taken only when the same or the next one follows;
/// - after a jump, a step that continues what came before it takes the gate back: the next one at
///   once if nothing has followed the jump, otherwise three in a row that repeat or follow each
///   other, as after the first step of a run, which may be a stray one. What the plant keeps
///   sending wins.
class StepGate {
 public:
  static constexpr std::uint32_t kFarthest = 1000;  ///< samples that may be missing unquestioned

  /// From now on this run counts and no other, whichever number is larger.
  void announce(std::uint64_t run_id) { announced_ = run_id; }
  Arrival classify(const StepHeader& header) const;
  /// Classifies, counts, and remembers the header if it is to be processed (see isNew()).
  Arrival pass(const StepHeader& header);
  void countWrongSize() { ++counts_.wrong_size; }
  void countNotFinite() { ++counts_.not_finite; }
  const ArrivalCounts& counts() const { return counts_; }
  const StepHeader& last() const { return last_; }
  bool empty() const { return empty_; }

 private:
  bool goesOnFromBefore(std::uint32_t step) const;
  void remember(const StepHeader& header, Arrival arrival);
  void watch(std::uint32_t step, Arrival arrival);

  std::optional<std::uint64_t> announced_;
  StepHeader last_{};
  bool empty_{true};
  bool jumped_{false};           // a gap, not long ago; or joined in the middle of a run
  bool unconfirmed_{false};      // nothing has followed the jump yet
  std::int64_t before_{};        // accepted last before the jump; -1: nothing of this run
  std::uint32_t streak_step_{};  // of the old steps since the jump that follow each other
  int streak_{};
  std::optional<std::uint32_t> suspect_;
  ArrivalCounts counts_{};
};

/// True when the arrival means that memory of the past is invalid.
constexpr bool needsReset(Arrival a) {
  return a == Arrival::kFirst || a == Arrival::kGap || a == Arrival::kNewRun ||
         a == Arrival::kResync;
}
/// True when the sample is to be processed now.
constexpr bool isNew(Arrival a) { return needsReset(a) || a == Arrival::kNext; }

}  // namespace fpc
