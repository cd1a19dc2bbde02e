// A controller or an optimizer behind the rules of the exchange: repeats get the cached answer,
// gaps reset, NaN holds. The same objects serve the nodes and the in-process loop, which is why
// both give the same numbers.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/step_gate.hpp"
#include "control/clp/closed_loop_paradigm.hpp"
#include "fmbpc/control/bumpless_transfer.hpp"
#include "fmbpc/control/controller.hpp"
#include "fmbpc/control/setpoint_source.hpp"
#include "runtime/move_origin.hpp"
#include "runtime/recent_samples.hpp"
#include "supervision/signal_validator.hpp"

namespace fpc {

class PlantTap;
class ActuatorEffectiveness;
class WatchedLaw;
struct CandidateLaw;

/// What a controller sends back for one measurement.
struct ControllerAnswer {
  ControlAction base;
  Tracking tracking;
  bool has_action{false};  ///< false for the final sample
  bool has_prediction{false};
  PredictiveAction prediction;
  std::vector<CommandEffect> effects;  ///< setpoint commands that took effect with this sample
  std::vector<Event> events;           ///< what is to be known of this sample
};

/// What an operator has asked of a controller, apart from its model: kept by others for one that
/// comes back.
struct OperatorState {
  bool manual{}, manual_given{};
  Vector manual_input;  ///< n_u if manual_given
  SetpointSource::Recipe recipe;
  std::optional<bool> adapt;
  Settings settings;               ///< those that were changed
  std::vector<Command> setpoints;  ///< in force, and to come
};

/// What became of a message.
enum class Receipt {
  kAnswered,  ///< a new answer
  kRepeated,  ///< the cached answer again
  kDropped,   ///< old, of another run, or of wrong size: counted
  kNotReady,  ///< no model yet
};

/// Rules, in this order, for each measurement:
/// - wrong sizes: dropped and counted; no model yet: not ready, the plant will send it again;
/// - old, of an earlier run, repeated: as StepGate says;
/// - manual: the person's input inside the limits; the controller looks on, as whenever its law
/// does
///   not run, and is reset when auto is back;
/// - the plant takes no actions: its own input is sent back, source held, and the
///   controller is reset when it takes them again;
/// - a signal that the law needs is not accepted (SignalValidator: no number, out of range,
///   ...): answered with the last applied input, source held, or from what is accepted
///   instead; for longer than hold_samples with the fallback. The controller is reset,
///   bumplessly, at the next sample that it gets;
/// - first sample, gap, new run: the controller is reset; otherwise it just steps. A run whose
///   first samples are not accepted begins with the one that is, as it would at sample 0.
/// Move limits count from the applied input, but for one with an offset, which the law, a person
/// and a fallback move on from the last command (MoveOrigin): they see that one as applied.
/// After another hand had the inputs the plant gets in the first sample what it gets already, and
/// what the law asks for otherwise comes in as the bias between them dies out (BumplessTransfer);
/// not from an experiment, nor where the law may send some inputs only.
/// Setpoints advance with every sample. No allocation in receive() after the first answer, but for
/// the words of a reset, setpoint commands that take effect and events.
class ControllerSession {
 public:
  /// @throws InputError naming the field: sizes of limits, setpoint and initial_input (n_u, u(-1)).
  ControllerSession(std::unique_ptr<Controller> controller, SetpointParams setpoint,
                    InputLimits limits, Vector initial_input, PlantInfo plant,
                    double max_pole = 1.0, PlausibilityParams plausibility = {});

  ControllerSession(ControllerSession&&) noexcept;
  ~ControllerSession();

  /// From now on only measurements of this run are answered.
  void announce(std::uint64_t run_id) { gate_.announce(run_id); }
  bool ready() const;  ///< has its model, if it needs one
  /// `resetReason()` says in words why the last answered sample reset the controller (empty if it
  /// did not).
  Receipt receive(const Measurement& measurement);
  const ControllerAnswer& answer() const { return answer_; }
  const ControllerOutput& output() const { return output_; }
  const std::string& resetReason() const { return reset_reason_; }

