#include "fmbpc/loop/record.hpp"

#include <limits>
#include <utility>

namespace fpc {
namespace {
constexpr std::uint32_t kLargestJump = 100000;  // a stray step number must not ask for gigabytes
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
}  // namespace

Recorder::Recorder(std::string loop, PlantInfo info, bool has_optimizer, bool has_state,
                   std::vector<std::string> states, std::vector<std::string> state_units)
    : has_optimizer_(has_optimizer), has_state_(has_state) {
  record_.loop = std::move(loop);
  record_.info = std::move(info);
  record_.states = std::move(states);
  record_.state_units = std::move(state_units);
}

SampleRecord* Recorder::at(const StepHeader& header) {
  if (header.run_id < run_id_ || header.step > record_.samples.size() + kLargestJump)
    return nullptr;
  if (header.run_id > run_id_) {
    run_id_ = header.run_id;
    record_.samples.clear();
    record_.complete = false;
  }
  if (header.step >= record_.samples.size()) record_.samples.resize(header.step + std::size_t{1});
  return &record_.samples[header.step];
}

void Recorder::add(const Measurement& m) {
  if (SampleRecord* sample = at(m.header)) {
    sample->measurement = m;
    sample->has_measurement = true;
  }
}

void Recorder::add(const PlantState& s) {
  if (SampleRecord* sample = at(s.header)) {
    sample->state = s;
    sample->has_state = true;
  }
}

void Recorder::add(const Tracking& t) {
  if (SampleRecord* sample = at(t.header)) {
    sample->tracking = t;
    for (const Eigen::Index i : without_setpoint_)
      sample->tracking.setpoint[i] = sample->tracking.reference[i] = kMissing;
    sample->has_tracking = true;
  }
}

void Recorder::addBase(const ControlAction& a) {
  SampleRecord* sample = at(a.header);
  if (!sample) return;
  sample->base = a;
  sample->has_base = true;
  if (has_optimizer_) return;
  sample->action = a;
  sample->has_action = true;
}

void Recorder::addAction(const ControlAction& a) {
  SampleRecord* sample = at(a.header);
  if (!sample) return;
  sample->action = a;
  sample->has_action = true;
  if (has_optimizer_) return;
  sample->base = a;
  sample->has_base = true;
}

void Recorder::add(const SolverReport& r) {
  if (SampleRecord* sample = at(r.header)) {
    sample->report = r;
    sample->has_report = true;
  }
}

bool Recorder::finalSeen() const {
  return !record_.samples.empty() && record_.samples.back().has_measurement &&
         record_.samples.back().measurement.final;
}

bool Recorder::complete() const { return finalSeen() && gaps(1).empty(); }

std::vector<std::string> Recorder::gaps(std::size_t limit) const {
  std::vector<std::string> lines;
  const std::size_t last = record_.samples.size() - 1;
  const auto note = [&](std::size_t step, bool there, const char* what) {
    if (!there && lines.size() < limit)
      lines.push_back("sample " + std::to_string(step) + ": no " + what);
  };
  for (std::size_t step = 0; step < record_.samples.size() && lines.size() < limit; ++step) {
    const SampleRecord& sample = record_.samples[step];
    note(step, sample.has_measurement, "measurement");
    note(step, sample.has_tracking, "tracking");
    if (has_state_) note(step, sample.has_state, "plant_state");
    if (step == last && finalSeen()) continue;
    note(step, sample.has_base, "base_action");
    if (!has_optimizer_) continue;
    note(step, sample.has_action, "control_action");
    note(step, sample.has_report, "solver_report");
  }
  return lines;
}

RunRecord Recorder::take() {
  for (const SampleRecord& sample : record_.samples) {
    if (sample.state.trouble.empty()) continue;
    if (record_.failed_samples++ == 0) record_.trouble = sample.state.trouble;
  }
  record_.complete = complete() && record_.failed_samples == 0;
  RunRecord taken = std::move(record_);
  record_ = {taken.loop, taken.info, taken.states, taken.state_units, {}, false, 0, {}};
  run_id_ = 0;
  return taken;
}

}  // namespace fpc
