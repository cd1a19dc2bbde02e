#include "runtime/run_events.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/text.hpp"
#include "runtime/missing_parts.hpp"
#include "runtime/session.hpp"

namespace fpc {
namespace {

constexpr double kRounding = 1e-6;           // of a limit: what a solver leaves
constexpr double kAtBound = 1e-9;            // of an input's range
constexpr std::uint32_t kLeastAtBound = 10;  // samples, and a tenth of the run

/// Of an optimizer that answers, what a law asks for is always solved.
bool stoodIn(const SampleRecord& sample) {
  return sample.has_action && sample.report.status == SolveStatus::kNotRun &&
         needsPrediction(sample.action.source);
}

}  // namespace

Notice noticeOf(SolveStatus status) {
  switch (status) {
    case SolveStatus::kSolved:
    case SolveStatus::kNotRun:
      return {};
    case SolveStatus::kInfeasible:
      return {EventCode::kQpNotSolved, "infeasible: clipped"};
    case SolveStatus::kIterationLimit:
      return {EventCode::kQpNotSolved, "iteration limit: clipped"};
    case SolveStatus::kNumericalError:
      return {EventCode::kQpNotSolved, "numerical error: clipped"};
    case SolveStatus::kInvalidProblem:
      return {EventCode::kQpNotSolved, "invalid problem: clipped"};
    case SolveStatus::kInconsistent:
      return {EventCode::kQpNotSolved, "base action and prediction disagree: clipped"};
    case SolveStatus::kBoundWins:
      return {EventCode::kBoundsConflict};
  }
  return {EventCode::kQpNotSolved};
}

RunEvents::RunEvents(const LoopFile& loop, std::uint32_t first_step)
    : loop_(loop),
      has_domain_(hasDomain(loop)),
      stuck_(loop.stuck, loop.simulation.actuator.limits, loop.plant_info.inputs),
      at_lower_(loop.plant_info.inputs.size()),
      at_upper_(at_lower_),
      moved_(movedInputs(loop)),
      step_(first_step) {
  if (!loop.has_clp) return;
  addLimits(-1.0);
  addLimits(1.0);
}

void RunEvents::addLimits(double sign) {
  const Vector& limits = sign < 0.0 ? loop_.clp.output_lower : loop_.clp.output_upper;
  const char* key = sign < 0.0 ? "clp.output_lower" : "clp.output_upper";
  for (Eigen::Index i = 0; i < limits.size(); ++i) {
    if (!std::isfinite(limits[i])) continue;
    const SignalInfo& output = loop_.plant_info.outputs[static_cast<std::size_t>(i)];
    soft_.push_back({i, sign, limits[i], output.name,
                     output.name + (sign < 0.0 ? " below" : " above") + " its soft limit, " +
                         exactText(limits[i]) +
                         (output.unit.empty() ? "" : " [" + output.unit + "]") + " (" + key + ")"});
  }
}

void RunEvents::add(const SampleRecord& sample, const Rejections& rejected) {
  addSaid(sample);
  addRejected(sample, rejected);
  addSources(sample);
  addSolve(sample);
  watchInputs(sample);
  watchBounds(sample);
  watchOutputs(sample);
  watchGaps(sample);
  ++step_;
}

void RunEvents::addSaid(const SampleRecord& sample) {
  for (Event event : sample.events) {
    event.first = event.last = step_;
    event.count = 1;
    list_.add(event);
  }
}

/// Scores without them would be silent of them.
void RunEvents::addRejected(const SampleRecord& sample, const Rejections& rejected) {
  if (!sample.has_measurement) return;
  const auto& outputs = loop_.plant_info.outputs;
  for (std::size_t i = 0; i < outputs.size() && sample.has_tracking; ++i)
    if (rejected.of(i)) say({EventCode::kMeasurementRejected, "", outputs[i].name.c_str()}, step_);
  if (!has_domain_ || !isOutsideModel(loop_, sample, rejected)) return;
  ++outside_model_;
  if (!contains(sample.events, EventCode::kOutsideModel)) say({EventCode::kOutsideModel}, step_);
}

void RunEvents::addSources(const SampleRecord& sample) {
  if (!sample.has_action) return;
  const bool held = sample.action.source == ActionSource::kHeld;
  const bool fallback = sample.action.source == ActionSource::kFallback;
  if (held) say({EventCode::kInputHeld}, step_);
  if (fallback) say({EventCode::kFallbackActs}, step_);
  last_action_ = step_;
  ++actions_;
  lost_ += held || fallback;
}

void RunEvents::addSolve(const SampleRecord& sample) {
  if (!loop_.has_clp || !sample.has_report) return;
  if (stoodIn(sample)) say({EventCode::kOptimizerLost}, step_);
  const Notice notice = noticeOf(sample.report.status);
  if (notice.code != EventCode::kNone) say(notice, step_);
}

/// u(k - 1) is known from sample k.
void RunEvents::watchInputs(const SampleRecord& sample) {
  if (!before_.has_action || !sample.has_measurement) {
    stuck_.reset();
  } else {
    stuck_.look(before_.action.input, before_.measurement.input_applied,
                sample.measurement.input_applied);
    if (!stuck_.words().empty())
      say({EventCode::kInputStuck, stuck_.words().c_str(), stuck_.input().c_str()}, step_ - 1);
  }
  before_.has_action = sample.has_action && sample.has_measurement;
  if (!before_.has_action) return;
  before_.action.input = sample.action.input;
  before_.measurement.input_applied = sample.measurement.input_applied;
}

void RunEvents::watchBounds(const SampleRecord& sample) {
  if (!sample.has_action) return;
  const InputLimits& limits = loop_.simulation.actuator.limits;
  for (std::size_t i = 0; i < moved_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double u = sample.action.input[k], range = limits.upper[k] - limits.lower[k];
    const double tolerance = kAtBound * (std::isfinite(range) ? range : 1.0);
    at_lower_[i] = std::abs(u - limits.lower[k]) <= tolerance ? at_lower_[i] + 1 : 0;
    at_upper_[i] = std::abs(u - limits.upper[k]) <= tolerance ? at_upper_[i] + 1 : 0;
  }
}

void RunEvents::watchOutputs(const SampleRecord& sample) {
  if (step_ == 0 || (!sample.has_state && !sample.has_measurement))
    return;  // nothing was decided before the first
  const Vector& outputs = sample.has_state ? sample.state.outputs : sample.measurement.outputs;
  for (const SoftLimit& soft : soft_) {
    const double beyond = soft.sign * (outputs[soft.output] - soft.limit);
    if (beyond > kRounding * std::max(1.0, std::abs(soft.limit)))
      say({EventCode::kSoftLimitExceeded, soft.text.c_str(), soft.name.c_str()}, step_);
  }
}

/// What a sample lacks is a gap once another one follows.
void RunEvents::watchGaps(const SampleRecord& sample) {
  for (const char* what : missing_) list_.add(gapEvent(what, step_ - 1));
  missing_.clear();
  forMissingParts(sample, loop_.has_clp, !loop_.external_plant,
                  [this](const char* what) { missing_.push_back(what); });
}

Event gapEvent(const std::string& what, std::uint32_t step) {
  const std::string text = "no " + what + " in the record";
  return eventOf({EventCode::kRecordGap, text.c_str(), what.c_str()}, step);
}

EventList RunEvents::finish() const {
  EventList list = list_;
  const std::uint32_t least = std::max(kLeastAtBound, actions_ / 10);
  for (std::size_t i = 0; i < moved_.size(); ++i)
    for (const bool upper : {false, true}) {
      const std::uint32_t samples = upper ? at_upper_[i] : at_lower_[i];
      if (!moved_[i] || samples < least) continue;
      Event event = eventOf(
          EventCode::kInputAtLimit,
          std::string("at its ") + (upper ? "upper" : "lower") + " limit up to the end of the run",
          loop_.plant_info.inputs[i].name);
      event.count = samples;
      event.last = last_action_;
      event.first = last_action_ + 1 - samples;
      list.add(event);
    }
  if (actions_ > 0 && lost_ == actions_) list.add(eventOf(EventCode::kNeverControlled));
  return list;
}

}  // namespace fpc
