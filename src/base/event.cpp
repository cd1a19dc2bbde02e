#include "fmbpc/base/event.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using C = EventCode;
constexpr Severity kI = Severity::kInfo, kW = Severity::kWarning, kE = Severity::kError;

constexpr std::size_t kMostOfText = 300;  // of a text
constexpr EventKind kUnknownKind{C::kNone, "", kI, "", "", ""};

// code, name, severity, cause, consequence, remedy.
// clang-format off
constexpr EventKind kKinds[] = {
    {C::kSignalMissing, "signal_missing", kW, "a measurement is no number, is stale or has not come", "the model's value or the last good one is used, then the input is held, then the fallback acts (plausibility)", "look at the sensor and its link"},
    {C::kSignalOutOfRange, "signal_out_of_range", kW, "a measurement lies outside plausibility.signals: lower, upper", "as signal_missing", "look at the sensor; widen the range if such values are true"},
    {C::kSignalTooFast, "signal_too_fast", kW, "a measurement changes faster than plausibility.signals: rate_per_h", "as signal_missing", "look at the sensor; raise rate_per_h if the process is that fast"},
    {C::kSignalJumped, "signal_jumped", kW, "a measurement jumped by more than plausibility.signals: jump", "as signal_missing", "look at the sensor; a new level is accepted after 3 samples"},
    {C::kSignalFrozen, "signal_frozen", kW, "a measurement does not move although its own noise or the other signals say that it must", "an output: the model's value is used or the fallback acts; a disturbance: its usual or last value is used", "look at the sensor and what converts its value"},
    {C::kSignalNotRenewed, "signal_not_renewed", kI, "a reading is the same, to the bit, as the one before", "the model's value bridges it", "look at the link, which repeats old values"},
    {C::kMeasurementRejected, "measurement_rejected", kI, "the controller did not accept a measurement of an output", "it is not in the scores; where the plant's own value is known, that one is", "see the event that says why"},
    {C::kOutsideModel, "outside_model", kW, "the plant is where the identification of the model had no data", "moves shrink, and the PI of section guard acts if there is one (signal model_trust)", "bring the plant back, or identify the model again with data from there"},
    {C::kModelRefused, "model_refused", kW, "a new model does not fit, is unstable or turns the sign of a gain", "the model before it stays in force", "read the text; look at the data that it was made from"},
    {C::kModelGainTurned, "model_gain_turned", kW, "a new model turns the sign of a gain", "it is used", "compare both models with a step of the plant"},
    {C::kWeakDirection, "weak_direction", kI, "some inputs, moved together in one way, have next to no effect in the model", "a small error of the model turns the sign there", "weigh their moves (weight_move), or identify with moves in that direction"},
    {C::kNoRuleFired, "no_rule_fired", kW, "no rule of the model fires", "the nearest rule is used", "identify the model again with data from there"},
    {C::kIdentificationFailed, "identification_failed", kW, "an identification gave no model", "the loop goes on with the model that it has", "read the text: rows, signals or structure"},
    {C::kOutputDelayed, "output_delayed", kW, "an output shows an input later than the model expects (tf.sample_lines)", "the law expects an answer that cannot have come", "identify the model with that delay in it"},
    {C::kSetpointOutsideModel, "setpoint_outside_model", kI, "a setpoint of the loop file lies where the model has no data", "see outside_model", "change the setpoint, or identify with data from there"},
    {C::kNote, "note", kI, "a plugin, or a node of others, says something", "the text says it", "see its own pages"},
    {C::kLawFailed, "law_failed", kE, "the law gave no finite input", "the input is held", "look at the model and at the tuning"},
    {C::kInputWithoutEffect, "input_without_effect", kW, "an input has no effect on the outputs at controller.coincidence_steps", "the input is held or rests", "set the horizon behind the longest delay"},
    {C::kHorizonTooShort, "horizon_too_short", kW, "controller.horizon_steps is too short: an input hardly acts within it", "the plan does not see what the input does", "set the horizon behind the longest delay"},
    {C::kSolverLimit, "solver_limit", kW, "a search or solver reached its limit", "the best plan found so far is used", "raise the limit (iterations), or shorten the horizon"},
    {C::kPlanNotFound, "plan_not_found", kW, "the solver found no usable plan", "the plan of the sample before goes on", "look at weights, limits and the model"},
    {C::kNoAllowedInput, "no_allowed_input", kW, "no sequence of inputs is allowed", "the nearest allowed input is sent", "look at controller.inputs and the input's position"},
    {C::kReferenceHeldBack, "reference_held_back", kI, "an output is farther from its reference than controller.reference_holdback", "the law aims at a nearer reference", "none, after an upset; else raise reference_holdback"},
    {C::kLockUp, "lock_up", kW, "an input stands at a bound while the error stays, and goes on with less of it", "its bound is drawn in by 0.3 of the range", "the gain's sign differs from the model's there"},
    {C::kOscillationGrows, "oscillation_grows", kW, "an input swings further each time: law and plant are not stable together", "the PI of section guard acts until the law begins anew (guard.growing_swings)", "name slow valves and analysers (actuator.lag, sensors.NAME.t90_s); weigh the moves"},
    {C::kQpNotSolved, "qp_not_solved", kW, "the constraint optimizer has no solution for this sample", "the base action is clipped and sent", "read the text: limits that cannot all hold, or an iteration limit"},
    {C::kBoundsConflict, "bounds_conflict", kW, "move limit and bound of an input conflict", "the bound wins", "look at where the input was before"},
    {C::kInputHeld, "input_held", kW, "the controller had no usable answer", "the last applied input stays", "see the event of the same samples that says why"},
    {C::kFallbackActs, "fallback_acts", kW, "no usable answer for longer than the loop file allows, or no data for the model", "the configured fallback acts", "see the event of the same samples that says why"},
    {C::kNeverControlled, "never_controlled", kE, "every input was held or the fallback", "the run says nothing of the controller", "see input_held"},
    {C::kInputAtLimit, "input_at_limit", kW, "an input stood at one of its limits from some sample to the end of the run", "the loop was not closed over these samples", "look at sizing, setpoint and lock_up"},
    {C::kSoftLimitExceeded, "soft_limit_exceeded", kI, "an output is beyond clp.output_lower or clp.output_upper", "the optimizer brings it back as fast as the inputs allow", "none, or wider limits"},
    {C::kCandidateWatched, "candidate_watched", kI, "a candidate runs beside the law in charge and moves nothing", "it is judged", "none"},
    {C::kCandidatePassed, "candidate_passed", kI, "a candidate has passed its trial", "it may be handed over", "`fmbpc handover`, unless candidate.automatic"},
    {C::kCandidateRefused, "candidate_refused", kW, "a candidate's model is wrong, or it gave no input", "the law in charge stays; the candidate is not handed over", "read the text; identify the model again"},
    {C::kCandidateOpen, "candidate_open", kI, "what was seen does not say whether a candidate's model is right", "it is watched on", "move the setpoint or the inputs that the text names"},
    {C::kHandOver, "hand_over", kI, "a candidate was handed the inputs, or more authority", "it is watched; the former law is kept", "`fmbpc handover --back` takes them back"},
    {C::kHandBack, "hand_back", kW, "a candidate did not keep what was promised, or an operator asked for it", "the former law is back in charge", "read the text; watch the candidate anew"},
    {C::kTargetGivenUp, "target_given_up", kI, "limits, setpoints or resting values of section targets cannot all be kept at rest", "the lowest ranks are given up, each by the least amount", "none, or wider zones; look at the order of the ranks"},
    {C::kTargetNotFound, "target_not_found", kW, "no target can be found: a signal is missing, the model has no rest, or the solver fails", "the last good target stays", "look at the model; an output that integrates needs targets.outputs: integrating"},
    {C::kTargetUnbounded, "target_unbounded", kW, "a price of section targets drives an integrating output where no limit holds it", "the last good target stays", "give it a zone, or take the price out"},
    {C::kTargetNotSettled, "target_not_settled", kI, "targets of a model whose gains bend had not settled after five rounds", "the last of them is used; the next sample goes on from there", "none"},
    {C::kTargetsLate, "targets_late", kW, "no targets of target_optimizer have come for a sample", "the law goes on with the last ones", "start target_optimizer again"},
    {C::kInputStuck, "input_stuck", kW, "an input does not follow its command, or is not read back", "the command is held there if plausibility.stuck asks for it", "look at the actuator"},
    {C::kActuatorIneffective, "actuator_ineffective", kW, "the outputs do not react to an input as the model says", "the law goes on", "look at the actuator behind its position signal"},
    {C::kPlantFailed, "plant_failed", kE, "the simulated plant could not be moved over a sample", "its state is held; the run is not complete", "look at parameters, inputs and integrator"},
    {C::kPlantLocal, "plant_local", kW, "the plant takes no actions: its own hand has the input, its link is lost, or no input follows", "its own input is sent back; the controller begins anew later", "give the plant back"},
    {C::kPlantDiffers, "plant_differs", kW, "the plant announces itself otherwise than the loop file says", "other bounds: the law goes on; anything else: it is refused", "mend the loop file"},
    {C::kCommandRefused, "command_refused", kW, "an operator's command cannot be done", "nothing changes", "read the text"},
    {C::kCommandsUnplayed, "commands_unplayed", kI, "the run ended before the time of an operator's command", "it never acted", "lengthen the run"},
    {C::kSetpointClamped, "setpoint_clamped", kW, "a setpoint was asked beyond setpoint.lower, .upper", "the limit is followed", "change the setpoint or the limit"},
    {C::kDisturbanceClamped, "disturbance_clamped", kW, "an offset leads a disturbance out of the plant's range", "the disturbance stays in its range", "ask for less"},
    {C::kInputClamped, "input_clamped", kW, "an input was asked, by hand or as input/NAME, beyond the actuator's limits", "it stays inside them", "ask for less"},
    {C::kOperatorUnknown, "operator_unknown", kW, "a controller joined a run without what its operator had asked", "the input is held until ~manual is called", "call `fmbpc auto` or `fmbpc manual`"},
    {C::kBeyondRun, "beyond_run", kI, "something of the loop file begins after the end of the run", "it never acts", "lengthen the run, or take it out"},
    {C::kNominalOverruled, "nominal_overruled", kI, "disturbance.nominal names a disturbance that a pattern gives", "the pattern's values count", "take one of them out"},
    {C::kCellsFilled, "cells_filled", kI, "cells of the disturbance record are missing", "they are held or interpolated, as the loop file asks", "look at the record"},
    {C::kCellsImplausible, "cells_implausible", kW, "cells of the disturbance record lie outside their range", "they are filled", "look at the record"},
    {C::kRecordUnused, "record_unused", kW, "only the first row of the disturbance record falls into the run", "it never changes", "check disturbance.csv.time_unit"},
    {C::kTimesRounded, "times_rounded", kI, "rows of the disturbance record come just after a sample", "they act from the next one", "write the times with more digits"},
    {C::kRecordGap, "record_gap", kW, "a message of a sample is not in the record", "the run is not complete", "look at the network, and at who stopped"},
    {C::kRunIncomplete, "run_incomplete", kW, "the final sample did not come, or a message lacks", "scores are of a part of the run", "see record_gap; let the run end"},
    {C::kWaiting, "waiting", kI, "a node waits for another one", "the run has not begun", "the text and `missing` name it"},
    {C::kNoMeasurement, "no_measurement", kE, "no measurement comes although one is due", "the controller does nothing", "look at the plant"},
    {C::kNoAction, "no_action", kE, "no action comes although one is due", "lockstep: the plant waits; realtime: the input is held, then the fallback", "look at controller and optimizer"},
    {C::kNodeSilent, "node_silent", kW, "a node says nothing any more", "the loop goes on without it as far as it can", "`missing` names it: start it again"},
    {C::kNodeDegraded, "node_degraded", kW, "another node is not as it should be", "as the text says", "see the events of that node"},
    {C::kOptimizerLost, "optimizer_lost", kW, "the constraint optimizer does not answer", "the base action goes to the plant", "start clp_optimizer again"},
    {C::kIdentifierLate, "identifier_late", kW, "the identifier is not done with the sample before", "in lockstep the controller waits for it", "wait, or look at fuzzy_identifier"},
    {C::kMessageRefused, "message_refused", kW, "a message was dropped: it does not fit", "it has no effect", "the text says what was expected"},
    {C::kNotRecorded, "not_recorded", kW, "the recorder has not said that a sample is on disk", "the plant waits, or ends without a record", "look at loop_recorder"},
    {C::kRecordingFailed, "recording_failed", kE, "the record cannot be written", "samples wait in memory", "make room, or rights, in the folder"},
    {C::kLinkLost, "link_lost", kW, "the gateway's link to the plant, or a signal on it, is lost", "inputs stay what they are at the plant", "look at the link"},
    {C::kNetworkProblem, "network_problem", kW, "a node cannot be reached from elsewhere", "its messages do not arrive there", "set ROS_IP or ROS_HOSTNAME; the text says where"},
    {C::kPaused, "paused", kI, "an operator paused the plant", "the run stands still", "call plant_simulator/pause with false"},
    {C::kShutDown, "shut_down", kW, "the plant's process was told to end", "the run ends early", "launch it again, unless that was meant"},
    {C::kCannotStart, "cannot_start", kE, "a node cannot start", "the loop does not run", "read the text"},
};
// clang-format on

