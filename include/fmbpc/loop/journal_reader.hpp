// The samples of a journal one after the other, so that a record of any length takes no memory.
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "fmbpc/loop/recorder_session.hpp"

namespace fpc {

class JournalReader {
 public:
  /// @throws InputError if the file is no journal of this loop.
  JournalReader(const std::string& file, const RecordLayout& layout);
  /// The next sample; false at the end. What a kill cut in half is not read.
  bool next(SampleRecord& sample);
  /// Of the samples read so far: the last one is final and nothing is missing.
  bool complete() const { return whole_ && final_; }
  bool ended() const { return final_; }  ///< the last one is final

 private:
  RecordLayout layout_;
  std::ifstream stream_;
  std::vector<double> entry_;
  bool whole_{true}, final_{false};
};

}  // namespace fpc