  /// Acts from the next sample. @throws InputError if it does not fit the plant, or if it would
  /// replace another one and is unstable at the last finite sample (see largestPole(); beyond
  /// max_pole), or turns the sign of a gain there (see requireFewTurned(), requireForeseen()):
  /// the old model stays. A first model is taken even if it is unstable somewhere, since there is
  /// no better one.
  void setModel(const TsModel& model);
  std::uint64_t models() const { return models_; }  ///< taken so far
  /// What is to be known of the model in use: gains whose sign it turned when it came, or a
  /// direction of the inputs in which the first one is weak. Said at one sample; empty if there is
  /// nothing.
  const std::string& modelText() const { return model_text_; }
  /// See SetpointSource: a command of a person, and one that was in force before this object was
  /// made.
  std::uint32_t command(const Command& setpoint) { return setpoint_.command(setpoint); }
  bool restore(const Command& setpoint) { return setpoint_.restore(setpoint); }
  /// See Controller::expect(): of the sample that is answered next.
  void expect(std::uint32_t k, Eigen::Index disturbance, VectorRef ahead) {
    controller_->expect(k, disturbance, ahead);
  }
  /// Holds the setpoint schedule, or lets it go on (a recipe waits for its operator).
  void holdRecipe(bool on);
  void manual(bool on);  ///< acts from the next sample, bumpless both ways
  /// Acts from the next sample; until it is called, manual keeps the last applied input.
  /// Clipped to the bounds at once and to the move limit sample by sample.
  /// @throws InputError on size or NaN, in auto, and for an input that the controller refuses.
  void manualInput(VectorRef input);
  bool isManual() const { return manual_; }
  /// Lets the controller change itself, or freezes it; false if it never does.
  bool adapt(bool on);

  /// New settings of the law from the next sample on; see Controller::retune().
  bool retune(const Settings& settings);

  /// Watches a candidate beside the law from the next sample on, in the place of another one; see
  /// WatchedLaw, which is then the controller(). @throws InputError
  void watch(CandidateLaw candidate);
  /// To the candidate from the next sample on, or back to the former law.
  /// @throws InputError if there is none that has passed, or that is in charge.
  void handOver(bool on);
  const WatchedLaw* watched() const { return watched_; }

  /// From the next sample on these stages see what the law asks for, which stays in charge, and say
  /// what is sent instead, inside the limits. Ended by whatever takes the inputs from the law; the
  /// law then goes on bumplessly. @throws InputError while another one is open.
  void test(std::shared_ptr<PlantTap> tap);

  OperatorState operator_state() const;
  /// Before the first sample. What has been asked of this object itself is newer and stays.
  /// @throws InputError for what the controller refuses; the rest is taken.
  void restore(const OperatorState& operator_state);
  /// The next new run is the same plant going on, not another beginning: setpoints stay in force
  /// and the schedule goes on from where it is (see SetpointSource::carryOver).
  void carryOver() { carries_ = true; }
  /// Sends the last applied input, source held, until manual() is called: for a controller that
  /// joins a run and cannot know what its operator has asked. Not if manual() has been called.
  void holdUntilReleased() { unreleased_ = !manual_asked_; }
  bool unreleased() const { return unreleased_; }
  /// What its law answers goes to an optimizer, which knows what the plant was told.
  void leadsAnOptimizer() { leads_an_optimizer_ = true; }
  /// What a target layer has decided: the law follows it from the sample to come on. Wrong sizes
  /// are ignored.
  void aim(const Targets& targets);
  /// Of the measurements to come: false while the plant's own hand has the inputs.
  void plantTakesActions(bool on) { takes_actions_ = on; }
  /// The input that the outputs do not react to as the model says; see ActuatorEffectiveness.
  Notice reaction() const;
  /// Of these outputs it is not said that their setpoint was clamped.
  void withoutSetpoint(const std::vector<Eigen::Index>& outputs);
  /// Which manual inputs were asked beyond their limits, in words; empty in auto, and if none was.
  std::string manualClamped() const;
  /// The last answer is the fallback, because of what is not accepted.
  bool fellBack() const { return fell_back_; }
  const SignalValidator& plausibility() const { return plausibility_; }

  const ArrivalCounts& counts() const { return gate_.counts(); }
  const SetpointSource& setpoint() const { return setpoint_; }
  const Controller& controller() const { return *controller_; }

 private:
  bool sizesFit(const Measurement& m) const;
  void begin(const Measurement& m, Arrival arrival, const StepHeader& before);
  void process(const Measurement& m);
  void lookAtMoves(const Measurement& m);
  const Measurement& seen(const Measurement& m);
  const Measurement& withoutTest(const Measurement& m);
  void answered();
  void limit(const Measurement& m);
  void runLaw(const Measurement& m);
  void passToTest(const Measurement& m);
  void endTest();
  void hold(const Measurement& m, const Notice& why);
  void fallBack(const Measurement& m, const Notice& why);
  void gatherEvents();
  void watchReaction(const Measurement& m);
  void forgetSamples();
  void handOver(const Measurement& m);
  void keep(const Measurement& accepted);
  void interrupt();
  void lookAtGains(const Measurement& m);
  bool foresee(const Measurement& m, Eigen::Ref<Vector> outputs);
  void noteNeeds();
  void sendManual(const Measurement& m);
  void restoreManual(const OperatorState& operator_state);
  void beginAnew();

