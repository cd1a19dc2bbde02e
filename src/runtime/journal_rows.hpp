// Rows of a journal while its recorder goes on writing it: for who watches a run without listening
// to it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "runtime/recorder_session.hpp"

namespace fpc {

class JournalRows {
 public:
  static constexpr std::size_t kSettled = 20;
  struct Rows {
    std::uint32_t first;        ///< sample of the first row
    std::vector<double> cells;  ///< row by row
  };
  /// @throws InputError if the file is no journal of this version, or its loop cannot be read.
  explicit JournalRows(const std::string& journal);
  std::uint64_t runId() const { return run_id_; }
  const std::vector<std::string>& names() const { return names_; }  ///< those of trajectory.csv
  /// Rows of names().size() numbers, at most `most` of them, from sample `from` on (or the first
  /// that is there), as trajectory.csv has them. The newest sample lacks its input and is not among
  /// them, nor is one that lacks something, of which more may come, until kSettled more or a whole
  /// one follow.
  /// @throws InputError if the journal holds another run now.
  Rows read(std::uint32_t from, std::size_t most) const;

 private:
  std::string journal_;
  LoopFile loop_;
  RecordLayout layout_;
  std::uint64_t run_id_{};
  std::vector<std::string> names_;
};

}  // namespace fpc
