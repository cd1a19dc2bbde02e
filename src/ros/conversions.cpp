#include "ros/conversions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/no_value.hpp"
#include "conversion_parts.hpp"

namespace fpc {

using conversion::enumeration;
using conversion::fillHeader;
using conversion::list;
using conversion::number;
using conversion::numbers;
using conversion::stepHeader;
using conversion::structs;
using conversion::vector;

static_assert(fmbpc::ControlAction::BASE == number(ActionSource::kBase));
static_assert(fmbpc::ControlAction::CONSTRAINED == number(ActionSource::kConstrained));
static_assert(fmbpc::ControlAction::CLIPPED == number(ActionSource::kClipped));
static_assert(fmbpc::ControlAction::HELD == number(ActionSource::kHeld));
static_assert(fmbpc::ControlAction::MANUAL == number(ActionSource::kManual));
static_assert(fmbpc::ControlAction::FALLBACK == number(ActionSource::kFallback));
static_assert(fmbpc::ControlAction::GUARDED == number(ActionSource::kGuarded));

static_assert(fmbpc::SolverReport::SOLVED == number(SolveStatus::kSolved));
static_assert(fmbpc::SolverReport::INFEASIBLE == number(SolveStatus::kInfeasible));
static_assert(fmbpc::SolverReport::ITERATION_LIMIT == number(SolveStatus::kIterationLimit));
static_assert(fmbpc::SolverReport::NUMERICAL_ERROR == number(SolveStatus::kNumericalError));
static_assert(fmbpc::SolverReport::INVALID_PROBLEM == number(SolveStatus::kInvalidProblem));
static_assert(fmbpc::SolverReport::NOT_RUN == number(SolveStatus::kNotRun));
static_assert(fmbpc::SolverReport::BOUND_WINS == number(SolveStatus::kBoundWins));
static_assert(fmbpc::SolverReport::INCONSISTENT == number(SolveStatus::kInconsistent));

static_assert(fmbpc::Setpoint::OVERRIDE == number(CommandMode::kOverride));
static_assert(fmbpc::Setpoint::OFFSET == number(CommandMode::kOffset));
static_assert(fmbpc::Setpoint::RELEASE == number(CommandMode::kRelease));
static_assert(fmbpc::Disturbance::OVERRIDE == number(CommandMode::kOverride));
static_assert(fmbpc::Disturbance::OFFSET == number(CommandMode::kOffset));
static_assert(fmbpc::Disturbance::RELEASE == number(CommandMode::kRelease));

ros::Time toStamp(std::int64_t time_ns) {
  constexpr std::int64_t kLast = (std::int64_t{1} << 32) * 1000000000 - 1;
  require(time_ns >= 0 && time_ns <= kLast, "stamp", "a time from 0 to 2^32 s");
  ros::Time stamp;
  stamp.fromNSec(static_cast<std::uint64_t>(time_ns));
  return stamp;
}

std::int64_t fromStamp(const ros::Time& stamp) { return static_cast<std::int64_t>(stamp.toNSec()); }

fmbpc::Matrix toMsg(const Matrix& matrix) {
  fmbpc::Matrix msg;
  msg.rows = static_cast<std::uint32_t>(matrix.rows());
  msg.cols = static_cast<std::uint32_t>(matrix.cols());
  msg.data.reserve(static_cast<std::size_t>(matrix.size()));
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) msg.data.push_back(matrix(i, j));
  return msg;
}

// An empty matrix of four billion columns has no data and would keep a reader busy for a minute.
constexpr std::uint32_t kMostRows = 100000;

Matrix fromMsg(const fmbpc::Matrix& msg) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  require(msg.data.size() == std::uint64_t{msg.rows} * msg.cols, "matrix", "rows * cols numbers");
  require(std::max(msg.rows, msg.cols) <= kMostRows, "matrix",
          "at most " + std::to_string(kMostRows) + " rows and columns");
  return Eigen::Map<const RowMajor>(msg.data.data(), msg.rows, msg.cols);
}

fmbpc::SignalInfo toMsg(const SignalInfo& signal) {
  fmbpc::SignalInfo msg;
  msg.name = signal.name;
  msg.unit = signal.unit;
  msg.lower = signal.lower;
  msg.upper = signal.upper;
  return msg;
}

