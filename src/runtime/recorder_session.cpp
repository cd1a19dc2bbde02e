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
  waiting_.clear();
  latest_ = {};
  final_.reset();
  gaps_.clear();
  gap_count_ = 0;
  for (const auto& deliver : std::exchange(early_, {})) deliver();
}

void RecorderSession::resume(std::uint64_t run_id, std::uint32_t next_step, Samples unfinished) {
  auto early = std::exchange(early_, {});
  announce(run_id);
  next_ = next_step;
  for (auto& [step, sample] : unfinished) waiting_[step].sample = std::move(sample);
  for (const auto& deliver : early) deliver();
}

bool RecorderSession::holds(const StepHeader& sample) const {
  return run_id_ == sample.run_id && sample.step < next_ && waiting_.count(sample.step) == 0;
}

void RecorderSession::reach(std::uint32_t step) {
  for (; next_ <= step; ++next_) {
    if (waiting_.size() >= kWindow) giveUpFirst();
    waiting_[next_];
  }
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
  reach(header.step);
  const auto found = waiting_.find(header.step);
  if (found == waiting_.end() || found->second.sample.*has) return;  // repeated
  SampleRecord& sample = found->second.sample;
  place(sample, item);
  sample.*has = found->second.changed = true;
  if (!layout_.isComplete(sample)) return;
  sink_(header.step, sample);
  waiting_.erase(found);
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
    if (isNew(arrival)) reach(m.header.step);
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

void RecorderSession::giveUpFirst() {
  const auto first = waiting_.begin();
  ++gap_count_;
  noteGaps(first->second.sample, first->first, kMostGaps, gaps_);
  if (first->second.changed) sink_(first->first, first->second.sample);
  waiting_.erase(first);
}

// A part that is on its way comes within a moment: what is written twice would cost more.
void RecorderSession::keep() {
  for (auto& [step, waits] : waiting_) {
    if (step >= latest_.step) break;
    if (std::exchange(waits.seen, true) && std::exchange(waits.changed, false))
      sink_(step, waits.sample);
  }
}

// A run that was cut short ends with the last measurement; its action is not missed.
void RecorderSession::close() {
  for (auto last = waiting_.find(next_ - 1);
       last != waiting_.end() && !last->second.sample.has_measurement;
       last = waiting_.find(next_ - 1)) {
    waiting_.erase(last);
    --next_;
  }
  while (!waiting_.empty()) giveUpFirst();
}

std::vector<std::string> RecorderSession::gaps(std::size_t limit) const {
  std::vector<std::string> lines(
      gaps_.begin(), gaps_.begin() + static_cast<std::ptrdiff_t>(std::min(limit, gaps_.size())));
  for (auto at = waiting_.begin(); at != waiting_.end() && lines.size() < limit; ++at)
    noteGaps(at->second.sample, at->first, limit, lines);
  return lines;
}

std::vector<std::pair<std::uint32_t, std::string>> RecorderSession::incomplete(
    std::uint32_t from, std::uint32_t before) const {
  std::vector<std::pair<std::uint32_t, std::string>> all;
  for (auto at = waiting_.lower_bound(from); at != waiting_.end() && at->first < before; ++at) {
    std::string first;
    forMissingParts(at->second.sample, layout_.has_optimizer, layout_.has_state,
                    [&](const char* what) { first = first.empty() ? what : first; });
    all.emplace_back(at->first, first);
  }
  return all;
}

bool RecorderSession::lacks() const {
  return latest_.step > 0 && waiting_.count(latest_.step - 1) > 0 &&
         waiting_.count(latest_.step) > 0;
}

}  // namespace fpc
