// The folder of a recorded run: a journal while it runs, the run's files at its end.
#pragma once

#include <cstdint>
#include <string>

#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/loop/record_journal.hpp"
#include "fmbpc/loop/report.hpp"

namespace fpc {

/// Files of an earlier run stay until those of a complete one take their place, all at once each. A
/// journal that a killed process left behind, whatever loop it is of, goes to a folder of its own,
/// `interrupted/RUN`, and becomes files there; one that cannot be read stays there as it is.
class RecordStore {
 public:
  /// Without a folder nothing is written. @throws InputError if it cannot be written, or if another
  /// recorder uses it.
  RecordStore(const LoopFile& loop, std::string folder);

  /// A run begins, or goes on: @return how many samples of it are here already. What stands in the
  /// way (no room) is problem(), and tried again by each flush(); samples are kept meanwhile.
  std::uint32_t begin(std::uint64_t run_id);
  void append(const SampleRecord& sample);
  void flush();
  /// The run is over: makes its files of the journal and removes that. @throws InputError if they
  /// cannot be written; the journal stays.
  Summary finish(double wall_s);

  const std::string& folder() const { return folder_; }
  /// Where finish() has put the files: the folder, or one of its `interrupted`.
  const std::string& written() const { return written_; }
  const std::string& problem() const { return problem_.empty() ? journal_.problem() : problem_; }
  /// What became of the journal of a run before, in words; empty if there was none.
  const std::string& remark() const { return remark_; }
  std::uint64_t lost() const { return journal_.lost(); }
  std::uint64_t samples() const { return samples_; }
  std::uint64_t unwritten() const { return journal_.unwritten(); }  ///< that wait for the disk
  double beganAt() const { return journal_.beganAt(); }             ///< see RecordJournal

 private:
  std::uint32_t tryOpen();
  void setAside();
  std::string journalFile() const;

  const LoopFile loop_;
  std::string folder_;
  RecordLayout layout_;
  RecordJournal journal_;
  std::uint64_t run_id_{}, samples_{}, actions_{};
  bool begun_{false};
  std::string problem_, remark_, written_;
};

}  // namespace fpc
