// The samples of a journal one after the other, so that a record of any length takes no memory.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "runtime/recorder_session.hpp"

namespace fpc {

class JournalReader {
 public:
  /// @throws InputError if the file is no journal of this loop.
  JournalReader(const std::string& file, const RecordLayout& layout);
  /// Leaves out as many samples; behind the last one next() finds nothing.
  void skip(std::uint64_t samples);
  /// The next sample; false at the end. What a kill cut in half is not read.
  bool next(SampleRecord& sample);
  /// Of the samples read so far: nothing is missing and the last one is final; of an endless run
  /// the last one may lack its answer.
  bool complete() const { return whole_ && (layout_.samples == 0 || (final_ && last_whole_)); }
  std::uint64_t runId() const { return run_id_; }
  std::uint32_t firstStep() const { return layout_.first_step; }

 private:
  RecordLayout layout_;
  std::ifstream stream_;
  std::vector<double> entry_;
  std::uint64_t run_id_{};
  bool whole_{true}, last_whole_{true}, final_{false};  // all before the last one; the last one
};

}  // namespace fpc