constexpr bool inOrder() {
  std::size_t place = 0;
  for (const EventKind& kind : kKinds)
    if (static_cast<std::size_t>(kind.code) != ++place) return false;
  return place == static_cast<std::size_t>(C::kCannotStart);
}
static_assert(inOrder(), "one row for each code, in the order of the codes");

}  // namespace

const char* nameOf(Severity severity) {
  switch (severity) {
    case Severity::kInfo:
      return "info";
    case Severity::kWarning:
      return "warning";
    case Severity::kError:
      break;
  }
  return "error";
}

const std::vector<EventKind>& eventKinds() {
  static const std::vector<EventKind> all(std::begin(kKinds), std::end(kKinds));
  return all;
}

const EventKind& kindOf(EventCode code) {
  const auto place = static_cast<std::size_t>(code);
  return place == 0 || place > std::size(kKinds) ? kUnknownKind : kKinds[place - 1];
}

EventCode eventCodeOr(const std::string& name, EventCode other) {
  for (const EventKind& kind : kKinds)
    if (name == kind.name) return kind.code;
  return other;
}

EventCode eventCode(const std::string& name) {
  const EventCode code = eventCodeOr(name, EventCode::kNone);
  if (code != EventCode::kNone) return code;
  throw InputError("event '" + name + "': expected one of docs/events.md");
}

