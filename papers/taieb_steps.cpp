#include "papers/taieb_steps.hpp"

#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "papers/runs.hpp"

namespace fpc::tool {

std::vector<StepIndices> stepsOf(const std::string& loop, Eigen::Index output, double unit_s,
                                 const Overrides& overrides) {
  const RunRecord& record = recordOf(loop, overrides);
  Vector y(static_cast<Eigen::Index>(record.samples.size())), setpoint(y.size());
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    const SampleRecord& sample = record.samples[static_cast<std::size_t>(k)];
    y[k] = sample.measurement.outputs[output];
    setpoint[k] = sample.tracking.setpoint[output];
  }
  auto steps = stepIndices(y, setpoint, record.info.sample_time_s / unit_s);
  require(!steps.empty(), loop, "at least one step of the setpoint");
  return steps;
}

StepIndices meanOf(const std::vector<StepIndices>& steps) {
  require(!steps.empty(), "step indices", "at least one step of the setpoint");
  StepIndices mean;
  const auto n = static_cast<double>(steps.size());
  for (const StepIndices& step : steps) {
    mean.rise += step.rise / n;
    mean.settling += step.settling / n;
    mean.overshoot += step.overshoot / n;
    mean.offset += step.offset / n;
  }
  return mean;
}

double inputEnergy(const std::string& loop, const Overrides& overrides) {
  const RunRecord& record = recordOf(loop, overrides);
  const Vector first = record.samples.front().measurement.input_applied;
  double sum = 0.0;
  for (const SampleRecord& sample : record.samples)
    sum += sample.measurement.input_applied.cwiseQuotient(first).squaredNorm();
  return sum;
}

}  // namespace fpc::tool
