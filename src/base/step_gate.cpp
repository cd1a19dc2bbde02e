#include "base/step_gate.hpp"

namespace fpc {
namespace {

constexpr int kStreak = 3;  // old steps in a row after which they count

bool follows(std::uint32_t step, std::uint32_t before) {
  return step == before || step == before + 1;
}

}  // namespace

bool StepGate::goesOnFromBefore(std::uint32_t step) const {
  if (!jumped_ || step <= before_) return false;
  if (unconfirmed_ && step == before_ + 1) return true;
  return streak_ + 1 >= kStreak && follows(step, streak_step_);
}

Arrival StepGate::classify(const StepHeader& header) const {
  if (announced_ && header.run_id != *announced_) return Arrival::kOtherRun;
  if (empty_) return Arrival::kFirst;
  if (header.run_id != last_.run_id)
    return announced_ || header.run_id > last_.run_id ? Arrival::kNewRun : Arrival::kOtherRun;
  if (header.step == last_.step) return Arrival::kRepeat;
  if (header.step < last_.step)
    return goesOnFromBefore(header.step) ? Arrival::kResync : Arrival::kOld;
  if (header.step == last_.step + 1) return Arrival::kNext;
  const bool far = header.step - last_.step > kFarthest;
  const bool confirmed = suspect_ && follows(header.step, *suspect_);
  return far && !confirmed ? Arrival::kSuspect : Arrival::kGap;
}

// What is needed to judge the next arrivals: strays that follow each other may be the truth.
void StepGate::watch(std::uint32_t step, Arrival arrival) {
  if (arrival == Arrival::kSuspect) suspect_ = step;
  if (arrival == Arrival::kRepeat) unconfirmed_ = false;
  if (arrival != Arrival::kOld || !jumped_ || step <= before_) return;
  streak_ = streak_ > 0 && follows(step, streak_step_) ? streak_ + 1 : 1;
  streak_step_ = step;
}

void StepGate::remember(const StepHeader& header, Arrival arrival) {
  if (arrival == Arrival::kGap) {
    before_ = last_.step;
    jumped_ = unconfirmed_ = true;
  } else if (arrival == Arrival::kFirst || arrival == Arrival::kNewRun) {
    before_ = -1;
    jumped_ = header.step > 0;
    unconfirmed_ = false;
  } else {
    jumped_ = jumped_ && arrival == Arrival::kNext;
    unconfirmed_ = false;
  }
  streak_ = 0;
  suspect_.reset();
  ++counts_.accepted;
  last_ = header;
  empty_ = false;
}

Arrival StepGate::pass(const StepHeader& header) {
  const Arrival arrival = classify(header);
  switch (arrival) {
    case Arrival::kRepeat:
      ++counts_.repeated;
      break;
    case Arrival::kOld:
      ++counts_.old;
      break;
    case Arrival::kSuspect:
      ++counts_.suspect;
      break;
    case Arrival::kOtherRun:
      ++counts_.other_run;
      break;
    case Arrival::kGap:
      ++counts_.gaps;
      break;
    case Arrival::kResync:
      ++counts_.resyncs;
      break;
    case Arrival::kNewRun:
      ++counts_.new_runs;
      break;
    case Arrival::kFirst:
    case Arrival::kNext:
      break;
  }
  if (isNew(arrival))
    remember(header, arrival);
  else if (arrival != Arrival::kOtherRun)
    watch(header.step, arrival);
  return arrival;
}

}  // namespace fpc
