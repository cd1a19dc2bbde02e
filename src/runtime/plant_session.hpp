// The plant as a member of the exchange: which actions it takes, when it moves on, and what it does
// when none comes. The node and the run in one process are made of it.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>

#include "plant/process.hpp"
#include "runtime/own_wait.hpp"
#include "runtime/pacer.hpp"
#include "runtime/stuck_watch.hpp"

namespace fpc {

struct PlantPolicy {
  Pace pace{Pace::kLockstep};
  double period_s{};           ///< wall time per sample (paced, realtime)
  double action_timeout_s{5};  ///< paced: wall time (OwnWait) after which the plant goes on without
  double resend_s{0.05};       ///< an unanswered sample is sent again that often
  /// Wall time (OwnWait) that a sample waits for its recorder; 0: it does not.
  double record_timeout_s{};
  StuckParams stuck;
};

/// Of a plant that moves on as soon as its sample is answered, whatever the loop's pace.
PlantPolicy lockstepPolicy(const LoopFile& loop);
/// As section `loop` says.
PlantPolicy ringPolicy(const LoopFile& loop);

enum class PlantPhase { kWaiting, kRunning, kFinished };

/// Actions, each kind apart.
struct ActionCounts {
  std::uint64_t accepted{}, repeated{}, old{}, later{}, other_run{}, wrong_size{}, not_finite{};
};

/// Times are seconds on a steady clock of the caller's. Rules:
/// - only a finite action of the right size for the sample on the table is taken, and only the
///   first; all others are counted;
/// - lockstep moves on when it has come and waits for ever; paced also waits for the period, and
///   for action_timeout_s at most: then it goes on at the period, as realtime does, until an action
///   comes again; what the input is meanwhile is the actuator's rule (hold, then fallback);
/// - an input that does not follow its command is held, if the loop file says so (StuckParams): a
///   person's input and a fallback are passed on, what a law asks of it is not;
/// - with a recorder: an answered sample also waits until recorded() says that all of it is there,
///   and is sent again meanwhile, so that a recorder which was away misses nothing; after
///   record_timeout_s the plant goes on without, until the recorder is heard of again;
/// - paused: only step() moves on;
/// - the final sample is sent again until finish() says that it has arrived, and likewise.
class PlantSession {
 public:
  PlantSession(std::unique_ptr<Process> process, const PlantPolicy& policy);
  PlantSession(Simulation simulation, const PlantPolicy& policy);

  /// Sample 0 of a new run, held until start().
  void begin(std::uint64_t run_id);
  void start(double now_s);
  /// True if it answers the sample on the table; otherwise it is counted and forgotten.
  bool receive(const ControlAction& action);
  /// Moves on if the rules say so; true: there is a new sample, which the caller publishes.
  bool advance(double now_s);
  /// When advance() is to be called again if no action comes; infinite: not before one comes.
  double nextDue() const;
  /// The sample on the table is to be sent again now; call resent() then.
  bool mustResend(double now_s);
  void resent(double now_s);
  /// The recorder has all of this sample. True: it was waited for.
  bool recorded(const StepHeader& sample);
  bool awaitsRecorder() const { return record_wait_.isOpen(); }
  /// How long nothing else has been waited for.
  double unrecordedFor(double now_s) const {
    return awaitsRecorder() ? now_s - unrecorded_since_s_ : 0.0;
  }
  /// The final sample has arrived where it must.
  void finish() { acknowledged_ = true; }
  bool acknowledged() const { return acknowledged_; }

  void pause(bool on, double now_s);
  bool paused() const { return paused_; }
  bool step();  ///< one sample while paused; false: not paused, or no run under way

  Process& process() { return *process_; }
  const Process& process() const { return *process_; }
  PlantPhase phase() const { return phase_; }
  bool hasAction() const { return have_action_; }
  bool starving() const { return starving_; }  ///< paced: goes on without actions
  /// How long the sample on the table has been without an answer; 0 if it has one or needs none.
  double unansweredFor(double now_s) const;
  const Pacer& pacer() const { return pacer_; }
  const std::string& stuck() const { return stuck_.words(); }  ///< see StuckWatch
  /// No input is left that follows, and so all are held.
  bool holdsAll() const { return policy_.stuck.hold && stuck_.all(); }
  /// False: a controller's actions come to nothing for now.
  bool takesActions() const { return process_->takesActions() && !holdsAll(); }
  const ActionCounts& counts() const { return counts_; }
  std::uint64_t missingInputs() const { return missing_inputs_; }
  std::uint64_t runId() const { return process_->measurement().header.run_id; }

 private:
  void countStray(const StepHeader& header);
  bool mayGoWithout(double now_s);
  bool isRecorded(double now_s);
  void putOnTable(double now_s);

  std::unique_ptr<Process> process_;
  PlantPolicy policy_;
  Pacer pacer_;
  PlantPhase phase_{PlantPhase::kWaiting};
  bool paused_{false}, have_action_{false}, starving_{false}, acknowledged_{false};
  bool recorded_{false}, recorder_keeps_up_{true};
  OwnWait action_wait_, record_wait_;  // the latter: while nothing else is waited for
  double unrecorded_since_s_{};
  std::uint32_t steps_allowed_{};
  Vector action_;  // u(k), waiting for its time
  Vector before_;  // where the inputs were when it came
  StuckWatch stuck_;
  double table_since_s_{}, sent_s_{};
  ActionCounts counts_;
  std::uint64_t missing_inputs_{};
};

}  // namespace fpc
