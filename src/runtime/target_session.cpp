#include "runtime/target_session.hpp"

#include <utility>

#include "fmbpc/base/signals.hpp"

namespace fpc {

TargetSession::TargetSession(TargetParams params, SetpointParams setpoint, InputLimits limits,
                             PlantInfo plant)
    : plant_(plant),
      setpoint_(
          std::move(setpoint), plant_,
          SampleClock(plant_.sample_time_s, static_cast<double>(plant_.header.time_ns) / 1e9)),
      layer_(std::move(params), std::move(limits), std::move(plant)) {
  events_.reserve(Notices::kMost);
}

Receipt TargetSession::receive(const Measurement& m) {
  const bool fits = m.outputs.size() == countOf(plant_.outputs) &&
                    m.disturbances.size() == countOf(plant_.disturbances) &&
                    m.input_applied.size() == countOf(plant_.inputs);
  if (!fits) {
    gate_.countWrongSize();
    return Receipt::kDropped;
  }
  if (!ready()) return Receipt::kNotReady;
  const Arrival arrival = gate_.pass(m.header);
  if (arrival == Arrival::kRepeat) return Receipt::kRepeated;
  if (!isNew(arrival)) return Receipt::kDropped;
  if (arrival == Arrival::kNewRun) {
    setpoint_.restart();
    layer_.forget();
  } else if (needsReset(arrival)) {
    layer_.reset();
  }
  if (arrival == Arrival::kFirst || arrival == Arrival::kNewRun) setpoint_.anchor(m.header);
  layer_.step(m, setpoint_.advance(m.header.step), targets_);
  written_.write(layer_.events(), m.header.step, events_);
  return Receipt::kAnswered;
}

}  // namespace fpc
