// A run on disk while it runs: each sample at its place in one file of fixed-size entries, so that
// memory stays flat and nothing is lost with the process.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runtime/recorder_session.hpp"

namespace fpc {

/// Native doubles, for the machine that wrote it; the loop's text stands at its beginning. One
/// writer at a time (the file is locked).
class RecordJournal {
 public:
  static constexpr std::size_t kMostUnwritten = 10000;  ///< samples kept while the disk is full

  RecordJournal() = default;
  RecordJournal(const RecordJournal&) = delete;
  RecordJournal& operator=(const RecordJournal&) = delete;
  ~RecordJournal();

  /// Only keeps others away from the file. @throws InputError if it cannot be written, or another
  /// process writes it, for longer than `patience_s`.
  void lock(const std::string& file, double patience_s = 0.0);
  /// A run begins whose samples are kept until open() has worked.
  void start(const RecordLayout& layout, std::uint64_t run_id);
  /// Goes on with the file if it holds this run of this loop, else begins it. @return samples that
  /// are in it already. @throws InputError if it cannot be written, another process writes it, or
  /// something else is in it: that is never overwritten.
  std::uint32_t open(const std::string& file, const RecordLayout& layout, std::uint64_t run_id);
  /// The sample of a step, in place of what is there of it. Never throws and never blocks the loop:
  /// what the disk refuses is kept and tried again; what cannot be kept leaves a hole at its place.
  void put(std::uint32_t step, const SampleRecord& sample);
  void flush();
  /// What is written is on the disk itself, once a second at most (`now_s`: any steady clock).
  /// @return whether there was something to do.
  bool sync(double now_s);
  /// The file begins anew with the sample after those that are in it. @throws InputError
  void beginNextPart();
  std::uint32_t firstStep() const { return layout_.first_step; }
  std::uint64_t samples() const { return next_; }  ///< up to the newest in it, or waiting
  std::uint64_t bytes() const { return next_ * entry_size_ * sizeof(double); }
  /// Why something is not on disk, in words; empty if all is.
  const std::string& problem() const { return problem_; }
  std::uint64_t lost() const { return lost_; }  ///< samples that could not be kept
  std::size_t unwritten() const { return unwritten_.size(); }
  bool isOpen() const { return file_ >= 0; }
  /// When the first sample came, also before this process [s, steady clock of the machine].
  double beganAt() const { return 1e-9 * static_cast<double>(began_ns_); }
  void close();

 private:
  using Entries = std::map<std::uint64_t, std::vector<double>>;  // by place
  bool goesOn(std::uint64_t size);
  void writeHead();
  bool write(const Entries::value_type& entry);

  std::string name_, about_;
  RecordLayout layout_;
  std::uint64_t run_id_{};
  std::int64_t began_ns_{};
  int file_{-1};
  std::size_t entry_size_{};
  std::uint64_t next_{};  // place behind the last entry
  bool unsynced_{false};
  double synced_s_{-1e9};
  Entries unwritten_;
  std::uint64_t lost_{};
  std::string problem_;
};

/// What a journal says of itself.
struct JournalLabel {
  std::uint64_t run_id{};
  std::string loop, text;  ///< for parseLoop()
  bool empty{true};        ///< no sample is in it
};
/// Nothing if the file is no journal of this version.
std::optional<JournalLabel> journalLabel(const std::string& file);
/// The record that a journal holds; complete if its last sample is final and nothing is missing.
/// @throws InputError if the file is no journal of this loop.
RunRecord readJournal(const std::string& file, const RecordLayout& layout);
/// Which run of this loop a journal holds; 0 if there is none.
std::uint64_t journalRun(const std::string& file, const RecordLayout& layout);

}  // namespace fpc
