#include "supervision/health/sensor_faults.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/order_statistics.hpp"
#include "supervision/flat_line.hpp"
#include "supervision/health/finite_runs.hpp"

namespace fpc {
namespace {

constexpr Eigen::Index kShortestFreeze = 20;
constexpr double kFrozenShare = 0.02, kSpikeShare = 0.001;
constexpr double kSpikeSize = 8.0;      // robust standard deviations
constexpr double kSpikeOfRange = 0.05;  // and of the signal's range
constexpr std::size_t kMostForRanks = 200000;

/// Every so many of the values that enough are left.
std::vector<double> thinned(const std::vector<double>& values) {
  const std::size_t step = 1 + values.size() / kMostForRanks;
  std::vector<double> some;
  for (std::size_t k = 0; k < values.size(); k += step)
    if (std::isfinite(values[k])) some.push_back(values[k]);
  return some;
}

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

double medianOfFive(const double* v) {
  std::array<double, 5> five{v[0], v[1], v[2], v[3], v[4]};
  std::nth_element(five.begin(), five.begin() + 2, five.end());
  return five[2];
}

void findSpikes(const std::vector<double>& values, SensorFaults& faults) {
  if (values.size() < 50) return;
  std::vector<double> apart(values.size(), kNaN);
  for (std::size_t k = 2; k + 2 < values.size(); ++k) {
    bool all = true;
    for (std::size_t j = k - 2; j <= k + 2; ++j) all = all && std::isfinite(values[j]);
    if (all) apart[k] = std::abs(values[k] - medianOfFive(&values[k - 2]));
  }
  const std::vector<double> some = thinned(values), some_apart = thinned(apart);
  if (some.size() < 50 || some_apart.size() < 50) return;
  const double range = sampleQuantile(some, 0.99) - sampleQuantile(some, 0.01);
  const double usual = 1.4826 * upperMedian(some_apart);
  const double limit =
      std::max({kSpikeSize * usual, kSpikeOfRange * range, 2.0 * sampleQuantile(some_apart, 0.98)});
  double spikes = 0.0;
  for (const double a : apart) spikes += a > limit && limit > 0.0 ? 1.0 : 0.0;
  faults.spikes = spikes < 3.0 ? 0.0 : spikes / static_cast<double>(values.size());
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
  std::vector<double> there;
  for (const double v : values)
    if (std::isfinite(v)) there.push_back(v);
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
