#include "fmbpc/loop/record_journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <utility>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr std::size_t kHeaderSize = 64;
constexpr std::size_t kTrouble = 16, kRemark = 32;  // doubles whose bytes hold words
constexpr char kMagic[8] = {'f', 'm', 'b', 'p', 'c', 'r', '0', '3'};

/// What must agree before entries are read as those of a loop.
struct FileHeader {
  char magic[8];
  std::uint64_t run_id;
  std::uint64_t sizes[5];  // outputs, disturbances, inputs, states, true disturbances
  std::uint64_t spare;
};
static_assert(sizeof(FileHeader) == kHeaderSize, "the header has no holes");

struct Sizes {
  std::size_t n_y, n_d, n_u, n_x, n_true;
  explicit Sizes(const RecordLayout& layout)
      : n_y(layout.info.outputs.size()),
        n_d(layout.info.disturbances.size()),
        n_u(layout.info.inputs.size()),
        n_x(layout.states.size()),
        n_true(layout.true_disturbances) {}
  /// Doubles of one sample: marks, times, measurement, state, tracking, base, action, report.
  std::size_t entry() const {
    return 4 + n_y + n_d + n_u + 1 + n_x + n_y + n_true + 2 + 2 * n_y + 2 * n_u + 5 + n_u +
           kTrouble + kRemark;
  }
};

FileHeader headerOf(const RecordLayout& layout, std::uint64_t run_id) {
  const Sizes s(layout);
  FileHeader header{{}, run_id, {s.n_y, s.n_d, s.n_u, s.n_x, s.n_true}, 0};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  return header;
}

bool sameLoop(const FileHeader& a, const FileHeader& b) {
  return std::memcmp(a.magic, b.magic, sizeof a.magic) == 0 &&
         std::memcmp(a.sizes, b.sizes, sizeof a.sizes) == 0;
}

/// Numbers one after the other; a whole number of 64 bits travels by its bits.
class Packer {
 public:
  explicit Packer(std::size_t size) { values_.reserve(size); }
  void number(double value) { values_.push_back(value); }
  void bits(std::uint64_t value) {
    double carrier;
    std::memcpy(&carrier, &value, sizeof value);
    values_.push_back(carrier);
  }
  void text(const std::string& words, std::size_t doubles) {
    std::string letters = words.substr(0, doubles * sizeof(double) - 1);
    letters.resize(doubles * sizeof(double));
    for (std::size_t i = 0; i < doubles; ++i) {
      std::uint64_t part;
      std::memcpy(&part, letters.data() + i * sizeof part, sizeof part);
      bits(part);
    }
  }
  void vector(const Vector& v, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i)
      values_.push_back(i < static_cast<std::size_t>(v.size())
                            ? v[static_cast<Eigen::Index>(i)]
                            : std::numeric_limits<double>::quiet_NaN());
  }
  std::vector<double> take() { return std::move(values_); }

 private:
  std::vector<double> values_;
};

class Unpacker {
 public:
  explicit Unpacker(const double* at) : at_(at) {}
  double number() { return *at_++; }
  std::uint64_t bits() {
    std::uint64_t value;
    std::memcpy(&value, at_++, sizeof value);
    return value;
  }
  std::string text(std::size_t doubles) {
    std::string letters(doubles * sizeof(double), '\0');
    std::memcpy(letters.data(), at_, letters.size());
    at_ += doubles;
    return letters.c_str();  // up to the first zero
  }
  Vector vector(std::size_t n) {
    const Vector v = Eigen::Map<const Vector>(at_, static_cast<Eigen::Index>(n));
    at_ += n;
    return v;
  }

 private:
  const double* at_;
};

std::uint64_t marksOf(const SampleRecord& s) {
  return std::uint64_t{s.has_measurement} | std::uint64_t{s.has_state} << 1 |
         std::uint64_t{s.has_tracking} << 2 | std::uint64_t{s.has_base} << 3 |
         std::uint64_t{s.has_action} << 4 | std::uint64_t{s.has_report} << 5 |
         std::uint64_t{s.measurement.final} << 6 | std::uint64_t{s.state.input_missing} << 7;
}

