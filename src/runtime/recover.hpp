// The files of a run from its journal: at the end of the run, or later, when the process that
// wrote it was killed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/recorder_session.hpp"
#include "runtime/report.hpp"

namespace fpc {

/// What was written to the file, or into the folder, is on the disk itself.
void syncFile(const std::string& file);

struct WrittenRecord {
  Summary summary;
  std::string folder;  ///< where trajectory.csv and summary.json are
};

/// A folder that is not there yet below folder/history, named by the run. It is made.
/// @throws InputError if it cannot be.
std::string freshAside(const std::string& folder, std::uint64_t run_id);

/// Writes beside, and when all is on the disk takes the place of what the folder holds of the same
/// part of the same run; what it holds of another goes to freshAside() first. The journal stays.
/// @throws InputError if the files cannot be written or the journal is not of this loop.
WrittenRecord writeRecord(const LoopFile& loop, const RecordLayout& layout,
                          const std::string& journal, double wall_s, const std::string& folder);

/// What a journal has become.
struct Recovered {
  std::string journal;
  std::string problem;  ///< why it stays as it is; empty: it is gone, its files are there
  WrittenRecord record;
};
/// By the loop that stands in the journal. It is removed when its files are there.
Recovered recoverJournal(const std::string& journal, const std::string& folder);
/// All journals of a folder of runs: its own, and those of its history.
std::vector<Recovered> recoverFolder(const std::string& folder);
/// Whether both folders hold as many samples of the same part of the same run.
bool holdTheSame(const std::string& a, const std::string& b);

}  // namespace fpc