SignalInfo fromMsg(const fmbpc::SignalInfo& msg) {
  return {msg.name, msg.unit, msg.lower, msg.upper};
}

fmbpc::PlantInfo toMsg(const PlantInfo& info) {
  fmbpc::PlantInfo msg;
  fillHeader(msg, info.header);
  msg.name = info.name;
  msg.frame_id = info.frame_id;
  msg.sample_time_s = info.sample_time_s;
  msg.outputs = list<fmbpc::SignalInfo>(info.outputs);
  msg.inputs = list<fmbpc::SignalInfo>(info.inputs);
  msg.disturbances = list<fmbpc::SignalInfo>(info.disturbances);
  msg.output_frames = info.output_frames;
  return msg;
}

PlantInfo fromMsg(const fmbpc::PlantInfo& msg) {
  require(msg.output_frames.size() == msg.outputs.size(), "output_frames", "one per output");
  PlantInfo info;
  info.header = stepHeader(msg);
  info.name = msg.name;
  info.frame_id = msg.frame_id;
  info.sample_time_s = msg.sample_time_s;
  info.outputs = structs<SignalInfo>(msg.outputs);
  info.inputs = structs<SignalInfo>(msg.inputs);
  info.disturbances = structs<SignalInfo>(msg.disturbances);
  info.output_frames = msg.output_frames;
  return info;
}

namespace {

NoValue reasonOf(std::uint8_t quality) {
  if (quality == fmbpc::Measurement::STALE) return NoValue::kStale;
  return quality == fmbpc::Measurement::MISSING ? NoValue::kMissing : NoValue::kNoNumber;
}

}  // namespace

fmbpc::Measurement toMsg(const Measurement& measurement) {
  fmbpc::Measurement msg;
  fillHeader(msg, measurement.header);
  msg.outputs = numbers(measurement.outputs);
  msg.disturbances = numbers(measurement.disturbances);
  msg.input_applied = numbers(measurement.input_applied);
  msg.final = measurement.final;
  return msg;
}

Measurement fromMsg(const fmbpc::Measurement& msg) {
  Measurement m{stepHeader(msg), vector(msg.outputs), vector(msg.disturbances),
                vector(msg.input_applied), msg.final != 0};
  const std::size_t n_y = msg.outputs.size();
  const bool fits = msg.quality.empty() || msg.quality.size() == n_y + msg.disturbances.size();
  require(fits, "quality", "one per output and disturbance, or none");
  for (std::size_t i = 0; i < msg.quality.size(); ++i)
    if (msg.quality[i] != fmbpc::Measurement::GOOD)
      (i < n_y ? m.outputs[static_cast<Eigen::Index>(i)]
               : m.disturbances[static_cast<Eigen::Index>(i - n_y)]) =
          noValue(reasonOf(msg.quality[i]));
  return m;
}

fmbpc::ControlAction toMsg(const ControlAction& action) {
  fmbpc::ControlAction msg;
  fillHeader(msg, action.header);
  msg.input = numbers(action.input);
  msg.source = number(action.source);
  return msg;
}

ControlAction fromMsg(const fmbpc::ControlAction& msg) {
  return {stepHeader(msg), vector(msg.input),
          enumeration(msg.source, ActionSource::kBase, ActionSource::kGuarded, "source")};
}

fmbpc::PredictiveAction toMsg(const PredictiveAction& action) {
  fmbpc::PredictiveAction msg;
  fillHeader(msg, action.header);
  msg.state = numbers(action.state);
  msg.A = toMsg(action.A);
  msg.B = toMsg(action.B);
  msg.C = toMsg(action.C);
  msg.offset_state = numbers(action.offset_state);
  msg.offset_output = numbers(action.offset_output);
  msg.K = toMsg(action.K);
  msg.feedforward = toMsg(action.feedforward);
  msg.reference = toMsg(action.reference);
  msg.setpoint = numbers(action.setpoint);
  msg.input_base_unclipped = numbers(action.input_base_unclipped);
  msg.input_previous = numbers(action.input_previous);
  msg.input_lower = numbers(action.input_lower);
  msg.input_upper = numbers(action.input_upper);
  msg.output_lower = numbers(action.output_lower);
  msg.output_upper = numbers(action.output_upper);
  return msg;
}

