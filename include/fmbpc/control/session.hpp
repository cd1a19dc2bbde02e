// A controller or an optimizer behind the rules of the ring: repeats get the cached answer, gaps reset, NaN holds.
// The same objects serve the nodes and the in-process loop, which is why both give the same numbers.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fmbpc/base/step_gate.hpp"
#include "fmbpc/control/closed_loop_paradigm.hpp"
#include "fmbpc/control/controller.hpp"
#include "fmbpc/control/setpoint_source.hpp"

namespace fpc {

/// What a controller sends back for one measurement.
struct ControllerAnswer {
  ControlAction base;
  Tracking tracking;
  bool has_action{false};      ///< false for the final sample
  bool has_prediction{false};
  PredictiveAction prediction;
  std::vector<CommandEffect> effects;  ///< setpoint commands that took effect with this sample
};

/// What became of a message.
enum class Receipt {
  kAnswered,   ///< a new answer
  kRepeated,   ///< the cached answer again
  kDropped,    ///< old, of another run, or of wrong size: counted
  kNotReady,   ///< no model yet
};

class ControllerSession {
 public:
  ControllerSession(std::unique_ptr<Controller> controller, SetpointParams setpoint, InputLimits limits,
                    Vector initial_input, PlantInfo plant);

  bool ready() const;  ///< has its model, if it needs one
  /// `resetReason()` says in words why the last answered sample reset the controller (empty if it did not).
  Receipt receive(const Measurement& measurement);
  const ControllerAnswer& answer() const { return answer_; }
  const ControllerOutput& output() const { return output_; }
  const std::string& resetReason() const { return reset_reason_; }

  void setModel(const TsModel& model);      ///< acts from the next sample; @throws InputError, old model kept
  std::uint32_t command(const Command& setpoint) { return setpoint_.command(setpoint); }
  void manual(bool on);                     ///< acts from the next sample, bumpless both ways
  void manualInput(VectorRef input);        ///< clipped to the limits; @throws InputError on size or NaN
  bool isManual() const { return manual_; }

  const ArrivalCounts& counts() const { return gate_.counts(); }
  const SetpointSource& setpoint() const { return setpoint_; }
  const Controller& controller() const { return *controller_; }

 private:
  bool sizesFit(const Measurement& m) const;
  void process(const Measurement& m, Arrival arrival);
  void hold(const Measurement& m);

  std::unique_ptr<Controller> controller_;
  SetpointSource setpoint_;
  InputLimits limits_;
  PlantInfo plant_;
  StepGate gate_;
  ControllerOutput output_;
  ControllerAnswer answer_;
  std::string reset_reason_;
  Vector last_input_, manual_input_;
  bool manual_{false}, reset_pending_{true}, has_model_{false};
};

/// The optimizer behind the ring: pairs base action and prediction of the same sample, passes held and manual
/// actions through.
class OptimizerSession {
 public:
  OptimizerSession(ClpParams params, InputLimits limits, PlantInfo plant);

  /// Both return true when the answer for that sample has just been made (or is repeated).
  bool receive(const ControlAction& base);
  bool receive(const PredictiveAction& prediction);
  const ControlAction& action() const { return action_; }
  const SolverReport& report() const { return report_; }
  const ArrivalCounts& counts() const { return gate_.counts(); }

 private:
  bool tryAnswer();
  bool sizesFit(const PredictiveAction& p) const;

  ClpParams params_;
  InputLimits limits_;
  PlantInfo plant_;
  std::unique_ptr<ClosedLoopParadigm> optimizer_;  // made at the first prediction, when n_x is known
  StepGate gate_;
  ControlAction base_, action_;
  PredictiveAction prediction_;
  SolverReport report_;
  bool have_base_{false}, have_prediction_{false};
};

}  // namespace fpc
