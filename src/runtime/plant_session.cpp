#include "runtime/plant_session.hpp"

#include <algorithm>
#include <utility>

namespace fpc {
namespace {
constexpr double kNever = kInfinity;
constexpr double kRecordTimeout = 5.0;  // [s]: as long as one that is started again needs
}  // namespace

PlantPolicy lockstepPolicy(const LoopFile& loop) {
  PlantPolicy policy;
  policy.stuck = loop.stuck;
  return policy;
}

PlantPolicy ringPolicy(const LoopFile& loop) {
  PlantPolicy policy = lockstepPolicy(loop);
  policy.pace = loop.exchange.pace;
  policy.period_s = loop.simulation.sample_time_s / loop.exchange.speedup;
  policy.action_timeout_s = loop.exchange.action_timeout_s;
  const auto& names = loop.exchange.wait_for;
  const bool waits = std::count(names.begin(), names.end(), "loop_recorder") > 0;
  if (waits && !loop.external_plant) policy.record_timeout_s = kRecordTimeout;
  return policy;
}

PlantSession::PlantSession(std::unique_ptr<Process> process, const PlantPolicy& policy)
    : process_(std::move(process)),
      policy_(policy),
      pacer_(policy.pace, policy.period_s),
      action_wait_(policy.action_timeout_s),
      record_wait_(policy.record_timeout_s),
      stuck_(policy.stuck, process_->actuator().params().limits, process_->info().inputs) {}

PlantSession::PlantSession(Simulation simulation, const PlantPolicy& policy)
    : PlantSession(std::make_unique<SimulatedProcess>(std::move(simulation)), policy) {}

void PlantSession::begin(std::uint64_t run_id) {
  process_->reset(run_id);
  phase_ = PlantPhase::kWaiting;
  have_action_ = starving_ = acknowledged_ = false;
  recorder_keeps_up_ = true;
  steps_allowed_ = 0;
  stuck_.reset();
}

void PlantSession::start(double now_s) {
  phase_ = process_->measurement().final ? PlantPhase::kFinished : PlantPhase::kRunning;
  pacer_.restart(now_s);
  putOnTable(now_s);
}

void PlantSession::putOnTable(double now_s) {
  table_since_s_ = sent_s_ = now_s;
  have_action_ = recorded_ = false;
  action_wait_.begin(now_s);
  record_wait_.end();
}

bool PlantSession::recorded(const StepHeader& sample) {
  const StepHeader& now = process_->measurement().header;
  if (sample.run_id != now.run_id || sample.step != now.step) return false;
  recorded_ = recorder_keeps_up_ = true;
  const bool awaited = awaitsRecorder();
  record_wait_.end();
  return awaited;
}

/// True as well if that is not waited for (any more).
bool PlantSession::isRecorded(double now_s) {
  if (policy_.record_timeout_s <= 0.0 || recorded_ || !recorder_keeps_up_) return true;
  if (!awaitsRecorder()) {
    unrecorded_since_s_ = now_s;
    record_wait_.begin(now_s);
  }
  if (!record_wait_.isOver(now_s)) return false;
  recorder_keeps_up_ = false;
  record_wait_.end();
  return true;
}

// What an action is wrong in does not depend on when it comes.
bool PlantSession::receive(const ControlAction& action) {
  if (action.header.run_id != runId()) {
    ++counts_.other_run;
    return false;
  }
  if (action.input.size() != static_cast<Eigen::Index>(process_->info().inputs.size())) {
    ++counts_.wrong_size;
    return false;
  }
  if (!action.input.allFinite()) {
    ++counts_.not_finite;
    return false;
  }
  const bool awaited = phase_ == PlantPhase::kRunning && !have_action_;
  if (!awaited || !process_->answers(action.header)) {
    countStray(action.header);
    return false;
  }
  ++counts_.accepted;
  action_ = action.input;
  const bool of_law =
      action.source != ActionSource::kManual && action.source != ActionSource::kFallback;
  if (policy_.stuck.hold && of_law) stuck_.hold(action_, process_->actuator().applied());
  process_->take(action_);
  have_action_ = true;
  starving_ = false;
  return true;
}

// Dropped, each kind apart: for a later sample, the last answer again, older.
void PlantSession::countStray(const StepHeader& header) {
  const std::uint32_t now = process_->measurement().header.step;
  const std::uint32_t answered = have_action_ ? now + 1 : now;  // samples answered so far
  if (header.step >= answered)
    ++counts_.later;
  else if (header.step + 1 == answered)
    ++counts_.repeated;
  else
    ++counts_.old;
}

bool PlantSession::mayGoWithout(double now_s) {
  if (paused_ || policy_.pace == Pace::kLockstep) return false;
  if (policy_.pace == Pace::kRealtime || starving_) return true;
  return action_wait_.isOver(now_s);
}

bool PlantSession::advance(double now_s) {
  if (phase_ != PlantPhase::kRunning || (paused_ && steps_allowed_ == 0)) return false;
  if (!paused_ && !pacer_.due(now_s)) return false;
  if (have_action_) {
    if (!isRecorded(now_s)) return false;
    before_ = process_->measurement().input_applied;
    process_->advance(action_);
    if (process_->takesActions())
      stuck_.look(action_, before_, process_->positions());
    else if (!process_->underWay())
      stuck_.reset();  // somebody else has the inputs
  } else if (mayGoWithout(now_s)) {
    process_->advanceWithoutAction();
    ++missing_inputs_;
    starving_ = policy_.pace == Pace::kPaced;
  } else {
    return false;
  }
  if (paused_) --steps_allowed_;
  pacer_.sent(now_s);
  putOnTable(now_s);
  if (process_->measurement().final) phase_ = PlantPhase::kFinished;
  return true;
}

double PlantSession::nextDue() const {
  if (phase_ != PlantPhase::kRunning || paused_ || !pacer_.timed()) return kNever;
  if (awaitsRecorder()) return record_wait_.nextLook();
  if (have_action_ || starving_ || policy_.pace == Pace::kRealtime) return pacer_.deadline();
  return std::max(pacer_.deadline(), action_wait_.nextLook());
}

bool PlantSession::mustResend(double now_s) {
  const bool unanswered = phase_ == PlantPhase::kRunning && !have_action_;
  const bool unheard = phase_ == PlantPhase::kFinished && (!acknowledged_ || !isRecorded(now_s));
  return (unanswered || unheard || awaitsRecorder()) && now_s - sent_s_ >= policy_.resend_s;
}

void PlantSession::resent(double now_s) { sent_s_ = now_s; }

double PlantSession::unansweredFor(double now_s) const {
  return phase_ == PlantPhase::kRunning && !have_action_ ? now_s - table_since_s_ : 0.0;
}

void PlantSession::pause(bool on, double now_s) {
  paused_ = on;
  steps_allowed_ = 0;
  if (on) return;
  pacer_.restart(now_s);
  table_since_s_ = now_s;
  action_wait_.begin(now_s);
}

bool PlantSession::step() {
  if (!paused_ || phase_ != PlantPhase::kRunning) return false;
  ++steps_allowed_;
  return true;
}

}  // namespace fpc
