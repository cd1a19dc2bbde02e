#include "runtime/record_journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <thread>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "runtime/journal_entry.hpp"
#include "runtime/journal_reader.hpp"

namespace fpc {
namespace {

std::int64_t steadyNs() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

bool writeAt(int file, const void* bytes, std::size_t count, std::uint64_t offset) {
  return ::pwrite(file, bytes, count, static_cast<off_t>(offset)) == static_cast<ssize_t>(count);
}

}  // namespace

RecordJournal::~RecordJournal() { close(); }

void RecordJournal::close() {
  if (file_ < 0) return;
  flush();
  ::fdatasync(file_);
  ::close(file_);
  file_ = -1;
}

// One that has the same name and is just told to end still writes its files.
void RecordJournal::lock(const std::string& file, double patience_s) {
  close();
  const int opened = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  require(opened >= 0, file, std::string("a file that can be written (") + strerror(errno) + ")");
  const std::int64_t deadline_ns = steadyNs() + static_cast<std::int64_t>(1e9 * patience_s);
  bool mine = flock(opened, LOCK_EX | LOCK_NB) == 0;
  while (!mine && steadyNs() < deadline_ns) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    mine = flock(opened, LOCK_EX | LOCK_NB) == 0;
  }
  if (!mine) ::close(opened);
  require(mine, file,
          "that no other recorder writes here: another loop is running with this folder");
  name_ = file;
  file_ = opened;
}

void RecordJournal::start(const RecordLayout& layout, std::uint64_t run_id) {
  close();
  layout_ = layout;
  run_id_ = run_id;
  about_ = aboutOf(layout);
  entry_size_ = JournalSizes(layout).entry();
  next_ = lost_ = 0;
  began_ns_ = steadyNs();
  unwritten_.clear();
  problem_.clear();
}

std::uint32_t RecordJournal::open(const std::string& file, const RecordLayout& layout,
                                  std::uint64_t run_id) {
  if (entry_size_ == 0 || run_id != run_id_ || aboutOf(layout) != about_) start(layout, run_id);
  const bool waited = !unwritten_.empty();  // samples came before the file could be opened
  if (!waited) next_ = 0;
  lock(file);
  struct stat about {};
  try {
    require(fstat(file_, &about) == 0, file, strerror(errno));
    if (!goesOn(static_cast<std::uint64_t>(about.st_size))) writeHead();
  } catch (const InputError&) {
    ::close(file_);
    file_ = -1;
    throw;
  }
  flush();
  return waited ? 0 : static_cast<std::uint32_t>(next_);
}

// False: the file holds no sample, and may be begun.
bool RecordJournal::goesOn(std::uint64_t size) {
  std::ifstream stream(name_, std::ios::binary);
  const JournalHeader mine = headerOf(layout_, run_id_);
  JournalHeader found{};
  std::string about;
  const bool known = readHead(stream, found, about);
  const std::uint64_t head = sizeof found + about_.size();
  const bool same = known && sameLoop(found, mine) && about == about_ && found.run_id == run_id_;
  require(same || size <= sizeof found || (known && size <= sizeof found + about.size()), name_,
          "a journal of this run, or an empty one");
  if (!same) return false;
  if (next_ > 0) return true;  // what waits has its place
  began_ns_ = found.began_ns;
  layout_.first_step = static_cast<std::uint32_t>(found.first_step);
  next_ = (size - head) / (entry_size_ * sizeof(double));
  return true;
}

void RecordJournal::writeHead() {
  JournalHeader mine = headerOf(layout_, run_id_);
  mine.began_ns = began_ns_;
  unsynced_ = true;
  const bool done = ftruncate(file_, 0) == 0 && writeAt(file_, &mine, sizeof mine, 0) &&
                    writeAt(file_, about_.data(), about_.size(), sizeof mine);
  require(done, name_, std::string("room on the disk (") + strerror(errno) + ")");
}

