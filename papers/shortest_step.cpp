// Source of the principle: pontryagin1962, time-optimal control with one bounded input.
#include "papers/shortest_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fmbpc/base/input_error.hpp"
#include "plant/simulation.hpp"

namespace fpc {
namespace {

constexpr int kBegins = 20;      // begins of the pulse within a sample
constexpr int kBisections = 50;  // of the pulse's length

class PulseTrial {
 public:
  PulseTrial(const LoopFile& loop, double target)
      : plant_(withoutNoise(loop)),
        samples_(loop.simulation.samples),
        sample_time_s_(loop.simulation.sample_time_s),
        from_(plant_.state().outputs[0]),
        step_(target - from_),
        rest_(loop.simulation.actuator.initial[0]) {
    const InputLimits& limits = loop.simulation.actuator.limits;
    drive_ = step_ > 0.0 ? limits.upper[0] : limits.lower[0];
    brake_ = step_ > 0.0 ? limits.lower[0] : limits.upper[0];
  }

  double step() const { return step_; }
  double longest() const { return static_cast<double>(samples_); }

  /// Largest overshoot [%] of a pulse, times in samples; stops where the response turns round.
  double overshoot(double begin, double length) {
    play(begin, length);
    return 100.0 * (*std::max_element(share_.begin(), share_.end()) - 1.0);
  }

  /// [s], infinite if it never rises to 90 %.
  double rise(double begin, double length) {
    play(begin, length);
    return sample_time_s_ * (crossing(0.9) - crossing(0.1));
  }

 private:
  static SimulationParams withoutNoise(const LoopFile& loop) {
    SimulationParams params = loop.simulation;
    params.noise_std.setZero();
    return params;
  }

  /// Mean of rest, drive and brake over sample k.
  double inputAt(std::uint32_t k, double begin, double length) const {
    const double first = k, last = k + 1.0, end = begin + length;
    const double before = std::clamp(begin - first, 0.0, 1.0);
    const double driven = std::max(0.0, std::min(last, end) - std::max(first, begin));
    return rest_ * before + drive_ * driven + brake_ * (1.0 - before - driven);
  }

  void play(double begin, double length) {
    plant_.reset(1);
    share_.assign(1, 0.0);
    Vector input(1);
    for (std::uint32_t k = 0; k < samples_; ++k) {
      input[0] = inputAt(k, begin, length);
      plant_.advance(input);
      share_.push_back((plant_.state().outputs[0] - from_) / step_);
      const bool braking = k > begin + length;
      if (braking && share_.back() < share_[share_.size() - 2]) return;
    }
  }

  double crossing(double level) const {
    const auto after =
        std::find_if(share_.begin(), share_.end(), [&](double s) { return s >= level; });
    if (after == share_.end()) return std::numeric_limits<double>::infinity();
    const double before = *(after - 1);
    return static_cast<double>(after - share_.begin() - 1) + (level - before) / (*after - before);
  }

  Simulation plant_;
  std::uint32_t samples_;
  double sample_time_s_, from_, step_, rest_, drive_{}, brake_{};
  std::vector<double> share_;  // of the step, sample by sample
};

/// Longest pulse [samples] that overshoots by no more than asked.
double longestPulse(PulseTrial& trial, double begin, double overshoot_percent) {
  double lower = 0.0, upper = trial.longest() - begin;
  if (trial.overshoot(begin, upper) <= overshoot_percent) return upper;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (lower + upper);
    (trial.overshoot(begin, middle) > overshoot_percent ? upper : lower) = middle;
  }
  return lower;
}

}  // namespace

ShortestStep shortestStep(const LoopFile& loop, double target, double overshoot_percent) {
  require(!loop.external_plant, "shortest step: plant.type", "a plant that can be simulated");
  require(loop.simulation.actuator.initial.size() == 1, "shortest step: plant", "a single input");
  require(overshoot_percent >= 0.0, "shortest step: overshoot", "a number >= 0");
  PulseTrial trial(loop, target);
  require(trial.step() != 0.0 && std::isfinite(trial.step()), "shortest step: target",
          "another value than that at rest");
  ShortestStep best;
  best.rise_s = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kBegins; ++i) {
    const double begin = static_cast<double>(i) / kBegins;
    const double length = longestPulse(trial, begin, overshoot_percent);
    const double rise_s = trial.rise(begin, length);
    if (rise_s >= best.rise_s) continue;
    best.rise_s = rise_s;
    best.overshoot_percent = trial.overshoot(begin, length);
    best.pulse_s = length * loop.simulation.sample_time_s;
  }
  require(std::isfinite(best.rise_s), "shortest step: target", "a value within reach of the input");
  return best;
}

}  // namespace fpc
