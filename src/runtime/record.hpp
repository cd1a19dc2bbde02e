// What happened in a run, sample by sample, collected from structs in one process or from messages
// over topics.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fmbpc/base/event.hpp"
#include "fmbpc/base/exchange.hpp"

namespace fpc {

/// Everything about sample k. What did not come (or does not exist, as the action of the final
/// sample) has no values.
struct SampleRecord {
  Measurement measurement;
  PlantState state;  ///< absent with an external plant
  Tracking tracking;
  ControlAction base;
  ControlAction action;  ///< what the plant was told (equals base without an optimizer)
  SolverReport report;
  std::vector<Event> events;  ///< of the controller, then of the plant
  bool has_measurement{}, has_state{}, has_tracking{}, has_base{}, has_action{}, has_report{};
};

struct RunRecord {
  std::string loop;
  PlantInfo info;
  std::vector<std::string> states,
      state_units;                    ///< names of PlantState::state, empty for an external plant
  std::vector<SampleRecord> samples;  ///< index = step
  bool complete{
      false};  ///< the final sample came, nothing is missing, and the plant moved as asked
  std::uint32_t failed_samples{};  ///< samples over which the plant could not be moved and was held
  std::string trouble;             ///< of the first of them: "sample 17: REASON"
  std::vector<Event> events;       ///< besides those of the samples
  double slowest_step_s{};         ///< wall time of law and optimizer, in one process
};

/// Counts failed samples, and says whether the run is complete: nothing missing,
/// nothing failed.
void conclude(RunRecord& record, bool nothing_missing);

}  // namespace fpc