bool RecordJournal::write(const Entries::value_type& entry) {
  const std::size_t bytes = entry_size_ * sizeof(double);
  const std::uint64_t offset = sizeof(JournalHeader) + about_.size() + entry.first * bytes;
  errno = ENOSPC;  // a write that ends early says nothing
  if (writeAt(file_, entry.second.data(), bytes, offset)) {
    problem_.clear();
    unsynced_ = true;
    return true;
  }
  problem_ = name_ + " cannot be written: " + strerror(errno);
  return false;
}

void RecordJournal::put(std::uint32_t step, const SampleRecord& sample) {
  if (entry_size_ == 0 || step < layout_.first_step) return;  // the part before is filed
  if (next_ == 0) {
    began_ns_ = steadyNs();
    if (file_ >= 0) writeAt(file_, &began_ns_, sizeof began_ns_, offsetof(JournalHeader, began_ns));
  }
  const std::uint64_t place = step - layout_.first_step;
  next_ = std::max(next_, place + 1);
  if (unwritten_.size() < kMostUnwritten || unwritten_.count(place) > 0)
    unwritten_[place] = packEntry(sample, JournalSizes(layout_));
  else
    ++lost_;
  if (problem_.empty()) flush();
}

void RecordJournal::flush() {
  while (file_ >= 0 && !unwritten_.empty() && write(*unwritten_.begin()))
    unwritten_.erase(unwritten_.begin());
}

bool RecordJournal::sync(double now_s) {
  if (file_ < 0 || !unsynced_ || now_s - synced_s_ < 1.0) return false;
  unsynced_ = ::fdatasync(file_) != 0;
  synced_s_ = now_s;
  return true;
}

void RecordJournal::beginNextPart() {
  layout_.first_step += static_cast<std::uint32_t>(next_);
  next_ = 0;
  writeHead();
}

std::uint64_t journalRun(const std::string& file, const RecordLayout& layout) {
  std::ifstream stream(file, std::ios::binary);
  JournalHeader header{};
  std::string about;
  return readHead(stream, header, about) && about == aboutOf(layout) ? header.run_id : 0;
}

std::optional<JournalLabel> journalLabel(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  JournalHeader header{};
  std::string about;
  if (!readHead(stream, header, about)) return {};
  const std::size_t name = about.find('\n');
  const std::size_t signals = name == std::string::npos ? name : about.find('\n', name + 1);
  if (signals == std::string::npos) return {};
  return JournalLabel{header.run_id, about.substr(0, name), about.substr(signals + 1),
                      stream.peek() == std::ifstream::traits_type::eof()};
}

JournalReader::JournalReader(const std::string& file, const RecordLayout& layout)
    : layout_(layout), stream_(file, std::ios::binary) {
  JournalHeader header{};
  std::string about;
  require(readHead(stream_, header, about) && sameLoop(header, headerOf(layout, 0)) &&
              about == aboutOf(layout),
          file, "a journal of the loop " + layout.loop);
  entry_.resize(JournalSizes(layout).entry());
  run_id_ = header.run_id;
  layout_.first_step = static_cast<std::uint32_t>(header.first_step);
}

void JournalReader::skip(std::uint64_t samples) {
  stream_.seekg(static_cast<std::streamoff>(samples * entry_.size() * sizeof(double)),
                std::ios::cur);
}

bool JournalReader::next(SampleRecord& sample) {
  const auto bytes = static_cast<std::streamsize>(entry_.size() * sizeof(double));
  if (!stream_.read(reinterpret_cast<char*>(entry_.data()), bytes)) return false;
  sample = unpackEntry(entry_.data(), JournalSizes(layout_));
  whole_ = whole_ && last_whole_;
  last_whole_ = layout_.isComplete(sample);
  final_ = sample.measurement.final;
  return true;
}

RunRecord readJournal(const std::string& file, const RecordLayout& layout) {
  RunRecord record = layout.emptyRecord();
  JournalReader reader(file, layout);
  for (SampleRecord sample; reader.next(sample);) record.samples.push_back(sample);
  conclude(record, reader.complete());
  return record;
}

}  // namespace fpc
