// What is wrong with a sensor, from its own values.
#pragma once

#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

struct SensorFaults {
  double frozen{};  ///< share of the samples that repeat a value against the signal's own noise
  double spikes{};  ///< share of the samples that stand alone, far from both sides
  double resolution{kNaN};  ///< smallest step, where all steps are multiples of it
  double standing{};        ///< share of the samples equal to the one before
  Eigen::Index frozen_first{}, frozen_samples{};  ///< the longest such run

  bool isFrozen() const;
  bool hasSpikes() const;
  /// Steps so coarse that they are a good part of what is to be seen.
  bool isCoarse(double std_error) const;
};

/// Frozen as FlatLine has it, in runs of at least twenty; spikes as outliersOf() has them.
SensorFaults sensorFaults(const std::vector<double>& values);

/// Change of a series over its whole length, from the ranks of twenty means; 0 unless it goes one
/// way for certain. Source: spearman1904
double certainTrend(const std::vector<double>& values);

}  // namespace fpc
