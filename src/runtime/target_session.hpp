// The target layer behind the rules of the exchange: repeats get the cached answer, gaps reset.
#pragma once

#include <vector>

#include "base/step_gate.hpp"
#include "control/targets/target_layer.hpp"
#include "fmbpc/control/setpoint_source.hpp"
#include "runtime/session.hpp"

namespace fpc {

/// For each measurement the targets that the law follows at the same sample. It plays the setpoint
/// schedule and hears what people ask beside the controller: setpoints are what it starts from,
/// targets what becomes of them.
class TargetSession {
 public:
  /// @throws InputError naming the field.
  TargetSession(TargetParams params, SetpointParams setpoint, InputLimits limits, PlantInfo plant);

  /// From now on only measurements of this run are answered.
  void announce(std::uint64_t run_id) { gate_.announce(run_id); }
  bool ready() const { return layer_.ready(); }  ///< has its model
  /// Matched to the plant; from the next sample on. @throws InputError if it does not fit: the one
  /// before stays.
  void setModel(const TsModel& model) { layer_.setModel(model); }
  std::uint32_t command(const Command& setpoint) { return setpoint_.command(setpoint); }
  Receipt receive(const Measurement& measurement);
  const Targets& answer() const { return targets_; }
  const std::vector<Event>& events() const { return events_; }  ///< of the answer
  const ArrivalCounts& counts() const { return gate_.counts(); }
  const TargetMoves& moves() const { return layer_.moves(); }
  double seconds() const { return layer_.seconds(); }

 private:
  PlantInfo plant_;
  SetpointSource setpoint_;
  TargetLayer layer_;
  StepGate gate_;
  Targets targets_;
  EventWriter written_;
  std::vector<Event> events_;
};

}  // namespace fpc
