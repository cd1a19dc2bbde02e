#include "control/pi/tuning.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kRunaway = 1e6;   // times the step
constexpr double kSettled = 0.02;  // of the step
constexpr double kRiseFrom = 0.1, kRiseTo = 0.9;

}  // namespace

PiTuning imcTuning(const Fopdt& element, double lambda_min) {
  element.validate("imc: ");
  require(std::isfinite(lambda_min) && lambda_min > 0.0, "imc_time_constant_min", "a time > 0");
  const double half = 0.5 * element.dead_time, ti = element.time_constant + half;
  return {ti / (element.gain * (lambda_min + half)), ti};
}

StepExperiment::StepExperiment(const Fopdt& element, const StepTest& test)
    : element_(element), test_(test), response_(element, test.sample_time_min) {
  require(test.sample_time_min > 0.0 && test.duration_min >= test.sample_time_min, "step test",
          "0 < sample time <= duration");
  outputs_.reserve(static_cast<std::size_t>(std::lround(test.duration_min / test.sample_time_min)) +
                   1);
}

StepQuality StepExperiment::run(const PiTuning& tuning) {
  const double dt = test_.sample_time_min;
  const auto samples = static_cast<std::size_t>(std::lround(test_.duration_min / dt));
  StepQuality quality{kInfinity, kInfinity, kInfinity, kInfinity};
  outputs_.clear();
  response_.rest(0.0);
  double y = 0.0, integral = 0.0, iae = 0.0, peak = 0.0;
  for (std::size_t k = 0; k <= samples; ++k) {
    outputs_.push_back(y);
    const double error = 1.0 - y;
    iae += std::abs(error) * dt;
    peak = std::max(peak, y);
    integral += error * dt;
    const double input = tuning.kp * (error + integral / tuning.integral_time_min);
    y = element_.gain * response_.advance(input);
    if (!(std::abs(y) < kRunaway)) return quality;
  }
  std::size_t from = samples, to = samples, settled = 0;
  for (std::size_t k = samples + 1; k-- > 0;) {
    if (outputs_[k] >= kRiseFrom) from = k;
    if (outputs_[k] >= kRiseTo) to = k;
  }
  for (std::size_t k = 0; k <= samples; ++k)
    if (std::abs(outputs_[k] - 1.0) > kSettled) settled = k;
  const bool rises = outputs_[to] >= kRiseTo;
  quality.rise_time = rises ? static_cast<double>(to - from) * dt : test_.duration_min;
  quality.settling_time = static_cast<double>(std::min(settled + 1, samples)) * dt;
  quality.overshoot = std::max(0.0, peak - 1.0);
  quality.iae = iae;
  return quality;
}

PiTuning swarmTuning(const Fopdt& element, TuningCost cost, const StepTest& test,
                     SwarmParams params) {
  element.validate("swarm: ");
  StepExperiment experiment({1.0, element.time_constant, element.dead_time}, test);
  const double largest =
      element.dead_time > 0.0 ? 3.0 * element.time_constant / element.dead_time : 30.0;
  const double span = element.time_constant + element.dead_time;
  const Vector lower = (Vector(2) << 1e-3 * largest, 0.1 * span).finished();
  const Vector upper = (Vector(2) << largest, 5.0 * span).finished();
  const auto judge = [&](const Vector& x) {
    const StepQuality quality = experiment.run({x[0], x[1]});
    return cost == TuningCost::kIae ? quality.iae : quality.cost();
  };
  const SwarmResult found = minimizeBySwarm(judge, lower, upper, params);
  return {found.best[0] / element.gain, found.best[1]};
}

}  // namespace fpc
