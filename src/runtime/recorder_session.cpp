#include "runtime/recorder_session.hpp"

#include <algorithm>
#include <utility>

#include "runtime/journal_entry.hpp"
#include "runtime/missing_parts.hpp"

namespace fpc {
namespace {

constexpr std::size_t kMostGaps = 100;  // that are named
constexpr std::uint32_t kBelieved = 5;  // measurements far ahead that follow each other

}  // namespace

RecorderSession::RecorderSession(RecordLayout layout, Sink sink)
    : layout_(std::move(layout)), sink_(std::move(sink)) {}

void RecorderSession::announce(std::uint64_t run_id) {
  if (run_id_ == run_id) return;
  run_id_ = run_id;
  gate_.announce(run_id);
  next_ = 0;
  window_.clear();
  latest_ = {};
  final_.reset();
  gaps_.clear();
  gap_count_ = 0;
  for (const auto& deliver : std::exchange(early_, {})) deliver();
}

void RecorderSession::resume(std::uint64_t run_id, std::uint32_t next_step) {
  auto early = std::exchange(early_, {});
  announce(run_id);
  next_ = next_step;
  for (const auto& deliver : early) deliver();
}

bool RecorderSession::holds(const StepHeader& sample) const {
  if (run_id_ != sample.run_id) return false;
  if (sample.step < next_) return true;
  const std::size_t place = sample.step - next_;
  return place < window_.size() && layout_.isComplete(window_[place]);
}

SampleRecord* RecorderSession::at(std::uint32_t step) {
  if (step < next_) return nullptr;
  const std::size_t place = step - next_;
  if (place >= window_.size()) window_.resize(place + 1);
  return &window_[place];
}

template <typename Item, typename Place>
void RecorderSession::collect(const Item& item, bool SampleRecord::*has, Place place) {
  if (!layout_.fits(item)) {
    ++wrong_size_;
    return;
  }
  const StepHeader& header = item.header;
  if (run_id_ != header.run_id) {
    if (!run_id_ && early_.size() < kMostEarly)
      early_.push_back([this, item, has, place] { collect(item, has, place); });
    else
      ++strays_;
    return;
  }
  const bool beyond = header.step >= next_ && header.step - next_ >= kWindow;
  if (beyond || (final_ && header.step > *final_)) {
    ++strays_;
    return;
  }
  SampleRecord* sample = at(header.step);
  if (sample == nullptr || sample->*has) return;  // repeated
  place(*sample, item);
  sample->*has = true;
  passOn();
}

// A stray far ahead would fill the disk with holes: it counts only when others follow it and
// nothing near comes between (the recorder was away for long).
bool RecorderSession::farAhead(std::uint32_t step) {
  const std::uint32_t now = std::max(next_, latest_.step);
  if (step < now || step - now < kWindow) {
    far_streak_ = 0;
    return false;
  }
  if (far_streak_ == 0 || step != far_step_ + 1)
    far_streak_ = far_streak_ > 0 && step == far_step_ ? far_streak_ : 1;
  else
    ++far_streak_;
  far_step_ = step;
  return far_streak_ < kBelieved;
}

void RecorderSession::receive(const Measurement& m) {
  if (run_id_ == m.header.run_id && layout_.fits(m)) {
    if (farAhead(m.header.step)) {
      ++strays_;
      return;
    }
    const Arrival arrival = gate_.pass(m.header);
    if (arrival == Arrival::kSuspect) {
      ++strays_;
      return;
    }
    if (final_ && m.header.step > *final_) final_.reset();  // a plant that goes on has not ended
    while (isNew(arrival) && m.header.step >= next_ && m.header.step - next_ >= kWindow)
      emitFront();  // what has been waiting longest is given up
  }
  collect(m, &SampleRecord::has_measurement, [this](SampleRecord& sample, const Measurement& item) {
    sample.measurement = item;  // only the loop's last sample has no action
    sample.measurement.final =
        item.final && (layout_.samples == 0 || item.header.step == layout_.samples);
    if (item.header.step >= latest_.step) latest_ = item.header;
    if (item.final) final_ = item.header.step;
  });
}

// The controller's events before the plant's, whoever was heard first.
void RecorderSession::receive(const PlantState& s, const std::vector<Event>& events) {
  collect(s, &SampleRecord::has_state, [events](SampleRecord& sample, const PlantState& item) {
    sample.state = item;
    sample.events.insert(sample.events.end(), events.begin(), events.end());
    keepWhatFits(sample.events);
  });
}

void RecorderSession::receive(const Tracking& t, const std::vector<Event>& events) {
  const auto place = [this, events](SampleRecord& sample, const Tracking& item) {
    sample.tracking = item;
    sample.events.insert(sample.events.begin(), events.begin(), events.end());
    keepWhatFits(sample.events);
    for (const Eigen::Index i : layout_.without_setpoint)
      sample.tracking.setpoint[i] = sample.tracking.reference[i] = kNaN;
  };
  collect(t, &SampleRecord::has_tracking, place);
}

void RecorderSession::receiveBase(const ControlAction& a) {
  if (!layout_.has_optimizer) return receiveAction(a);
  collect(a, &SampleRecord::has_base,
          [](SampleRecord& sample, const ControlAction& item) { sample.base = item; });
}

// Without an optimizer the base action is what the plant is told.
void RecorderSession::receiveAction(const ControlAction& a) {
  collect(a, &SampleRecord::has_action, [this](SampleRecord& sample, const ControlAction& item) {
    sample.action = item;
    if (layout_.has_optimizer) return;
    sample.base = item;
    sample.has_base = true;
  });
}

void RecorderSession::receive(const SolverReport& r) {
  collect(r, &SampleRecord::has_report,
          [](SampleRecord& sample, const SolverReport& item) { sample.report = item; });
}

void RecorderSession::noteGaps(const SampleRecord& s, std::uint32_t step, std::size_t limit,
                               std::vector<std::string>& lines) const {
  forMissingParts(s, layout_.has_optimizer, layout_.has_state, [&](const char* what) {
    if (lines.size() < limit) lines.push_back("sample " + std::to_string(step) + ": no " + what);
  });
}

void RecorderSession::emitFront() {
  if (window_.empty()) window_.emplace_back();
  const SampleRecord& sample = window_.front();
  if (!layout_.isComplete(sample)) {
    ++gap_count_;
    noteGaps(sample, next_, kMostGaps, gaps_);
    std::vector<std::string> lines;
    noteGaps(sample, next_, 1, lines);
    last_gap_ = lines.front();
  }
  sink_(sample);
  window_.pop_front();
  ++next_;
}

void RecorderSession::passOn() {
  while (!window_.empty() && layout_.isComplete(window_.front())) emitFront();
}

void RecorderSession::giveUpBefore(std::uint32_t step) {
  while (next_ < step && !window_.empty()) emitFront();
  passOn();
}

std::uint32_t RecorderSession::wholeBefore() const {
  std::size_t place = window_.size();
  while (place > 0 && !layout_.isComplete(window_[place - 1])) --place;
  return next_ + static_cast<std::uint32_t>(place);
}

// A run that was cut short ends with the last measurement; its action is not missed.
void RecorderSession::close() {
  while (!window_.empty() && !window_.back().has_measurement) window_.pop_back();
  while (!window_.empty()) emitFront();
}

std::vector<std::string> RecorderSession::gaps(std::size_t limit) const {
  std::vector<std::string> lines(
      gaps_.begin(), gaps_.begin() + static_cast<std::ptrdiff_t>(std::min(limit, gaps_.size())));
  for (std::size_t i = 0; i < window_.size() && lines.size() < limit; ++i)
    noteGaps(window_[i], next_ + static_cast<std::uint32_t>(i), limit, lines);
  return lines;
}

}  // namespace fpc
