#include "fmbpc/loop/recover.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <utility>

#include "base/files.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/loop/journal_reader.hpp"
#include "fmbpc/loop/record_journal.hpp"
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

bool hasRecord(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / "trajectory.csv", error) || fs::exists(folder / "summary.json", error);
}

struct Filled {
  Summary summary;
  bool to_the_end;  ///< its last sample is final
};

/// trajectory.csv and summary.json in the folder.
Filled fill(const LoopFile& loop, const RecordLayout& layout, const std::string& journal,
            double wall_s, const fs::path& folder) {
  JournalReader reader(journal, layout);
  RunSummary sums(loop);
  TrajectoryFile file(loop, layout, (folder / "trajectory.csv").string());
  for (SampleRecord sample; reader.next(sample);) {
    sums.add(sample);
    file.add(sample);
  }
  file.close();
  Filled filled{sums.finish(wall_s, reader.complete()), reader.ended()};
  writeSummary(filled.summary, (folder / "summary.json").string());
  return filled;
}

/// @throws InputError if it cannot become files.
WrittenRecord convert(const std::string& journal, const std::string& folder) {
  const auto label = journalLabel(journal);
  require(label.has_value(), journal, "a journal of this version");
  require(!label->empty, journal, "a sample in it");
  const LoopFile loop = parseLoop(label->text, label->loop);
  return writeRecord(loop, recordLayout(loop), journal, 0.0, folder);
}

}  // namespace

std::string freshAside(const std::string& folder, std::uint64_t run_id) {
  const fs::path aside = fs::path(folder) / "interrupted";
  const std::string name = run_id == 0 ? "unknown" : std::to_string(run_id);
  makeFolder(aside);
  std::error_code error;
  for (int n = 1;; ++n) {
    const fs::path one = aside / (n == 1 ? name : name + "-" + std::to_string(n));
    if (fs::create_directory(one, error)) return one.string();
    require(!error, one.string(), "a folder that can be made (" + error.message() + ")");
  }
}

WrittenRecord writeRecord(const LoopFile& loop, const RecordLayout& layout,
                          const std::string& journal, double wall_s, const std::string& folder) {
  const fs::path beside = fs::path(folder) / "unfinished";
  makeFolder(beside);
  try {
    Filled filled = fill(loop, layout, journal, wall_s, beside);
    WrittenRecord record{std::move(filled.summary), folder};
    if (!filled.to_the_end && hasRecord(folder))
      record.folder = freshAside(folder, journalLabel(journal)->run_id);
    moveIn(beside, record.folder);
    return record;
  } catch (const InputError&) {
    std::error_code error;
    fs::remove_all(beside, error);  // it would take the room that is missing
    throw;
  }
}

Recovered recoverJournal(const std::string& journal, const std::string& folder) {
  Recovered result{journal, {}, {}};
  try {
    RecordJournal lock;
    lock.lock(journal);
    result.record = convert(journal, folder);
    std::error_code error;
    fs::remove(journal, error);
    if (error) result.problem = journal + ": " + error.message();
  } catch (const std::exception& error) {  // whatever the text of another version may throw
    result.problem = error.what();
  }
  return result;
}

std::vector<Recovered> recoverFolder(const std::string& folder) {
  std::vector<fs::path> homes{folder};
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(fs::path(folder) / "interrupted", error))
    homes.push_back(entry.path());
  std::sort(homes.begin() + 1, homes.end());
  std::vector<Recovered> all;
  for (const fs::path& home : homes) {
    const std::string journal = (home / "journal.bin").string();
    const auto label = journalLabel(journal);
    if (label ? !label->empty : fs::exists(journal, error))
      all.push_back(recoverJournal(journal, home.string()));
  }
  return all;
}

}  // namespace fpc
