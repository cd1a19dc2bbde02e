#include "runtime/recover.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <optional>
#include <utility>

#include "base/files.hpp"
#include "config/loop_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "runtime/journal_reader.hpp"
#include "runtime/record_journal.hpp"
#include "runtime/run_summary.hpp"
#include "runtime/trajectory.hpp"

namespace fpc {
namespace {

namespace fs = std::filesystem;

constexpr char kHistory[] = "history";
constexpr const char* kRecord[] = {"trajectory.csv", "summary.json"};

/// Nothing where there is none, or none that can be read.
std::optional<Summary> summaryIn(const fs::path& folder) {
  try {
    return readSummary((folder / "summary.json").string());
  } catch (const InputError&) {
    return {};
  }
}

bool samePart(const Summary& a, const Summary& b) {
  return a.run_id == b.run_id && a.first_step == b.first_step;
}

void move(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  require(!error, to.string(), "a writable file: " + error.message());
}

/// What stands in the folder and is not of this part of this run.
void fileAway(const fs::path& folder, const Summary& now) {
  std::error_code error;
  const bool any = fs::exists(folder / kRecord[0], error) || fs::exists(folder / kRecord[1], error);
  const auto before = summaryIn(folder);
  if (!any || (before && samePart(*before, now))) return;
  const fs::path aside = freshAside(folder.string(), before ? before->run_id : 0);
  for (const char* name : {"plot.png", "loop.bag", kRecord[0], kRecord[1]})
    if (fs::exists(folder / name, error)) move(folder / name, aside / name);
}

/// Files that were written beside take their place.
void moveIn(const fs::path& beside, const fs::path& folder) {
  std::error_code error;
  fs::remove(folder / "plot.png", error);  // of less of this run
  for (const char* name : kRecord) {
    syncFile((beside / name).string());
    move(beside / name, folder / name);
  }
  fs::remove_all(beside, error);
  syncFile(folder.string());
}

/// trajectory.csv and summary.json in the folder.
Summary fill(const LoopFile& loop, const RecordLayout& layout, const std::string& journal,
             double wall_s, const fs::path& folder) {
  JournalReader reader(journal, layout);
  RecordLayout part = layout;
  part.first_step = reader.firstStep();
  RunSummary sums(loop, part.first_step);
  TrajectoryFile file(loop, part, (folder / "trajectory.csv").string());
  for (SampleRecord sample; reader.next(sample);) {
    sums.add(sample);
    file.add(sample);
  }
  file.close();
  Summary summary = sums.finish(wall_s, reader.complete());
  summary.run_id = reader.runId();
  writeSummary(summary, (folder / "summary.json").string());
  return summary;
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

void syncFile(const std::string& file) {
  const int opened = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (opened < 0) return;
  ::fsync(opened);
  ::close(opened);
}

std::string freshAside(const std::string& folder, std::uint64_t run_id) {
  const fs::path aside = fs::path(folder) / kHistory;
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
    WrittenRecord record{fill(loop, layout, journal, wall_s, beside), folder};
    fileAway(folder, record.summary);
    moveIn(beside, folder);
    return record;
  } catch (const InputError&) {
    std::error_code error;
    fs::remove_all(beside, error);  // it would take the room that is missing
    throw;
  }
}

bool holdTheSame(const std::string& a, const std::string& b) {
  const auto first = summaryIn(a), second = summaryIn(b);
  return first && second && samePart(*first, *second) && first->steps == second->steps;
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
  for (const auto& entry : fs::directory_iterator(fs::path(folder) / kHistory, error))
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
