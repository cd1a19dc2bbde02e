#include "fmbpc/loop/record_journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/loop/journal_reader.hpp"
#include "loop/journal_entry.hpp"

namespace fpc {
namespace {

constexpr std::size_t kHeaderSize = sizeof(JournalHeader);

bool readHeader(std::istream& stream, JournalHeader& header) {
  return static_cast<bool>(stream.read(reinterpret_cast<char*>(&header), sizeof header));
}

}  // namespace

RecordJournal::~RecordJournal() { close(); }

void RecordJournal::close() {
  if (file_ < 0) return;
  flush();
  ::close(file_);
  file_ = -1;
}

std::uint32_t RecordJournal::open(const std::string& file, const RecordLayout& layout,
                                  std::uint64_t run_id) {
  close();
  name_ = file;
  layout_ = layout;
  entry_size_ = JournalSizes(layout).entry();
  written_ = lost_ = 0;
  unwritten_.clear();
  const JournalHeader mine = headerOf(layout, run_id);
  JournalHeader found{};
  file_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  require(file_ >= 0, file, std::string("a file that can be written (") + strerror(errno) + ")");
  require(flock(file_, LOCK_EX | LOCK_NB) == 0, file,
          "that no other recorder writes here: another loop is running with this folder");
  const bool known = ::pread(file_, &found, sizeof found, 0) == sizeof found &&
                     sameLoop(found, mine) && found.run_id == run_id;
  struct stat about {};
  if (known && fstat(file_, &about) == 0)
    written_ =
        (static_cast<std::uint64_t>(about.st_size) - kHeaderSize) / (entry_size_ * sizeof(double));
  const bool fresh =
      known || (ftruncate(file_, 0) == 0 && ::pwrite(file_, &mine, sizeof mine, 0) == sizeof mine);
  require(fresh, file, std::string("room on the disk (") + strerror(errno) + ")");
  return static_cast<std::uint32_t>(written_);
}

bool RecordJournal::write(const std::vector<double>& entry) {
  const std::size_t bytes = entry.size() * sizeof(double);
  const auto offset = static_cast<off_t>(kHeaderSize + written_ * bytes);
  const ssize_t done = ::pwrite(file_, entry.data(), bytes, offset);
  if (done == static_cast<ssize_t>(bytes)) {
    ++written_;
    problem_.clear();
    return true;
  }
  problem_ = name_ + " cannot be written: " + (done < 0 ? strerror(errno) : "the disk is full");
  return false;
}

void RecordJournal::append(const SampleRecord& sample) {
  if (file_ < 0) return;
  unwritten_.push_back(packEntry(sample, JournalSizes(layout_)));
  if (problem_.empty()) flush();
  if (unwritten_.size() <= kMostUnwritten) return;
  unwritten_.pop_back();  // those before it still fit their places
  ++lost_;
}

void RecordJournal::flush() {
  while (file_ >= 0 && !unwritten_.empty() && write(unwritten_.front())) unwritten_.pop_front();
}

std::uint64_t journalRun(const std::string& file, const RecordLayout& layout) {
  std::ifstream stream(file, std::ios::binary);
  JournalHeader header{};
  if (!stream || !readHeader(stream, header)) return 0;
  return sameLoop(header, headerOf(layout, 0)) ? header.run_id : 0;
}

JournalReader::JournalReader(const std::string& file, const RecordLayout& layout)
    : layout_(layout), stream_(file, std::ios::binary) {
  JournalHeader header{};
  require(stream_ && readHeader(stream_, header) && sameLoop(header, headerOf(layout, 0)), file,
          "a journal of the loop " + layout.loop);
  entry_.resize(JournalSizes(layout).entry());
}

bool JournalReader::next(SampleRecord& sample) {
  const auto bytes = static_cast<std::streamsize>(entry_.size() * sizeof(double));
  if (!stream_.read(reinterpret_cast<char*>(entry_.data()), bytes)) return false;
  sample = unpackEntry(entry_.data(), JournalSizes(layout_));
  whole_ = whole_ && layout_.isComplete(sample);
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
