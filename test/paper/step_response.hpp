// How an output follows a step of its setpoint, as taieb2017 judge it: rise
// from 10 to 90 %, last leaving of a band of 2 %, overshoot and offset in % of the step.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/run.hpp"

namespace fpc::test {

struct StepFigures {
  double rise{}, settling{};     ///< [samples], linear between them
  double overshoot{}, offset{};  ///< [%]; offset: mean over the last tenth
  double cost(double dt) const { return 10.0 * offset + overshoot + dt * (settling + rise); }
};

inline RunRecord wholeRun(const std::string& name, const Overrides& overrides = {}) {
  RunRecord record = runLoop(readLoop(name, overrides));
  EXPECT_TRUE(record.complete) << name;
  return record;
}

/// Output i over samples first..last without noise and sensor faults, from its value at `first` to
/// `to`. Infinite times if it never gets there.
inline StepFigures stepFigures(const RunRecord& record, Eigen::Index i, std::size_t first,
                               std::size_t last, double to) {
  const auto output = [&](std::size_t k) { return record.samples[k].state.outputs[i]; };
  const double from = output(first);
  std::vector<double> z;
  for (std::size_t k = first; k <= last; ++k) z.push_back((output(k) - from) / (to - from));
  const auto crossing = [&](double level) {
    for (std::size_t k = 1; k < z.size(); ++k)
      if (z[k] >= level) return static_cast<double>(k - 1) + (level - z[k - 1]) / (z[k] - z[k - 1]);
    return HUGE_VAL;
  };
  StepFigures f;
  f.rise = crossing(0.9) - crossing(0.1);
  std::size_t inside = z.size();
  while (inside > 0 && std::abs(z[inside - 1] - 1.0) <= 0.02) --inside;
  f.settling = inside == z.size() ? HUGE_VAL : static_cast<double>(inside);
  if (inside > 0 && inside < z.size()) {  // where it enters the band for good
    const double edge = z[inside - 1] < 1.0 ? 0.98 : 1.02;
    f.settling += (edge - z[inside - 1]) / (z[inside] - z[inside - 1]) - 1.0;
  }
  f.overshoot = 100.0 * std::max(0.0, *std::max_element(z.begin(), z.end()) - 1.0);
  const std::size_t tail = std::max<std::size_t>(1, z.size() / 10);
  for (std::size_t k = z.size() - tail; k < z.size(); ++k)
    f.offset += 100.0 * std::abs(z[k] - 1.0) / static_cast<double>(tail);
  return f;
}

/// Largest |y - target| of output i over samples first..last.
inline double largestError(const RunRecord& record, Eigen::Index i, std::size_t first,
                           std::size_t last, double target) {
  double error = 0.0;
  for (std::size_t k = first; k <= last; ++k)
    error = std::max(error, std::abs(record.samples[k].state.outputs[i] - target));
  return error;
}

}  // namespace fpc::test
