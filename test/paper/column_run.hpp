// Runs of the distillation column and the indices of mekki: minutes and mol%.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "runtime/run.hpp"

namespace fpc::test {

struct Indices {
  double iae{}, itae{}, ise{}, itse{};
};

inline RunRecord columnRun(const std::string& name, const Overrides& overrides = {}) {
  const RunRecord record = runLoop(readLoop(name, overrides));
  EXPECT_TRUE(record.complete) << name;
  return record;
}

/// Of output i over the samples from..to, time from the start.
inline Indices columnIndices(const RunRecord& record, Eigen::Index i, std::size_t from = 0,
                             std::size_t to = SIZE_MAX) {
  const double dt = record.info.sample_time_s / 60.0;
  Indices sums;
  for (std::size_t k = from; k <= std::min(to, record.samples.size() - 1); ++k) {
    const SampleRecord& sample = record.samples[k];
    const double e = sample.tracking.setpoint[i] - sample.measurement.outputs[i];
    const double t = dt * static_cast<double>(k);
    sums.iae += std::abs(e) * dt;
    sums.itae += t * std::abs(e) * dt;
    sums.ise += e * e * dt;
    sums.itse += t * e * e * dt;
  }
  return sums;
}

}  // namespace fpc::test
