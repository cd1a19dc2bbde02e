#include "runtime/journal_entry.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <sstream>
#include <utility>

namespace fpc {
namespace {

// Doubles whose bytes hold words.
constexpr std::size_t kTrouble = 16, kEvents = (kMostOfEvents + 1) / sizeof(double);
constexpr std::uint64_t kMostAbout = 1U << 26U;  // bytes
constexpr char kMagic[8] = {'f', 'm', 'b', 'p', 'c', 'r', '0', '6'};

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

/// "code<tab>signal<tab>text", as many whole lines as there is room for.
std::string linesOf(const std::vector<Event>& events) {
  std::string lines;
  for (const Event& event : events) {
    const std::string line =
        std::string(kindOf(event.code).name) + '\t' + event.signal + '\t' + event.text + '\n';
    if (lines.size() + line.size() > kMostOfEvents) break;
    lines += line;
  }
  return lines;
}

std::vector<Event> eventsIn(const std::string& lines, std::uint32_t step) {
  std::vector<Event> events;
  std::istringstream stream(lines);
  for (std::string code, signal, text; std::getline(stream, code, '\t') &&
                                       std::getline(stream, signal, '\t') &&
                                       std::getline(stream, text);)
    events.push_back({eventCode(code), signal, text, step, step, 1});
  return events;
}

std::uint64_t marksOf(const SampleRecord& s) {
  return std::uint64_t{s.has_measurement} | std::uint64_t{s.has_state} << 1 |
         std::uint64_t{s.has_tracking} << 2 | std::uint64_t{s.has_base} << 3 |
         std::uint64_t{s.has_action} << 4 | std::uint64_t{s.has_report} << 5 |
         std::uint64_t{s.measurement.final} << 6 | std::uint64_t{s.state.input_missing} << 7;
}

}  // namespace

JournalSizes::JournalSizes(const RecordLayout& layout)
    : n_y(layout.info.outputs.size()),
      n_d(layout.info.disturbances.size()),
      n_u(layout.info.inputs.size()),
      n_x(layout.states.size()),
      n_true(layout.true_disturbances) {}

std::size_t JournalSizes::entry() const {
  return 4 + n_y + n_d + n_u + 1 + n_x + n_y + n_true + 2 + 2 * n_y + 2 * n_u + 5 + n_u + kTrouble +
         kEvents;
}

void keepWhatFits(std::vector<Event>& events) {
  if (events.empty()) return;
  const std::string lines = linesOf(events);
  events.resize(static_cast<std::size_t>(std::count(lines.begin(), lines.end(), '\n')));
}

JournalHeader headerOf(const RecordLayout& layout, std::uint64_t run_id) {
  const JournalSizes s(layout);
  JournalHeader header{
      {}, run_id,           {s.n_y, s.n_d, s.n_u, s.n_x, s.n_true}, aboutOf(layout).size(),
      0,  layout.first_step};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  return header;
}

bool sameLoop(const JournalHeader& a, const JournalHeader& b) {
  return std::memcmp(a.magic, b.magic, sizeof a.magic) == 0 &&
         std::memcmp(a.sizes, b.sizes, sizeof a.sizes) == 0 && a.about_bytes == b.about_bytes;
}

std::string aboutOf(const RecordLayout& layout) {
  std::string signals;
  for (const auto* part : {&layout.info.outputs, &layout.info.inputs, &layout.info.disturbances}) {
    for (const SignalInfo& signal : *part) signals += signal.name + " ";
    signals += "| ";
  }
  for (const std::string& state : layout.states) signals += state + " ";
  return layout.loop + "\n" + signals + "\n" + layout.text;
}

bool readHead(std::istream& stream, JournalHeader& header, std::string& about) {
  if (!stream.read(reinterpret_cast<char*>(&header), sizeof header)) return false;
  if (std::memcmp(header.magic, kMagic, sizeof kMagic) != 0 || header.about_bytes > kMostAbout)
    return false;
  about.resize(header.about_bytes);
  return static_cast<bool>(stream.read(about.data(), static_cast<std::streamsize>(about.size())));
}

std::vector<double> packEntry(const SampleRecord& s, const JournalSizes& n) {
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
  p.text(linesOf(s.events), kEvents);
  return p.take();
}

SampleRecord unpackEntry(const double* at, const JournalSizes& n) {
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
  s.events = eventsIn(u.text(kEvents), header.step);
  return s;
}

}  // namespace fpc
