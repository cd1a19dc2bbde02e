#include "fmbpc/loop/record_store.hpp"

#include <filesystem>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/loop/journal_reader.hpp"
#include "fmbpc/loop/run_summary.hpp"
#include "fmbpc/loop/trajectory.hpp"

namespace fpc {
namespace {

namespace fs = std::filesystem;

/// Files that were written beside take the place of those of the run before.
void moveIn(const fs::path& beside, const fs::path& folder) {
  std::error_code error;
  fs::remove(folder / "plot.png", error);  // of the run before
  for (const char* name : {"trajectory.csv", "summary.json"}) {
    fs::rename(beside / name, folder / name, error);
    require(!error, (folder / name).string(), "a writable file: " + error.message());
  }
  fs::remove_all(beside, error);
}

}  // namespace

RecordStore::RecordStore(const LoopFile& loop, std::string folder)
    : loop_(loop), folder_(std::move(folder)), layout_(recordLayout(loop)) {
  if (folder_.empty()) return;
  std::error_code error;
  fs::create_directories(folder_, error);
  require(!error, folder_, "a folder that can be made (" + error.message() + ")");
  const std::uint64_t left = journalRun(journalFile(), layout_);
  journal_.open(journalFile(), layout_, left);  // nobody else may write from now on
}

std::string RecordStore::journalFile() const {
  return (fs::path(folder_) / "journal.bin").string();
}

std::uint32_t RecordStore::begin(std::uint64_t run_id) {
  samples_ = actions_ = 0;
  if (folder_.empty()) return 0;
  const std::uint64_t left = journalRun(journalFile(), layout_);
  if (left != 0 && left != run_id) setAside();
  const std::uint32_t here = journal_.open(journalFile(), layout_, run_id);
  samples_ = here;
  return here;
}

void RecordStore::append(const SampleRecord& sample) {
  ++samples_;
  actions_ += sample.has_action ? 1 : 0;
  if (!folder_.empty()) journal_.append(sample);
}

Summary RecordStore::write(double wall_s, const std::string& folder) const {
  const fs::path beside = fs::path(folder) / "unfinished";
  std::error_code error;
  fs::create_directories(beside, error);
  require(!error, beside.string(), "a folder that can be made (" + error.message() + ")");
  JournalReader reader(journalFile(), layout_);
  RunSummary sums(loop_);
  TrajectoryFile file(loop_, layout_, (beside / "trajectory.csv").string());
  for (SampleRecord sample; reader.next(sample);) {
    sums.add(sample);
    file.add(sample);
  }
  file.close();
  const Summary summary = sums.finish(wall_s, reader.complete());
  writeSummary(summary, (beside / "summary.json").string());
  moveIn(beside, folder);
  return summary;
}

Summary RecordStore::finish(double wall_s) {
  Summary summary;
  summary.steps = static_cast<std::uint32_t>(actions_);
  summary.wall_s = wall_s;
  if (folder_.empty()) return summary;
  journal_.flush();
  require(journal_.problem().empty(), journalFile(), "room on the disk");
  summary = write(wall_s, folder_);
  journal_.close();
  std::error_code error;
  fs::remove(journalFile(), error);
  return summary;
}

void RecordStore::setAside() {
  journal_.flush();
  SampleRecord first;
  if (!JournalReader(journalFile(), layout_).next(first)) return;
  const fs::path aside = fs::path(folder_) / "interrupted";
  std::error_code error;
  fs::create_directories(aside, error);
  write(0.0, aside.string());
}

}  // namespace fpc
