// What did not go as asked: the kinds of events (one table, docs/events.md), what is said of a
// sample, and the list that a run gathers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace fpc {

/// Values are those of Event.msg and of levels in diagnostics.
enum class Severity : std::uint8_t { kInfo = 0, kWarning = 1, kError = 2 };
const char* nameOf(Severity severity);  ///< "info", "warning", "error"

/// In the order of eventKinds(); names of codes are lower-case words (signal_frozen).
enum class EventCode : std::uint8_t {
  kNone,
  // measurements
  kSignalMissing,
  kSignalOutOfRange,
  kSignalTooFast,
  kSignalJumped,
  kSignalFrozen,
  kSignalNotRenewed,
  kMeasurementRejected,
  // the model
  kOutsideModel,
  kModelRefused,
  kModelGainTurned,
  kWeakDirection,
  kNoRuleFired,
  kIdentificationFailed,
  kOutputDelayed,
  kSetpointOutsideModel,
  // the law and the optimizer
  kNote,
  kLawFailed,
  kInputWithoutEffect,
  kHorizonTooShort,
  kSolverLimit,
  kPlanNotFound,
  kNoAllowedInput,
  kReferenceHeldBack,
  kLockUp,
  kOscillationGrows,
  kQpNotSolved,
  kBoundsConflict,
  kInputHeld,
  kFallbackActs,
  kNeverControlled,
  kInputAtLimit,
  kSoftLimitExceeded,
  // a candidate beside the law in charge
  kCandidateWatched,
  kCandidatePassed,
  kCandidateRefused,
  kCandidateOpen,
  kHandOver,
  kHandBack,
  // the target layer
  kTargetGivenUp,
  kTargetNotFound,
  kTargetUnbounded,
  kTargetNotSettled,
  kTargetsLate,
  // actuators and the plant
  kInputStuck,
  kActuatorIneffective,
  kPlantFailed,
  kPlantLocal,
  kPlantDiffers,
  // an operator
  kCommandRefused,
  kCommandsUnplayed,
  kSetpointClamped,
  kDisturbanceClamped,
  kInputClamped,
  kOperatorUnknown,
  // the loop file and the record
  kBeyondRun,
  kNominalOverruled,
  kCellsFilled,
  kCellsImplausible,
  kRecordUnused,
  kTimesRounded,
  kRecordGap,
  kRunIncomplete,
  // nodes and links
  kWaiting,
  kNoMeasurement,
  kNoAction,
  kNodeSilent,
  kNodeDegraded,
  kOptimizerLost,
  kIdentifierLate,
  kMessageRefused,
  kNotRecorded,
  kRecordingFailed,
  kLinkLost,
  kNetworkProblem,
  kPaused,
  kShutDown,
  kCannotStart,
};

struct EventKind {
  EventCode code;
  const char* name;  ///< stable: programs compare it
  Severity severity;
  const char *cause, *consequence, *remedy;  ///< sentences without a full stop
};
/// All of them but kNone, in the order of their codes.
const std::vector<EventKind>& eventKinds();
const EventKind& kindOf(EventCode code);  ///< of kNone: an empty name
/// @throws InputError for a name that is none.
EventCode eventCode(const std::string& name);
EventCode eventCodeOr(const std::string& name, EventCode other);  ///< `other` for such a name
std::string eventsPage();                                         ///< docs/events.md

/// One thing said of a sample. Signal and text live as long as who says it.
struct Notice {
  EventCode code{EventCode::kNone};
  const char* text{""};    ///< empty: the cause of its kind
  const char* signal{""};  ///< empty: of none
};

/// What is said of one sample, without allocation; what is beyond kMost is dropped.
class Notices {
 public:
  static constexpr std::size_t kMost = 12;
  void clear() { count_ = 0; }
  void add(const Notice& notice) {
    if (count_ < kMost) all_[count_++] = notice;
  }
  bool empty() const { return count_ == 0; }
  bool has(EventCode code) const;
  const Notice* begin() const { return all_.data(); }
  const Notice* end() const { return all_.data() + count_; }

 private:
  std::array<Notice, kMost> all_;
  std::size_t count_{};
};

/// Of a sample or of a run. `count` samples from `first` to `last`; 0: of the run as a whole.
struct Event {
  EventCode code{EventCode::kNone};
  std::string signal, text;
  std::uint32_t first{}, last{}, count{};

  Severity severity() const { return kindOf(code).severity; }
};
Event eventOf(const Notice& notice, std::uint32_t step);

/// Turns what was said of a sample into events, without allocation: their texts are used again.
class EventWriter {
 public:
  EventWriter();
  /// `events`: what this writer wrote before, or empty with room for Notices::kMost.
  void write(const Notices& said, std::uint32_t step, std::vector<Event>& events);

 private:
  std::vector<Event> spare_;
};
/// Of the run as a whole.
Event eventOf(EventCode code, const std::string& text = "", const std::string& signal = "");
std::vector<Event> joined(std::vector<Event> first, const std::vector<Event>& second);
/// Their texts, between semicolons: a line for a log.
std::string textOf(const std::vector<Event>& events);
bool contains(const std::vector<Event>& events, EventCode code);
/// The first one of the highest severity; of code kNone if there is none.
Event worstOf(const std::vector<Event>& events);

/// "0..40 [degC]", exact, for texts.
std::string rangeText(double lower, double upper, const std::string& unit);

/// The events of a run, in the order in which they came first. Memory is bounded: of one code and
/// signal at most kMostTexts differ, later ones count into the last.
class EventList {
 public:
  static constexpr std::size_t kMostTexts = 10;
  bool add(const Event& event);  ///< true: it is the first of its kind, signal and text
  void add(const std::vector<Event>& events) {
    for (const Event& event : events) add(event);
  }
  const std::vector<Event>& all() const { return events_; }
  void clear() { events_.clear(); }

 private:
  std::vector<Event> events_;
};

}  // namespace fpc
