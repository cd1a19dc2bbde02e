#include "runtime/record.hpp"

#include "runtime/missing_parts.hpp"
#include "runtime/recorder_session.hpp"
#include "runtime/run_tally.hpp"

namespace fpc {
namespace {

template <typename List>
Eigen::Index count(const List& list) {
  return static_cast<Eigen::Index>(list.size());
}

}  // namespace

bool RecordLayout::fits(const Measurement& m) const {
  return m.outputs.size() == count(info.outputs) &&
         m.disturbances.size() == count(info.disturbances) &&
         m.input_applied.size() == count(info.inputs);
}

bool RecordLayout::fits(const PlantState& s) const {
  return s.outputs.size() == count(info.outputs) && s.state.size() == count(states);
}

bool RecordLayout::fits(const Tracking& t) const {
  return t.setpoint.size() == count(info.outputs) && t.reference.size() == count(info.outputs);
}

bool RecordLayout::fits(const ControlAction& a) const {
  return a.input.size() == count(info.inputs) && a.input.allFinite();
}

bool RecordLayout::fits(const SolverReport& r) const {
  return r.perturbation.size() == count(info.inputs);
}

bool RecordLayout::isComplete(const SampleRecord& s) const {
  bool complete = true;
  forMissingParts(s, has_optimizer, has_state, [&](const char*) { complete = false; });
  return complete;
}

RunRecord RecordLayout::emptyRecord() const {
  return {loop, info, states, state_units, {}, false, 0, {}, {}};
}

void conclude(RunRecord& record, bool nothing_missing) {
  RunTally tally;
  for (const SampleRecord& sample : record.samples) tally.add(sample);
  record.failed_samples = tally.failed_samples;
  record.trouble = tally.trouble;
  record.complete = nothing_missing && record.failed_samples == 0;
}

RecordLayout recordLayout(const LoopFile& loop) {
  RecordLayout layout;
  layout.loop = loop.name;
  layout.text = loop.resolved;
  layout.info = loop.plant_info;
  layout.has_optimizer = loop.has_clp;
  layout.has_state = !loop.external_plant;
  layout.without_setpoint = loop.report.without_setpoint;
  layout.samples = loop.simulation.samples;
  if (loop.external_plant) return layout;
  const auto plant = makePlant(loop.simulation);
  layout.true_disturbances = plant->description().disturbances.size();
  for (const Quantity& state : plant->description().states) {
    layout.states.push_back(state.name);
    layout.state_units.push_back(state.unit);
  }
  return layout;
}

}  // namespace fpc