std::string eventsPage() {
  std::string page =
      "# Events\n\nFor everybody who runs a loop: what each event means and what to do. "
      "summary.json (`events`), the table of `fmbpc run`, `loop_state`, the diagnostics and `fmbpc "
      "watch` show the same list: code, severity, signal, first and last sample, number of "
      "samples, text. Codes do not change; texts may. `fmbpc events > docs/events.md` writes this "
      "page.\n\n| code | severity | cause | consequence | remedy |\n|---|---|---|---|---|\n";
  for (const EventKind& kind : kKinds)
    page += std::string("| `") + kind.name + "` | " + nameOf(kind.severity) + " | " + kind.cause +
            " | " + kind.consequence + " | " + kind.remedy + " |\n";
  return page;
}

bool Notices::has(EventCode code) const {
  return std::any_of(begin(), end(), [&](const Notice& notice) { return notice.code == code; });
}

namespace {

void put(const Notice& notice, std::uint32_t step, Event& event) {
  const char* text = *notice.text == '\0' ? kindOf(notice.code).cause : notice.text;
  event.code = notice.code;
  event.signal.assign(notice.signal, strnlen(notice.signal, kMostOfText));
  event.text.assign(text, strnlen(text, kMostOfText));
  event.first = event.last = step;
  event.count = 1;
  for (std::string* words : {&event.signal, &event.text})
    std::replace_if(
        words->begin(), words->end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
}

}  // namespace

Event eventOf(const Notice& notice, std::uint32_t step) {
  Event event;
  put(notice, step, event);
  return event;
}

EventWriter::EventWriter() : spare_(Notices::kMost) {
  for (Event& event : spare_) {
    event.signal.reserve(kMostOfText);
    event.text.reserve(kMostOfText);
  }
}

void EventWriter::write(const Notices& said, std::uint32_t step, std::vector<Event>& events) {
  for (; !events.empty(); events.pop_back()) spare_.push_back(std::move(events.back()));
  for (const Notice& notice : said) {
    put(notice, step, spare_.back());
    events.push_back(std::move(spare_.back()));
    spare_.pop_back();
  }
}

Event eventOf(EventCode code, const std::string& text, const std::string& signal) {
  Event event = eventOf({code, text.c_str(), signal.c_str()}, 0);
  event.count = 0;
  return event;
}

std::vector<Event> joined(std::vector<Event> first, const std::vector<Event>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

std::string textOf(const std::vector<Event>& events) {
  std::vector<std::string> texts;
  for (const Event& event : events) texts.push_back(event.text);
  return join(texts, "; ");
}

std::string rangeText(double lower, double upper, const std::string& unit) {
  return exactText(lower) + ".." + exactText(upper) + (unit.empty() ? "" : " [" + unit + "]");
}

bool contains(const std::vector<Event>& events, EventCode code) {
  return std::any_of(events.begin(), events.end(),
                     [&](const Event& event) { return event.code == code; });
}

Event worstOf(const std::vector<Event>& events) {
  const auto worst =
      std::max_element(events.begin(), events.end(),
                       [](const Event& a, const Event& b) { return a.severity() < b.severity(); });
  return worst == events.end() ? Event() : *worst;
}

bool EventList::add(const Event& event) {
  Event* last = nullptr;
  std::size_t texts = 0;
  for (Event& known : events_) {
    if (known.code != event.code || known.signal != event.signal) continue;
    last = &known;
    ++texts;
    if (known.text == event.text) {
      texts = kMostTexts;
      break;
    }
  }
  if (texts < kMostTexts) {
    events_.push_back(event);
    return true;
  }
  last->last = event.last;
  last->count += event.count;
  return false;
}

}  // namespace fpc
