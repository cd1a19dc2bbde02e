#include "fmbpc/control/standstill.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

using Eigen::Index;

void StandstillParams::validate(Index n_y, Index n_u, Index n_d) const {
  require(window_samples >= 2, "standstill.window_h", "at least two samples");
  require(others_change > 0.0 && std::isfinite(others_change), "standstill.others_change",
          "a number > 0");
  require(usual.size() == n_d && usual.allFinite(), "standstill.usual",
          std::to_string(n_d) + " finite numbers");
  require(fallback.size() == n_u && fallback.allFinite(), "standstill.fallback",
          std::to_string(n_u) + " finite numbers");
  for (const WatchedSignal& signal : signals) {
    require(signal.place >= 0 && signal.place < (signal.is_output ? n_y : n_d),
            "standstill.signals", "measured signals");
    require(signal.least_change > 0.0 && std::isfinite(signal.least_change),
            "standstill.signals." + signal.name, "a number > 0");
  }
}

void SignalWindow::add(const Measurement& now) {
  const Index n_y = now.outputs.size(), n_d = now.disturbances.size();
  values_.col(next_).head(n_y) = now.outputs;
  values_.col(next_).segment(n_y, n_d) = now.disturbances;
  values_.col(next_).tail(now.input_applied.size()) = now.input_applied;
  next_ = (next_ + 1) % values_.cols();
  known_ = std::min(known_ + 1, values_.cols());
}

double SignalWindow::span(Index signal) const {
  const auto row = values_.row(signal).head(known_);
  return row.maxCoeff() - row.minCoeff();
}

double SignalWindow::mean(Index signal) const { return values_.row(signal).head(known_).mean(); }

StandstillWatch::StandstillWatch(std::unique_ptr<Controller> inside, StandstillParams params,
                                 InputLimits limits, PlantInfo plant)
    : ControllerAround(std::move(inside), "standstill"),
      params_(std::move(params)),
      limits_(std::move(limits)),
      n_y_(static_cast<Index>(plant.outputs.size())),
      still_(params_.signals.size(), false),
      stood_at_(params_.signals.size(), 0.0) {
  const auto n_u = static_cast<Index>(plant.inputs.size());
  const auto n_d = static_cast<Index>(plant.disturbances.size());
  params_.validate(n_y_, n_u, n_d);
  limits_.validate(n_u);
  window_ = SignalWindow(n_y_ + n_d + n_u, params_.window_samples);
  plan_ = AffineLaw(params_.fallback_plan, n_u, plant.sample_time_s / 3600.0);
  for (const WatchedSignal& signal : params_.signals)
    remarks_.push_back(signal.name + (signal.is_output ? " stands still: the fallback acts"
                                                       : " stands still: its usual value is used"));
}

void StandstillWatch::reset(const Measurement& start) {
  inside_->reset(start);
  plan_.reset();
  window_.clear();
  std::fill(still_.begin(), still_.end(), false);
  away_ = false;
}

Index StandstillWatch::rowOf(const WatchedSignal& signal) const {
  return signal.is_output ? signal.place : n_y_ + signal.place;
}

double StandstillWatch::valueOf(const Measurement& now, const WatchedSignal& signal) const {
  return signal.is_output ? now.outputs[signal.place] : now.disturbances[signal.place];
}

/// Whether something else that drives the plant, and is not known to stand still, has moved.
bool StandstillWatch::othersMove(const WatchedSignal& signal) const {
  const Index last = n_y_ + seen_.disturbances.size();
  const Index end = signal.is_output ? last + seen_.input_applied.size() : last;
  for (Index other = n_y_; other < end; ++other) {
    bool trusted = other != rowOf(signal);
    for (std::size_t i = 0; i < still_.size(); ++i)
      trusted = trusted && !(still_[i] && rowOf(params_.signals[i]) == other);
    if (trusted && window_.span(other) > params_.others_change * std::abs(window_.mean(other)))
      return true;
  }
  return false;
}

void StandstillWatch::watch(const Measurement& now) {
  window_.add(now);
  for (std::size_t i = 0; i < still_.size(); ++i) {
    const WatchedSignal& signal = params_.signals[i];
    if (still_[i]) {
      still_[i] = std::abs(valueOf(now, signal) - stood_at_[i]) < signal.least_change;
    } else if (window_.full() && window_.span(rowOf(signal)) < signal.least_change &&
               othersMove(signal)) {
      still_[i] = true;
      stood_at_[i] = valueOf(now, signal);
    }
  }
}

void StandstillWatch::fallBack(const Measurement& now, const SetpointSource& setpoint,
                               ControllerOutput& output) {
  output.input = params_.fallback;
  if (!plan_.empty())
    output.input += plan_.follow(seen_.outputs, seen_.disturbances, now.header.step);
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
  const std::string* remark = nullptr;
  bool blind = false;
  for (std::size_t i = 0; i < still_.size(); ++i) {
    if (!still_[i]) continue;
    const WatchedSignal& signal = params_.signals[i];
    if (!signal.is_output) seen_.disturbances[signal.place] = params_.usual[signal.place];
    if (!remark || signal.is_output) remark = &remarks_[i];
    blind = blind || signal.is_output;
  }
  if (away_ && !blind) inside_->reset(seen_);
  away_ = blind;
  if (blind)
    fallBack(now, setpoint, output);
  else
    inside_->step(seen_, setpoint, output);
  if (remark && (blind || *output.remark == '\0')) output.remark = remark->c_str();
}

}  // namespace fpc