std::vector<double> pack(const SampleRecord& s, const Sizes& n) {
  Packer p(n.entry());
  p.bits(marksOf(s));
  p.bits(static_cast<std::uint64_t>(s.measurement.header.time_ns));
  p.bits(s.measurement.header.run_id);
  p.bits(s.measurement.header.step);
  p.vector(s.measurement.outputs, n.n_y);
  p.vector(s.measurement.disturbances, n.n_d);
  p.vector(s.measurement.input_applied, n.n_u);
  p.bits(s.state.actuator_clips);
  p.vector(s.state.state, n.n_x);
  p.vector(s.state.outputs, n.n_y);
  p.vector(s.state.disturbances, n.n_true);
  p.bits(static_cast<std::uint64_t>(s.base.source));
  p.bits(static_cast<std::uint64_t>(s.action.source));
  p.vector(s.tracking.setpoint, n.n_y);
  p.vector(s.tracking.reference, n.n_y);
  p.vector(s.base.input, n.n_u);
  p.vector(s.action.input, n.n_u);
  p.bits(static_cast<std::uint64_t>(s.report.status));
  p.bits(s.report.iterations);
  p.number(s.report.kkt_residual);
  p.number(s.report.seconds);
  p.bits(s.report.active_rows);
  p.vector(s.report.perturbation, n.n_u);
  p.text(s.state.trouble, kTrouble);
  p.text(s.remark, kRemark);
  return p.take();
}

SampleRecord unpack(const double* at, const Sizes& n) {
  Unpacker u(at);
  SampleRecord s;
  const std::uint64_t marks = u.bits();
  const auto marked = [marks](int bit) { return (marks >> bit & 1U) != 0; };
  s.has_measurement = marked(0);
  s.has_state = marked(1);
  s.has_tracking = marked(2);
  s.has_base = marked(3);
  s.has_action = marked(4);
  s.has_report = marked(5);
  s.measurement.final = marked(6);
  s.state.input_missing = marked(7);
  StepHeader header;
  header.time_ns = static_cast<std::int64_t>(u.bits());
  header.run_id = u.bits();
  header.step = static_cast<std::uint32_t>(u.bits());
  s.measurement.header = s.state.header = s.tracking.header = header;
  s.base.header = s.action.header = s.report.header = header;
  s.measurement.outputs = u.vector(n.n_y);
  s.measurement.disturbances = u.vector(n.n_d);
  s.measurement.input_applied = u.vector(n.n_u);
  s.state.actuator_clips = static_cast<std::uint32_t>(u.bits());
  s.state.state = u.vector(n.n_x);
  s.state.outputs = u.vector(n.n_y);
  s.state.disturbances = u.vector(n.n_true);
  s.base.source = static_cast<ActionSource>(u.bits());
  s.action.source = static_cast<ActionSource>(u.bits());
  s.tracking.setpoint = u.vector(n.n_y);
  s.tracking.reference = u.vector(n.n_y);
  s.base.input = u.vector(n.n_u);
  s.action.input = u.vector(n.n_u);
  s.report.status = static_cast<SolveStatus>(u.bits());
  s.report.iterations = static_cast<std::uint32_t>(u.bits());
  s.report.kkt_residual = u.number();
  s.report.seconds = u.number();
  s.report.active_rows = static_cast<std::uint32_t>(u.bits());
  s.report.perturbation = u.vector(n.n_u);
  s.state.trouble = u.text(kTrouble);
  s.remark = u.text(kRemark);
  return s;
}

bool readHeader(std::istream& stream, FileHeader& header) {
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
  entry_size_ = Sizes(layout).entry();
  written_ = lost_ = 0;
  unwritten_.clear();
  const FileHeader mine = headerOf(layout, run_id);
  FileHeader found{};
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
  unwritten_.push_back(pack(sample, Sizes(layout_)));
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
  FileHeader header{};
  if (!stream || !readHeader(stream, header)) return 0;
  return sameLoop(header, headerOf(layout, 0)) ? header.run_id : 0;
}

RunRecord readJournal(const std::string& file, const RecordLayout& layout) {
  std::ifstream stream(file, std::ios::binary);
  FileHeader header{};
  require(stream && readHeader(stream, header) && sameLoop(header, headerOf(layout, 0)), file,
          "a journal of the loop " + layout.loop);
  const Sizes sizes(layout);
  RunRecord record = layout.emptyRecord();
  std::vector<double> entry(sizes.entry());
  const auto bytes = static_cast<std::streamsize>(entry.size() * sizeof(double));
  bool whole = true;
  while (stream.read(reinterpret_cast<char*>(entry.data()), bytes)) {
    record.samples.push_back(unpack(entry.data(), sizes));
    whole = whole && layout.isComplete(record.samples.back());
  }
  conclude(record, whole && !record.samples.empty() && record.samples.back().measurement.final);
  return record;
}

}  // namespace fpc
