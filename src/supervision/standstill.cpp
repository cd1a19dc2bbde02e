#include "supervision/standstill.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

using Eigen::Index;

namespace {

constexpr double kOthersChange = 0.1;  // of its mean: what drives the plant has moved by so much

}  // namespace

void StandstillParams::validate(Index n_y, Index n_u, Index n_d) const {
  require(window_samples >= 2, "standstill.window_h", "at least two samples");
  require(noise_window_samples >= 8, "standstill.noise_window_h", "at least eight samples");
  require(usual.size() == n_d && usual.allFinite(), "standstill.usual",
          std::to_string(n_d) + " finite numbers");
  require(fallback.size() == n_u && fallback.allFinite(), "standstill.fallback",
          std::to_string(n_u) + " finite numbers");
  for (const WatchedSignal& signal : signals) {
    require(signal.place >= 0 && signal.place < (signal.is_output ? n_y : n_d),
            "standstill.signals", "measured signals");
    require(signal.least_change > 0.0 && std::isfinite(signal.least_change),
            "standstill.signals." + signal.name, "a number > 0");
    require(signal.noise_std >= 0.0 && std::isfinite(signal.noise_std),
            "standstill.noise_std." + signal.name, "a number >= 0");
  }
}

namespace {

constexpr double kFarFromNoise = 5.0;  // standard deviations: no noise in years of samples

/// Spread of n samples of noise is hardly ever above this part of its variance.
double mostVariance(Index n) { return 1.0 + 3.0 * std::sqrt(2.0 / static_cast<double>(n - 1)); }

}  // namespace

StandstillWatch::StandstillWatch(std::unique_ptr<Controller> inside,
                                 std::unique_ptr<Controller> fallback, StandstillParams params,
                                 InputLimits limits, PlantInfo plant)
    : ControllerAround(std::move(inside), "standstill"),
      params_(std::move(params)),
      limits_(std::move(limits)),
      n_y_(static_cast<Index>(plant.outputs.size())),
      fallback_(std::move(fallback)),
      still_(params_.signals.size(), false),
      stood_at_(params_.signals.size(), 0.0),
      allowed_(params_.signals.size(), 0.0),
      least_(params_.signals.size(), kInfinity),
      largest_(params_.signals.size(), -kInfinity),
      under_noise_(params_.signals.size(), false) {
  const auto n_u = static_cast<Index>(plant.inputs.size());
  const auto n_d = static_cast<Index>(plant.disturbances.size());
  params_.validate(n_y_, n_u, n_d);
  limits_.validate(n_u);
  window_ = SignalWindow(n_y_ + n_d + n_u,
                         std::max(params_.window_samples, params_.noise_window_samples));
  for (const WatchedSignal& signal : params_.signals)
    texts_.push_back(signal.name + (signal.is_output ? " stands still: the fallback acts"
                                                     : " stands still: its usual value is used"));
}

void StandstillWatch::reset(const Measurement& start) {
  inside_->reset(start);
  window_.clear();
  std::fill(still_.begin(), still_.end(), false);
  std::fill(least_.begin(), least_.end(), kInfinity);
  std::fill(largest_.begin(), largest_.end(), -kInfinity);
  away_ = false;
}

Index StandstillWatch::rowOf(const WatchedSignal& signal) const {
  return signal.is_output ? signal.place : n_y_ + signal.place;
}

double StandstillWatch::valueOf(const Measurement& now, const WatchedSignal& signal) const {
  return signal.is_output ? now.outputs[signal.place] : now.disturbances[signal.place];
}

/// Whether something else that drives the plant, and is not known to stand still, has moved.
template <class Moves>
bool StandstillWatch::othersMove(const WatchedSignal& signal, bool inputs, Moves moves) const {
  const Index last = n_y_ + seen_.disturbances.size();
  const Index end = inputs ? last + seen_.input_applied.size() : last;
  for (Index other = n_y_; other < end; ++other) {
    bool trusted = other != rowOf(signal);
    for (std::size_t i = 0; i < still_.size(); ++i)
      trusted = trusted && !(still_[i] && rowOf(params_.signals[i]) == other);
    if (trusted && moves(other)) return true;
  }
  return false;
}

/// A flow that has come up to its largest value so far may be limited there, as by a weir.
bool StandstillWatch::isAtLimit(std::size_t i, double value) const {
  const WatchedSignal& signal = params_.signals[i];
  const double near = std::max(signal.least_change, kFarFromNoise * signal.noise_std);
  return !signal.is_output && value > largest_[i] - near && largest_[i] - least_[i] > near;
}

