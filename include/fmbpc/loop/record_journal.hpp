// A run on disk while it runs: sample after sample in one file of fixed-size entries, so that
// memory stays flat and nothing is lost with the process.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "fmbpc/loop/recorder_session.hpp"

namespace fpc {

/// Native doubles, for the machine that wrote it. One writer at a time (the file is locked).
class RecordJournal {
 public:
  static constexpr std::size_t kMostUnwritten = 10000;  ///< samples kept while the disk is full

  RecordJournal() = default;
  RecordJournal(const RecordJournal&) = delete;
  RecordJournal& operator=(const RecordJournal&) = delete;
  ~RecordJournal();

  /// Goes on with the file if it holds this run of this loop, else starts it anew.
  /// @return samples that are in it already. @throws InputError if it cannot be written, or another
  /// process writes it.
  std::uint32_t open(const std::string& file, const RecordLayout& layout, std::uint64_t run_id);
  /// Never throws and never blocks the loop: what the disk refuses is kept and tried again.
  void append(const SampleRecord& sample);
  void flush();
  /// Why something is not on disk, in words; empty if all is.
  const std::string& problem() const { return problem_; }
  std::uint64_t lost() const { return lost_; }  ///< samples that could not be kept
  bool isOpen() const { return file_ >= 0; }
  void close();

 private:
  bool write(const std::vector<double>& entry);

  std::string name_;
  RecordLayout layout_;
  int file_{-1};
  std::size_t entry_size_{};
  std::uint64_t written_{};  // entries
  std::deque<std::vector<double>> unwritten_;
  std::uint64_t lost_{};
  std::string problem_;
};

/// The record that a journal holds; complete if its last sample is final and nothing is missing.
/// @throws InputError if the file is no journal of this loop.
RunRecord readJournal(const std::string& file, const RecordLayout& layout);
/// Which run a journal holds; 0 if there is none.
std::uint64_t journalRun(const std::string& file, const RecordLayout& layout);

}  // namespace fpc
