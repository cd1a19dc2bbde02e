// What belongs to a sample over topics and has not come. Private to the room.
#pragma once

#include "runtime/record.hpp"

namespace fpc {

/// Calls `tell` with the name of each topic that is missing, in the order of the exchange. The last
/// sample of a run has no action.
template <typename Tell>
void forMissingParts(const SampleRecord& sample, bool has_optimizer, bool has_state, Tell tell) {
  if (!sample.has_measurement) tell("measurement");
  if (!sample.has_tracking) tell("tracking");
  if (has_state && !sample.has_state) tell("plant_state");
  if (sample.has_measurement && sample.measurement.final) return;
  if (has_optimizer && !sample.has_base) tell("base_action");
  if (!sample.has_action || (!has_optimizer && !sample.has_base)) tell("control_action");
  if (has_optimizer && !sample.has_report) tell("solver_report");
}

}  // namespace fpc
