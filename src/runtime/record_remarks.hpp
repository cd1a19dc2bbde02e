// What only the record of a run tells: inputs that do not follow, soft limits that were exceeded,
// messages that never came. Private to the room.
#pragma once

#include <vector>

#include "config/loop_file.hpp"
#include "runtime/record.hpp"
#include "runtime/stuck_watch.hpp"

namespace fpc {

/// Made from samples alone, so that a run in one process and one over topics say the same.
class RecordRemarks {
 public:
  explicit RecordRemarks(const LoopFile& loop);
  /// Samples in order, those without values included.
  void add(const SampleRecord& sample);
  std::vector<RunRemark> remarks() const { return remarks_; }

 private:
  struct SoftLimit {
    Eigen::Index output;
    double sign, limit;  // exceeded where sign * (y - limit) > 0, beyond rounding
    std::string words;
  };
  void addLimits(const LoopFile& loop, double sign);
  void watchInputs(const SampleRecord& sample);
  void watchOutputs(const SampleRecord& sample);
  void watchGaps(const SampleRecord& sample);
  void keep(const std::string& words, std::uint32_t step);

  StuckWatch stuck_;
  bool has_optimizer_, has_state_;
  std::vector<SoftLimit> soft_;
  SampleRecord before_;  // the sample before, as far as inputs go
  std::vector<const char*>
      missing_;  // of the sample before: the last one of a run cut short may lack
  std::vector<RunRemark> remarks_;
  std::uint32_t step_{};
};

}  // namespace fpc
