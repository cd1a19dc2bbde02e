#include "runtime/record_remarks.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/text.hpp"
#include "runtime/missing_parts.hpp"

namespace fpc {
namespace {

constexpr double kRounding = 1e-6;  // of a limit: what a solver leaves

}  // namespace

RecordRemarks::RecordRemarks(const LoopFile& loop)
    : stuck_(loop.stuck, loop.simulation.actuator.limits, loop.plant_info.inputs),
      has_optimizer_(loop.has_clp),
      has_state_(!loop.external_plant) {
  if (!loop.has_clp) return;
  addLimits(loop, -1.0);
  addLimits(loop, 1.0);
}

void RecordRemarks::addLimits(const LoopFile& loop, double sign) {
  const Vector& limits = sign < 0.0 ? loop.clp.output_lower : loop.clp.output_upper;
  const char* key = sign < 0.0 ? "clp.output_lower" : "clp.output_upper";
  for (Eigen::Index i = 0; i < limits.size(); ++i) {
    if (!std::isfinite(limits[i])) continue;
    const SignalInfo& output = loop.plant_info.outputs[static_cast<std::size_t>(i)];
    soft_.push_back({i, sign, limits[i],
                     output.name + (sign < 0.0 ? " below" : " above") + " its soft limit, " +
                         exactText(limits[i]) +
                         (output.unit.empty() ? "" : " [" + output.unit + "]") + " (" + key + ")"});
  }
}

void RecordRemarks::add(const SampleRecord& sample) {
  watchInputs(sample);
  if (step_ > 0) watchOutputs(sample);  // nothing was decided before the first
  watchGaps(sample);
  ++step_;
}

/// u(k - 1) is known from sample k.
void RecordRemarks::watchInputs(const SampleRecord& sample) {
  if (!before_.has_action || !sample.has_measurement) {
    stuck_.reset();
  } else {
    stuck_.look(before_.action.input, before_.measurement.input_applied,
                sample.measurement.input_applied);
    if (!stuck_.words().empty()) keep(stuck_.words(), step_ - 1);
  }
  before_.has_action = sample.has_action && sample.has_measurement;
  if (!before_.has_action) return;
  before_.action.input = sample.action.input;
  before_.measurement.input_applied = sample.measurement.input_applied;
}

void RecordRemarks::watchOutputs(const SampleRecord& sample) {
  if (!sample.has_state && !sample.has_measurement) return;
  const Vector& outputs = sample.has_state ? sample.state.outputs : sample.measurement.outputs;
  for (const SoftLimit& soft : soft_) {
    const double beyond = soft.sign * (outputs[soft.output] - soft.limit);
    if (beyond > kRounding * std::max(1.0, std::abs(soft.limit))) keep(soft.words, step_);
  }
}

/// What a sample lacks is a gap once another one follows.
void RecordRemarks::watchGaps(const SampleRecord& sample) {
  for (const char* what : missing_) keep(std::string("no ") + what + " in the record", step_ - 1);
  missing_.clear();
  forMissingParts(sample, has_optimizer_, has_state_,
                  [this](const char* what) { missing_.push_back(what); });
}

void RecordRemarks::keep(const std::string& words, std::uint32_t step) {
  const auto known = std::find_if(remarks_.begin(), remarks_.end(),
                                  [&](const RunRemark& remark) { return remark.words == words; });
  if (known != remarks_.end())
    ++known->samples;
  else
    remarks_.push_back({words, 1, step});
}

}  // namespace fpc
