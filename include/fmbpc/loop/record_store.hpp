// The folder of a recorded run: a journal while it runs, the run's files at its end.
#pragma once

#include <cstdint>
#include <string>

#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/loop/record_journal.hpp"
#include "fmbpc/loop/report.hpp"

namespace fpc {

/// Files of an earlier run stay until those of the new one take their place, all at once each. A
/// journal that a killed process left behind becomes files in the folder `interrupted`.
class RecordStore {
 public:
  /// Without a folder nothing is written. @throws InputError if it cannot be written, or if another
  /// recorder uses it.
  RecordStore(const LoopFile& loop, std::string folder);

  /// A run begins, or goes on: @return how many samples of it are here already.
  /// @throws InputError if the journal cannot be written.
  std::uint32_t begin(std::uint64_t run_id);
  void append(const SampleRecord& sample);
  void flush() { journal_.flush(); }
  /// The run is over: makes its files of the journal and removes that. @throws InputError if they
  /// cannot be written; the journal stays.
  Summary finish(double wall_s);
  /// Puts what there is of a run that ended early into `interrupted`.
  void setAside();

  const std::string& folder() const { return folder_; }
  const std::string& problem() const { return journal_.problem(); }
  std::uint64_t lost() const { return journal_.lost(); }
  std::uint64_t samples() const { return samples_; }

 private:
  Summary write(double wall_s, const std::string& folder) const;
  std::string journalFile() const;

  const LoopFile loop_;
  std::string folder_;
  RecordLayout layout_;
  RecordJournal journal_;
  std::uint64_t samples_{}, actions_{};
};

}  // namespace fpc
