// What happened in a run, sample by sample, collected from structs in one process or from messages
// over topics.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "fmbpc/base/ring.hpp"

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
  bool has_measurement{}, has_state{}, has_tracking{}, has_base{}, has_action{}, has_report{};
};

struct RunRecord {
  std::string loop;
  PlantInfo info;
  std::vector<std::string> states,
      state_units;                    ///< names of PlantState::state, empty for an external plant
  std::vector<SampleRecord> samples;  ///< index = step
  bool complete{false};  ///< the final sample came, nothing is missing, and the plant moved as asked
  std::uint32_t failed_samples{};  ///< samples over which the plant could not be moved and was held
  std::string trouble;             ///< of the first of them: "sample 17: REASON"
};

/// Collects by step; order of arrival does not matter. A new run_id starts over.
class Recorder {
 public:
  /// has_optimizer: actions and reports of the optimizer are expected besides the base actions.
  Recorder(std::string loop, PlantInfo info, bool has_optimizer, bool has_state,
           std::vector<std::string> states, std::vector<std::string> state_units);
  /// Setpoints and references of these outputs are recorded as missing.
  void leaveOut(std::vector<Eigen::Index> outputs) { without_setpoint_ = std::move(outputs); }
  void add(const Measurement& m);
  void add(const PlantState& s);
  void add(const Tracking& t);
  void addBase(const ControlAction& a);
  void addAction(const ControlAction& a);
  void add(const SolverReport& r);
  bool complete() const;  ///< final measurement there and no gaps; the plant may have failed
  bool finalSeen() const;
  /// "sample 17: no control_action" for every hole, at most `limit` lines.
  std::vector<std::string> gaps(std::size_t limit = 10) const;
  const RunRecord& record() const { return record_; }
  RunRecord take();

 private:
  SampleRecord* at(const StepHeader& header);
  RunRecord record_;
  std::vector<Eigen::Index> without_setpoint_;
  std::uint64_t run_id_{};
  bool has_optimizer_, has_state_;
};

}  // namespace fpc
