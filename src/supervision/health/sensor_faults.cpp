#include "supervision/health/sensor_faults.hpp"

#include <algorithm>
#include <cmath>

#include "identification/record_remarks.hpp"
#include "supervision/flat_line.hpp"
#include "supervision/health/finite_runs.hpp"

namespace fpc {
namespace {

constexpr Eigen::Index kShortestFreeze = 20;
constexpr double kFrozenShare = 0.02, kSpikeShare = 0.001;
constexpr std::size_t kFewestSpikes = 3;

void findFrozen(const std::vector<double>& values, SensorFaults& faults) {
  FlatLine line;
  Eigen::Index frozen = 0, run = 0;
  const auto end = [&](std::size_t at) {
    if (run >= kShortestFreeze) {
      frozen += run;
      if (run > faults.frozen_samples) {
        faults.frozen_samples = run;
        faults.frozen_first = static_cast<Eigen::Index>(at) - run;
      }
    }
    run = 0;
  };
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (!std::isfinite(values[k])) continue;
    line.add(values[k]);
    if (line.repeats() == 0) end(k);
    if (line.isUnlikely() && !line.isAtExtreme()) run = line.repeats();
  }
  end(values.size());
  if (!values.empty())
    faults.frozen = static_cast<double>(frozen) / static_cast<double>(values.size());
}

void findSpikes(const std::vector<double>& values, SensorFaults& faults) {
  const auto size = static_cast<Eigen::Index>(values.size());
  const std::size_t spikes = outliersOf(Eigen::Map<const Vector>(values.data(), size)).size();
  if (spikes >= kFewestSpikes)
    faults.spikes = static_cast<double>(spikes) / static_cast<double>(values.size());
}

void findResolution(const std::vector<double>& values, SensorFaults& faults) {
  double least = kInfinity, standing = 0.0, steps = 0.0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    const double step = std::abs(values[k] - values[k - 1]);
    if (!std::isfinite(step)) continue;
    steps += 1.0;
    if (step == 0.0)
      standing += 1.0;
    else
      least = std::min(least, step);
  }
  if (steps == 0.0) return;
  faults.standing = standing / steps;
  if (!std::isfinite(least)) return;
  double odd = 0.0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    const double step = std::abs(values[k] - values[k - 1]) / least;
    if (std::isfinite(step) && std::abs(step - std::round(step)) > 1e-3 * std::max(1.0, step))
      odd += 1.0;
  }
  if (odd <= 0.001 * steps) faults.resolution = least;
}

}  // namespace

bool SensorFaults::isFrozen() const { return frozen >= kFrozenShare; }
bool SensorFaults::hasSpikes() const { return spikes >= kSpikeShare; }
bool SensorFaults::isCoarse(double std_error) const {
  return std::isfinite(resolution) && standing > 0.3 && resolution > 0.3 * std_error;
}

SensorFaults sensorFaults(const std::vector<double>& values) {
  SensorFaults faults;
  findFrozen(values, faults);
  findSpikes(values, faults);
  findResolution(values, faults);
  return faults;
}

double certainTrend(const std::vector<double>& values) {
  constexpr std::size_t kBlocks = 20;
  const std::vector<double> there = finiteOnly(values);
  if (there.size() < 10 * kBlocks) return 0.0;
  const std::vector<double> means =
      blockMeans(there, static_cast<Eigen::Index>(there.size() / kBlocks));
  double squares = 0.0;
  for (std::size_t i = 0; i < kBlocks; ++i) {
    double rank = 0.0;
    for (std::size_t j = 0; j < kBlocks; ++j)
      rank += means[j] < means[i] ? 1.0 : means[j] == means[i] && j != i ? 0.5 : 0.0;
    squares += (rank - static_cast<double>(i)) * (rank - static_cast<double>(i));
  }
  const double n = kBlocks, correlation = 1.0 - 6.0 * squares / (n * (n * n - 1.0));
  return std::abs(correlation) > 0.9 ? means[kBlocks - 1] - means[0] : 0.0;
}

}  // namespace fpc