PredictiveAction fromMsg(const fmbpc::PredictiveAction& msg) {
  return {stepHeader(msg),
          vector(msg.state),
          fromMsg(msg.A),
          fromMsg(msg.B),
          fromMsg(msg.C),
          vector(msg.offset_state),
          vector(msg.offset_output),
          fromMsg(msg.K),
          fromMsg(msg.feedforward),
          fromMsg(msg.reference),
          vector(msg.setpoint),
          vector(msg.input_base_unclipped),
          vector(msg.input_previous),
          vector(msg.input_lower),
          vector(msg.input_upper),
          vector(msg.output_lower),
          vector(msg.output_upper)};
}

fmbpc::Targets toMsg(const Targets& targets) {
  fmbpc::Targets msg;
  fillHeader(msg, targets.header);
  msg.outputs = numbers(targets.outputs);
  msg.inputs = numbers(targets.inputs);
  msg.output_lower = numbers(targets.output_lower);
  msg.output_upper = numbers(targets.output_upper);
  msg.cost = targets.cost;
  msg.found = targets.found;
  return msg;
}

Targets fromMsg(const fmbpc::Targets& msg) {
  return {stepHeader(msg),
          vector(msg.outputs),
          vector(msg.inputs),
          vector(msg.output_lower),
          vector(msg.output_upper),
          msg.cost,
          msg.found != 0};
}

fmbpc::SolverReport toMsg(const SolverReport& report) {
  fmbpc::SolverReport msg;
  fillHeader(msg, report.header);
  msg.perturbation = numbers(report.perturbation);
  msg.status = number(report.status);
  msg.iterations = report.iterations;
  msg.kkt_residual = report.kkt_residual;
  msg.seconds = report.seconds;
  msg.active_rows = report.active_rows;
  return msg;
}

SolverReport fromMsg(const fmbpc::SolverReport& msg) {
  return {stepHeader(msg),
          vector(msg.perturbation),
          enumeration(msg.status, SolveStatus::kSolved, SolveStatus::kInconsistent, "status"),
          msg.iterations,
          msg.kkt_residual,
          msg.seconds,
          msg.active_rows};
}

static_assert(fmbpc::Event::INFO == number(Severity::kInfo));
static_assert(fmbpc::Event::WARNING == number(Severity::kWarning));
static_assert(fmbpc::Event::ERROR == number(Severity::kError));

fmbpc::Event toMsg(const Event& event) {
  fmbpc::Event msg;
  msg.code = kindOf(event.code).name;
  msg.severity = number(event.severity());
  msg.signal = event.signal;
  msg.first = event.first;
  msg.last = event.last;
  msg.count = event.count;
  msg.text = event.text;
  return msg;
}

Event fromMsg(const fmbpc::Event& msg) {
  Event event = eventOf(
      {eventCodeOr(msg.code, EventCode::kNote), msg.text.c_str(), msg.signal.c_str()}, msg.first);
  event.last = msg.last;
  event.count = msg.count;
  return event;
}

std::vector<fmbpc::Event> toMsg(const std::vector<Event>& events) {
  return list<fmbpc::Event>(events);
}

std::vector<Event> fromMsg(const std::vector<fmbpc::Event>& msg) { return structs<Event>(msg); }

fmbpc::Tracking toMsg(const Tracking& tracking) {
  fmbpc::Tracking msg;
  fillHeader(msg, tracking.header);
  msg.setpoint = numbers(tracking.setpoint);
  msg.reference = numbers(tracking.reference);
  return msg;
}

Tracking fromMsg(const fmbpc::Tracking& msg) {
  return {stepHeader(msg), vector(msg.setpoint), vector(msg.reference)};
}

fmbpc::PlantState toMsg(const PlantState& state) {
  fmbpc::PlantState msg;
  fillHeader(msg, state.header);
  msg.state = numbers(state.state);
  msg.outputs = numbers(state.outputs);
  msg.disturbances = numbers(state.disturbances);
  msg.actuator_clips = state.actuator_clips;
  msg.input_missing = state.input_missing;
  msg.trouble = state.trouble;
  return msg;
}

PlantState fromMsg(const fmbpc::PlantState& msg) {
  return {stepHeader(msg),    vector(msg.state),      vector(msg.outputs), vector(msg.disturbances),
          msg.actuator_clips, msg.input_missing != 0, msg.trouble};
}

}  // namespace fpc
