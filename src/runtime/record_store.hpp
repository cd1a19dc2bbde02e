// The folder of a recorded run: a journal while it runs, the run's files at its end.
#pragma once

#include <cstdint>
#include <string>

#include "config/loop_file.hpp"
#include "runtime/record_journal.hpp"
#include "runtime/report.hpp"

namespace fpc {

/// The folder holds the files of the newest run, `history/RUN` those of each run before: nothing is
/// overwritten but by more of the same run. A journal that a killed process left behind, whatever
/// loop it is of, becomes files there as well; one that cannot be read stays there as it is. An
/// endless run is recorded in parts, each filed like a run.
class RecordStore {
 public:
  static constexpr std::uint32_t kAmended = 1000;  ///< samples

  /// Without a folder nothing is written. @throws InputError if it cannot be written, or if another
  /// recorder uses it, for longer than `patience_s`.
  RecordStore(const LoopFile& loop, std::string folder, double patience_s = 0.0,
              double part_h = 24.0, double part_bytes = 64e6);

  /// A run begins, or goes on: @return the sample with which, 0: all of it. What stands in the
  /// way (no room) is problem(), and tried again by each flush(); samples are kept meanwhile.
  std::uint32_t begin(std::uint64_t run_id);
  /// Of a run that goes on: those of its last kAmended samples that lack something.
  RecorderSession::Samples unfinished() const;
  void put(std::uint32_t step, const SampleRecord& sample);  ///< see RecordJournal
  /// True: a part of an endless run has become files, and the next one begins. `settled`: of the
  /// samples in it no more will come; else it gets twice as long first.
  bool flush(bool settled = true);
  void sync(double now_s) { journal_.sync(now_s); }  ///< see RecordJournal
  /// The run is over: makes its files of the journal and removes that. @throws InputError if they
  /// cannot be written; the journal stays.
  Summary finish(double wall_s);
  /// This process ends, the run may go on: makes the files of what there is, and keeps it for the
  /// process that goes on.
  Summary interrupt(double wall_s);

  const std::string& folder() const { return folder_; }
  const std::string& problem() const { return problem_.empty() ? journal_.problem() : problem_; }
  /// What became of the journal of a run before, in words; empty if there was none.
  const std::string& remark() const { return remark_; }
  std::uint64_t lost() const { return journal_.lost(); }
  std::uint64_t samples() const { return journal_.samples(); }
  std::uint64_t unwritten() const { return journal_.unwritten(); }  ///< that wait for the disk
  double beganAt() const { return journal_.beganAt(); }             ///< see RecordJournal

 private:
  std::uint32_t tryOpen();
  void setAside();
  bool beginNextPart();
  Summary write(double wall_s);
  std::string journalFile() const;

  const LoopFile loop_;
  std::string folder_;
  double part_h_, part_bytes_;
  RecordLayout layout_;
  RecordJournal journal_;
  std::uint64_t run_id_{};
  std::uint32_t actions_{};  // up to the newest
  bool begun_{false};
  std::string problem_, remark_;
};

}  // namespace fpc