bool StandstillWatch::showsTheSame(std::size_t i) const {
  const WatchedSignal& signal = params_.signals[i];
  const Index n = params_.window_samples;
  return window_.holds(n) && window_.span(rowOf(signal), n) < signal.least_change &&
         !isAtLimit(i, window_.mean(rowOf(signal), n)) &&
         othersMove(signal, signal.is_output, [&](Index other) {
           return window_.span(other, n) > kOthersChange * std::abs(window_.mean(other, n));
         });
}

/// Inputs are no evidence here: a law that holds an output where it is moves them, and follows the
/// output's own noise.
bool StandstillWatch::showsOnlyNoise(std::size_t i) const {
  const WatchedSignal& signal = params_.signals[i];
  const Index n = params_.noise_window_samples;
  const double noise = signal.noise_std * signal.noise_std;
  return noise > 0.0 && window_.holds(n) &&
         window_.variance(rowOf(signal), n) < mostVariance(n) * noise &&
         !isAtLimit(i, window_.mean(rowOf(signal), n)) &&
         othersMove(signal, false, [&](Index other) {
           return window_.meansMove(other, n, kOthersChange * std::abs(window_.mean(other, n)));
         });
}

/// The mean of the newest half of the window has left the mean at which it stood: noise alone does
/// not do that.
bool StandstillWatch::meanHasMoved(std::size_t i) const {
  const WatchedSignal& signal = params_.signals[i];
  const Index n = params_.noise_window_samples;
  const double std = signal.noise_std * std::sqrt(3.0 / static_cast<double>(n));
  return under_noise_[i] &&
         std::abs(window_.mean(rowOf(signal), n / 2) - stood_at_[i]) > kFarFromNoise * std;
}

void StandstillWatch::judge(std::size_t i, double value) {
  const WatchedSignal& signal = params_.signals[i];
  least_[i] = std::min(least_[i], value);
  largest_[i] = std::max(largest_[i], value);
  if (still_[i]) {
    still_[i] = std::abs(value - stood_at_[i]) < allowed_[i] && !meanHasMoved(i);
  } else if (showsOnlyNoise(i)) {
    still_[i] = under_noise_[i] = true;
    stood_at_[i] = window_.mean(rowOf(signal), params_.noise_window_samples);
    allowed_[i] = std::max(signal.least_change, kFarFromNoise * signal.noise_std);
  } else if (showsTheSame(i)) {
    still_[i] = true;
    under_noise_[i] = false;
    stood_at_[i] = value;
    allowed_[i] = signal.least_change;
  }
}

void StandstillWatch::watch(const Measurement& now) {
  window_.add(now);
  for (std::size_t i = 0; i < still_.size(); ++i) judge(i, valueOf(now, params_.signals[i]));
}

/// As at the start of a run: the input has followed a frozen output for the whole window.
void StandstillWatch::beginFallback() {
  const std::uint32_t step = std::exchange(seen_.header.step, 0U);
  fallback_->forget();
  fallback_->reset(seen_);
  seen_.header.step = step;
}

void StandstillWatch::fallBack(const Measurement& now, const SetpointSource& setpoint,
                               ControllerOutput& output) {
  output.input = params_.fallback;
  if (fallback_) {
    if (!away_) beginFallback();
    fallback_->step(seen_, setpoint, output);
    if (!output.ok || !output.input.allFinite()) output.input = now.input_applied;
  }
  limits_.clip(output.input, now.input_applied);
  output.source = ActionSource::kFallback;
  output.reference = setpoint.present();
  output.predictive = false;
  output.ok = true;
}

void StandstillWatch::step(const Measurement& now, const SetpointSource& setpoint,
                           ControllerOutput& output) {
  seen_ = now;
  watch(now);
  bool blind = false;
  for (std::size_t i = 0; i < still_.size(); ++i) {
    if (!still_[i]) continue;
    const WatchedSignal& signal = params_.signals[i];
    if (!signal.is_output) seen_.disturbances[signal.place] = params_.usual[signal.place];
    blind = blind || signal.is_output;
  }
  if (away_ && !blind) inside_->reset(seen_);
  if (blind)
    fallBack(now, setpoint, output);
  else
    inside_->step(seen_, setpoint, output);
  away_ = blind;
  for (std::size_t i = 0; i < still_.size(); ++i)
    if (still_[i])
      output.events.add(
          {EventCode::kSignalFrozen, texts_[i].c_str(), params_.signals[i].name.c_str()});
}

}  // namespace fpc
