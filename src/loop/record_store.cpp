#include "fmbpc/loop/record_store.hpp"

#include <filesystem>
#include <utility>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {
namespace fs = std::filesystem;
}

void replaceRun(const LoopFile& loop, const RunRecord& record, const Summary& summary,
                const std::string& folder) {
  const fs::path beside = fs::path(folder) / "unfinished";
  writeRun(loop, record, summary, beside.string());
  std::error_code error;
  fs::remove(fs::path(folder) / "plot.png", error);  // of the run before
  for (const char* name : {"trajectory.csv", "summary.json"}) {
    fs::rename(beside / name, fs::path(folder) / name, error);
    require(!error, (fs::path(folder) / name).string(), "a writable file: " + error.message());
  }
  fs::remove_all(beside, error);
}

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
  const RunRecord record = readJournal(journalFile(), layout_);
  const Summary summary = summarize(loop_, record, wall_s);
  replaceRun(loop_, record, summary, folder);
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
  if (readJournal(journalFile(), layout_).samples.empty()) return;
  const fs::path aside = fs::path(folder_) / "interrupted";
  std::error_code error;
  fs::create_directories(aside, error);
  write(0.0, aside.string());
}

}  // namespace fpc
