// A recorded run once more: what was measured goes through controller and optimizer again, and
// their actions are compared bit for bit with those that were recorded.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "fmbpc/base/exchange.hpp"
#include "fmbpc/model/ts_model.hpp"
#include "runtime/session.hpp"

namespace fpc {

/// What was recorded of one run, by the step at which it came or from which it acts.
struct RecordedRun {
  std::map<std::uint32_t, Measurement> measurements;
  std::map<std::uint32_t, ControlAction> base;  ///< of the controller, if there is an optimizer
  /// Everything that was on control_action: the optimizer's, and the base action where the
  /// controller had to stand in for it.
  std::multimap<std::uint32_t, ControlAction> control;
  std::multimap<std::uint32_t, Command> setpoints;  ///< by the sample at which they took effect
  std::multimap<std::uint32_t, OperatorState>
      operator_state;                            ///< by the sample from which they act
  std::multimap<std::uint32_t, TsModel> models;  ///< by the sample from which they are used
};

/// Actions of one kind.
struct ReplayedActions {
  std::uint32_t compared{}, equal{};
  std::string first_difference;  ///< in words; empty if all are equal
};

struct ReplayResult {
  std::uint32_t measurements{};
  /// What the record lacks of its samples, in words, the first of them; from the first missing
  /// measurement on nothing is compared, since the controller then had what is not there.
  std::vector<std::string> missing;
  std::uint32_t missing_samples{};
  bool ended{};              ///< the last sample is the final one
  std::uint32_t stood_in{};  ///< samples at which the base action went to the plant as well
  ReplayedActions base, control;
  std::vector<std::string> refused;  ///< what the controller did not take again
  bool equal() const;                ///< nothing is missing, and something was compared
};

/// @throws InputError if the measurements do not fit the loop, or a model is needed and none is
/// recorded.
ReplayResult replay(const LoopFile& loop, const RecordedRun& run);

}  // namespace fpc
