// What went otherwise than asked in a run, from its samples: what controller and plant said of
// them, and what only the record shows. Private to the room.
#pragma once

#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "fmbpc/base/event.hpp"
#include "runtime/model_use.hpp"
#include "runtime/record.hpp"
#include "runtime/stuck_watch.hpp"

namespace fpc {

/// Made from samples alone, so that a run in one process and one over topics say the same.
class RunEvents {
 public:
  RunEvents(const LoopFile& loop, std::uint32_t first_step);
  /// Samples in order, those without values included. `rejected` has looked at it.
  void add(const SampleRecord& sample, const Rejections& rejected);
  /// With what is to be said at the end of the run.
  EventList finish() const;
  std::uint64_t outsideModel() const { return outside_model_; }  ///< samples

 private:
  struct SoftLimit {
    Eigen::Index output;
    double sign, limit;  // exceeded where sign * (y - limit) > 0, beyond rounding
    std::string name, text;
  };
  void addLimits(double sign);
  void addSaid(const SampleRecord& sample);
  void addSources(const SampleRecord& sample);
  void addSolve(const SampleRecord& sample);
  void addRejected(const SampleRecord& sample, const Rejections& rejected);
  void watchInputs(const SampleRecord& sample);
  void watchBounds(const SampleRecord& sample);
  void watchOutputs(const SampleRecord& sample);
  void watchGaps(const SampleRecord& sample);
  void say(const Notice& notice, std::uint32_t step) { list_.add(eventOf(notice, step)); }

  LoopFile loop_;
  bool has_domain_;
  StuckWatch stuck_;
  std::vector<SoftLimit> soft_;
  SampleRecord before_;  // the sample before, as far as inputs go
  std::vector<const char*>
      missing_;  // of the sample before: the last one of a run cut short may lack
  std::vector<std::uint32_t> at_lower_, at_upper_;  // last actions in a row at a limit
  std::vector<bool> moved_;                         // the others stand where they stand
  std::uint32_t step_, last_action_{};              // its step
  std::uint32_t actions_{}, lost_{};                // lost: held or on the fallback
  std::uint64_t outside_model_{};
  EventList list_;
};

/// A message (its topic) that a sample lacks in the record.
Event gapEvent(const std::string& what, std::uint32_t step);
/// What is to be known of a solve; kNone of one that is as it should be.
Notice noticeOf(SolveStatus status);
/// Of the loop file as such: what never acts or is overruled, cells of the disturbance record.
void addFileEvents(const LoopFile& loop, EventList& list);
/// Each output that cannot show an input's effect when the model of the loop file expects it.
/// delays_s: transport delay of each measured output, as the plant has it.
std::vector<Event> delayEvents(const LoopFile& loop, const std::vector<double>& delays_s,
                               std::uint32_t step);

}  // namespace fpc
