// Rise, settling, overshoot and offset of every step of a setpoint.
#include <algorithm>
#include <cmath>

#include "analysis/performance.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kLeastStep = 0.01;  // of the largest
constexpr double kRiseFrom = 0.1, kRiseTo = 0.9;

std::vector<StepIndices> findSteps(VectorRef y, VectorRef setpoint) {
  std::vector<StepIndices> steps;
  bool changing = false;
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    const double before = k == 0 ? y[0] : setpoint[k - 1];
    const bool changes = setpoint[k] != before;
    if (changes && !(changing && k > 1)) {
      StepIndices step;
      step.first = k;
      step.from = before;
      steps.push_back(step);
    }
    if (changes) steps.back().to = setpoint[k];
    changing = changes;
  }
  double largest = 0.0;
  for (const auto& step : steps) largest = std::max(largest, std::abs(step.to - step.from));
  const auto small = [&](const StepIndices& step) {
    return std::abs(step.to - step.from) < kLeastStep * largest || step.to == step.from;
  };
  steps.erase(std::remove_if(steps.begin(), steps.end(), small), steps.end());
  for (std::size_t i = 0; i < steps.size(); ++i)
    steps[i].last = i + 1 < steps.size() ? steps[i + 1].first : y.size() - 1;
  return steps;
}

/// Samples after the first until z first reaches `level`, or all of them.
double reaches(const Vector& z, double level) {
  for (Eigen::Index k = 0; k < z.size(); ++k) {
    if (z[k] < level) continue;
    if (k == 0) return 0.0;
    return static_cast<double>(k - 1) + (level - z[k - 1]) / (z[k] - z[k - 1]);
  }
  return static_cast<double>(z.size() - 1);
}

/// Samples until z stays within 1 +- band, or all of them.
double settles(const Vector& z, double band) {
  const Eigen::Index last = z.size() - 1;
  Eigen::Index k = last;
  while (k >= 0 && std::abs(z[k] - 1.0) <= band) --k;
  if (k < 0) return 0.0;
  if (k == last) return static_cast<double>(last);
  const double edge = z[k] > 1.0 ? 1.0 + band : 1.0 - band;
  return static_cast<double>(k) + (edge - z[k]) / (z[k + 1] - z[k]);
}

void judge(VectorRef y, double sample_time, double band, StepIndices& step) {
  const Eigen::Index n = step.last - step.first;
  const Vector z = (y.segment(step.first, n + 1).array() - step.from) / (step.to - step.from);
  if (!z.allFinite()) {
    step.rise = step.settling = step.overshoot = step.offset = kNaN;
    return;
  }
  const bool rises = z.maxCoeff() >= kRiseTo;
  const double rise = reaches(z, kRiseTo) - reaches(z, kRiseFrom);
  step.rise = sample_time * (rises ? rise : static_cast<double>(n));
  step.settling = sample_time * settles(z, band);
  step.overshoot = 100.0 * std::max(0.0, z.maxCoeff() - 1.0);
  const Eigen::Index tail = std::max<Eigen::Index>(1, (n + 5) / 10);
  step.offset = 100.0 * (z.tail(tail).array() - 1.0).abs().mean();
}

}  // namespace

std::vector<StepIndices> stepIndices(VectorRef y, VectorRef setpoint, double sample_time,
                                     double band) {
  require(setpoint.size() == y.size(), "setpoint", "as many samples as y");
  require(std::isfinite(sample_time) && sample_time > 0.0, "sample_time", "a number > 0");
  require(std::isfinite(band) && band > 0.0, "band", "a number > 0");
  auto steps = findSteps(y, setpoint);
  for (auto& step : steps) judge(y, sample_time, band, step);
  return steps;
}

}  // namespace fpc