  std::unique_ptr<Controller> controller_;
  WatchedLaw* watched_{nullptr};             // controller_, where there is a candidate
  std::shared_ptr<PlantTap> tap_;            // null: nobody tests
  std::vector<std::string> setpoint_texts_;  // by output; empty: that it is clamped is not said
  SetpointSource setpoint_;
  InputLimits limits_;
  PlantInfo plant_;
  StepGate gate_;
  ControllerOutput output_;
  ControllerAnswer answer_;
  std::string reset_reason_;
  Arrival arrival_{Arrival::kFirst};   // of the present sample
  const char* interruption_{nullptr};  // why the controller did not run at the last sample
  std::string arrival_reason_;         // first sample, gap, new run: in words
  Vector last_input_, manual_input_, proposal_;
  BumplessTransfer transfer_;  // on what the plant gets; not where an optimizer follows
  MoveOrigin moves_;
  Targets targets_;   // without outputs: there is no target layer
  Measurement seen_;  // with the input from which the law moves on; sized once
  Measurement without_test_;
  SignalValidator plausibility_;
  TsModel model_;        // in use, matched to the plant; of a law that needs one
  Measurement present_;  // the last that was accepted; empty before the first
  RecentSamples recent_;
  std::string model_text_;
  EventWriter written_;
  EventCode model_event_{EventCode::kNone};          // that has not been said yet
  std::vector<std::string> manual_texts_;            // by input; empty: not clamped
  std::unique_ptr<ActuatorEffectiveness> reaction_;  // of a law with a model, if it is asked for
  bool gains_due_{false};                            // nor have the gains been looked at
  double max_pole_{1.0};
  std::uint64_t models_{};
  bool manual_{false}, manual_given_{false}, unreleased_{false}, fell_back_{false};
  bool takes_actions_{true}, leads_an_optimizer_{false}, other_hand_{false};
  bool manual_asked_{false}, recipe_asked_{false}, carries_{false};
  bool begins_{false};  // its sample 0 came, and the law has not acted yet
  std::optional<bool> adapt_;
  Settings settings_;
};

/// What a law asks for is solved with its prediction; other inputs are passed through.
bool needsPrediction(ActionSource source);

/// The optimizer behind the exchange: pairs base action and prediction of the same sample. Base
/// actions of source base or clipped need a prediction; all others (held, manual, fallback) pass
/// through with status not run. A prediction of wrong size, or not finite, is counted and the base
/// action goes out inside the bounds with status invalid problem, so that the loop never stalls. A
/// base action of wrong size, or not finite, is dropped and counted. After manual, a fallback and a
/// held input that was not ours, what goes out starts where the plant is (BumplessTransfer),
/// whatever the limits of outputs ask for: input and move limits hold.
class OptimizerSession {
 public:
  /// @throws InputError naming the field.
  OptimizerSession(ClpParams params, InputLimits limits, PlantInfo plant);

  /// From now on only messages of this run are answered.
  void announce(std::uint64_t run_id) { gate_.announce(run_id); }
  /// Both return true when the answer for that sample has just been made (or is repeated).
  bool receive(const ControlAction& base);
  bool receive(const PredictiveAction& prediction);
  const ControlAction& action() const { return action_; }
  const SolverReport& report() const { return report_; }
  /// n_u n_c, the inputs planned with the last answer, column i for k + i; empty: it passed through
  /// or has no solution.
  Matrix plan() const;
  const ArrivalCounts& counts() const { return gate_.counts(); }
  /// Why the last answer has status invalid problem, in words; otherwise empty.
  const std::string& trouble() const { return trouble_; }

 private:
  bool admit(const StepHeader& header, bool already_here);
  bool isAnswered(const StepHeader& header) const;
  bool refuse(const StepHeader& header, bool fits);
  bool baseIsRefused() const;
  bool tryAnswer();
  bool sizesFit(const PredictiveAction& p) const;
  void optimize();
  bool isOtherHand() const;
  void passThrough(SolveStatus status);

  ClpParams params_;
  InputLimits limits_;
  MoveOrigin moves_;
  BumplessTransfer transfer_;
  PlantInfo plant_;
  std::unique_ptr<ClosedLoopParadigm> optimizer_;  // made at a prediction, when n_x is known
  StepGate gate_;
  ControlAction base_, action_;
  PredictiveAction prediction_;
  SolverReport report_;
  StepHeader refused_;  // of the last prediction that could not be used
  const char* refused_reason_{nullptr};
  std::string trouble_;
  Eigen::Index n_x_{};
  bool have_base_{false}, have_prediction_{false}, answered_{false};
};

}  // namespace fpc
