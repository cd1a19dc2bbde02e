// Signals that show the same number again although their noise or their inputs would change it.
#include <algorithm>
#include <cmath>

#include "supervision/plausibility.hpp"

namespace fpc {
namespace {

constexpr double kMoved = 0.02;  // of an output's range: what its inputs have surely done to it ...
constexpr double kSteps = 8.0;   // ... and of its resolution ...
constexpr int kPatience = 12;    // ... for so many samples and the instrument's lateness

}  // namespace

void Plausibility::setModel(const TsModel& model) {
  for (std::size_t i = 0; i < n_y_; ++i)
    if (params_.enabled && asked_[i].frozen_samples < 0) signals_[i].response.emplace(model);
}

bool Plausibility::inputMoved(const Memory& signal) const {
  for (Eigen::Index i = 0; i < input_range_.size(); ++i)
    if (signal.input_high[i] - signal.input_low[i] > params_.frozen_input * input_range_[i])
      return true;
  return false;
}

/// The same number again: its own noise would have changed it, or its inputs would.
bool Plausibility::standsByItself(std::size_t i, double value, const Measurement& now) {
  Memory& signal = signals_[i];
  const SignalPlausibility& asked = asked_[i];
  bool moved = false;
  if (signal.response) {
    signal.response->move(now);
    const auto row = static_cast<Eigen::Index>(i);
    const double least = std::max(kMoved * output_range_[row], kSteps * signal.flat.resolution());
    signal.against = std::abs(signal.response->of(row)) > least ? signal.against + 1 : 0;
    moved = signal.against > kPatience + asked.late_samples;
  }
  if (value <= asked.scale_lower || value >= asked.scale_upper) return false;
  if (moved) return true;
  return signal.flat.isUnlikely() && (i < n_y_ || !signal.flat.isAtLargest());
}

bool Plausibility::isFrozen(std::size_t i, double value, const Measurement& now) {
  Memory& signal = signals_[i];
  const int asked = asked_[i].frozen_samples;
  signal.flat.add(value);
  if (signal.flat.repeats() == 0) {
    signal.input_low = signal.input_high = now.input_applied;
    signal.against = 0;
    if (signal.response) signal.response->begin(now);
    return false;
  }
  signal.input_low = signal.input_low.cwiseMin(now.input_applied);
  signal.input_high = signal.input_high.cwiseMax(now.input_applied);
  if (asked < 0) return standsByItself(i, value, now);
  return asked > 0 && signal.flat.repeats() >= asked && inputMoved(signal);
}

}  // namespace fpc
