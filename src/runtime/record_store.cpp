#include "runtime/record_store.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/files.hpp"
#include "fmbpc/base/input_error.hpp"
#include "runtime/journal_reader.hpp"
#include "runtime/recover.hpp"

namespace fpc {
namespace {

namespace fs = std::filesystem;

/// True if there is something that a new journal would overwrite.
bool holdsSomething(const std::string& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  if (error || size == 0) return false;
  const auto label = journalLabel(file);
  return !label || !label->empty;
}

}  // namespace

RecordStore::RecordStore(const LoopFile& loop, std::string folder, double patience_s, double part_h,
                         double part_bytes)
    : loop_(loop),
      folder_(std::move(folder)),
      part_h_(part_h),
      part_bytes_(part_bytes),
      layout_(recordLayout(loop)) {
  if (folder_.empty()) return;
  makeFolder(folder_);
  journal_.lock(journalFile(), patience_s);  // nobody else may write from now on
  const std::uint64_t left = journalRun(journalFile(), layout_);
  if (left != 0 || !holdsSomething(journalFile())) journal_.open(journalFile(), layout_, left);
}

std::string RecordStore::journalFile() const {
  return (fs::path(folder_) / "journal.bin").string();
}

std::uint32_t RecordStore::begin(std::uint64_t run_id) {
  actions_ = 0;
  run_id_ = run_id;
  begun_ = true;
  problem_.clear();
  remark_.clear();
  if (folder_.empty()) return 0;
  if (journal_.unwritten() > 0) journal_.flush();
  if (journal_.unwritten() > 0)
    remark_ = std::to_string(journal_.unwritten()) + " samples of the run before had no room";
  journal_.start(layout_, run_id);
  return tryOpen();
}

RecorderSession::Samples RecordStore::unfinished() const {
  RecorderSession::Samples found;
  const auto all = static_cast<std::uint32_t>(journal_.samples());
  const std::uint32_t from = all > kAmended ? all - kAmended : 0;
  JournalReader reader(journalFile(), layout_);
  reader.skip(from);
  SampleRecord sample;
  for (std::uint32_t place = from; reader.next(sample); ++place)
    if (!layout_.isComplete(sample)) found.emplace_back(journal_.firstStep() + place, sample);
  return found;
}

std::uint32_t RecordStore::tryOpen() {
  try {
    if (journalRun(journalFile(), layout_) != run_id_ && holdsSomething(journalFile())) setAside();
    const std::uint32_t here = journal_.open(journalFile(), layout_, run_id_);
    problem_.clear();
    return journal_.firstStep() + here;
  } catch (const InputError& error) {
    problem_ = std::string("not recorded: ") + error.what();
    return 0;
  }
}

void RecordStore::put(std::uint32_t step, const SampleRecord& sample) {
  if (sample.has_action) actions_ = std::max(actions_, step + 1);
  if (!folder_.empty()) journal_.put(step, sample);
}

bool RecordStore::flush(bool settled) {
  if (!problem_.empty() && begun_) tryOpen();
  journal_.flush();
  const double hours =
      static_cast<double>(journal_.samples()) * loop_.plant_info.sample_time_s / 3600.0;
  const double parts =
      std::max(hours / part_h_, static_cast<double>(journal_.bytes()) / part_bytes_);
  const bool full = parts >= (settled ? 1.0 : 2.0);
  return layout_.samples == 0 && full && journal_.isOpen() && journal_.unwritten() == 0 &&
         beginNextPart();
}

bool RecordStore::beginNextPart() {
  try {
    writeRecord(loop_, layout_, journalFile(), 0.0, folder_);
    journal_.beginNextPart();
    problem_.clear();
    return true;
  } catch (const InputError& error) {
    problem_ = error.what();  // no room: this part grows meanwhile
    return false;
  }
}

Summary RecordStore::finish(double wall_s) {
  Summary summary;
  summary.steps = actions_;
  summary.wall_s = wall_s;
  if (folder_.empty()) return summary;
  summary = write(wall_s);
  std::error_code error;
  fs::remove(journalFile(), error);
  journal_.close();
  return summary;
}

Summary RecordStore::interrupt(double wall_s) {
  if (folder_.empty()) return finish(wall_s);
  Summary summary = write(wall_s);
  journal_.close();
  return summary;
}

Summary RecordStore::write(double wall_s) {
  if (!problem_.empty() && begun_) tryOpen();
  journal_.flush();
  require(problem().empty(), journalFile(), "room on the disk: " + problem());
  WrittenRecord record = writeRecord(loop_, layout_, journalFile(), wall_s, folder_);
  begun_ = false;
  return std::move(record.summary);
}

void RecordStore::setAside() {
  RecordJournal guard;
  guard.lock(journalFile());  // it is nobody's
  const auto label = journalLabel(journalFile());
  const std::string aside = freshAside(folder_, label ? label->run_id : 0);
  const std::string moved = (fs::path(aside) / "journal.bin").string();
  std::error_code error;
  fs::rename(journalFile(), moved, error);
  if (std::error_code ignored; error) fs::remove(aside, ignored);
  require(!error, moved,
          "a file that the journal of the run before can become: " + error.message());
  guard.close();
  const Recovered run = recoverJournal(moved, aside);
  if (holdTheSame(folder_, aside)) {  // its process ended in order, and left it for another one
    fs::remove_all(aside, error);
    return;
  }
  if (!remark_.empty()) remark_ += "; ";
  remark_ += run.problem.empty()
                 ? "the run before was interrupted: its files are in " + aside
                 : "the run before was interrupted: " + moved + " stays as it is: " + run.problem;
}

}  // namespace fpc
