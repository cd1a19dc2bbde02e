// Loops with known faults: a process under PI with load, noise, setpoint steps and a valve.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <deque>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "supervision/health/loop_health.hpp"

namespace fpc {
namespace health_test {

enum class Fault {
  kNone,
  kStiction,
  kBacklash,
  kLoad,
  kAggressive,
  kSluggish,
  kFrozen,
  kOutdated,
};
constexpr Fault kFaults[] = {Fault::kNone,   Fault::kStiction,   Fault::kBacklash,
                             Fault::kLoad,   Fault::kAggressive, Fault::kSluggish,
                             Fault::kFrozen, Fault::kOutdated};
inline LoopCause causeOf(Fault fault) {
  constexpr LoopCause causes[] = {LoopCause::kHealthy,          LoopCause::kStiction,
                                  LoopCause::kBacklash,         LoopCause::kOscillatingLoad,
                                  LoopCause::kAggressiveTuning, LoopCause::kSluggishTuning,
                                  LoopCause::kSensorFrozen,     LoopCause::kModelOutOfDate};
  return causes[static_cast<int>(fault)];
}

/// gain (1 - zero s) exp(-delay s) / (prod (lag s + 1) [s]); times in samples.
struct Process {
  std::string name;
  double gain{1.0};
  std::vector<double> lags;
  double zero{0.0};
  int delay{};
  bool integrates{false};

  std::complex<double> at(double w) const {
    const std::complex<double> s(0.0, w);
    std::complex<double> g = gain * (1.0 - zero * s) * std::exp(-(delay + 0.5) * s);
    for (const double lag : lags) g /= lag * s + 1.0;
    return integrates ? g / s : g;
  }
};

struct Pi {
  double gain{}, integral_time{};
  std::complex<double> at(double w) const {
    return gain * (1.0 + 1.0 / (integral_time * std::complex<double>(0.0, w)));
  }
};

/// SIMC with the half rule. Source: skogestad2003
inline Pi simc(const Process& p, double speed) {
  std::vector<double> lags = p.lags;
  std::sort(lags.rbegin(), lags.rend());
  double dead = p.delay + 0.5 + p.zero;
  const std::size_t kept = p.integrates ? 0 : 1;
  double tau = p.integrates ? 0.0 : lags.at(0);
  for (std::size_t i = kept; i < lags.size(); ++i) {
    if (i == kept && !p.integrates) {
      tau += 0.5 * lags[i];
      dead += 0.5 * lags[i];
    } else {
      dead += lags[i];
    }
  }
  const double closed = speed * dead;
  const double gain =
      p.integrates ? 1.0 / p.gain / (closed + dead) : tau / p.gain / (closed + dead);
  return {gain, p.integrates ? 4.0 * (closed + dead) : std::min(tau, 4.0 * (closed + dead))};
}

/// Factor on the gain at which the loop becomes unstable.
inline double gainMargin(const Process& p, const Pi& c) {
  double before = 0.0;
  for (double w = 1e-4; w < 3.14; w *= 1.002) {
    const std::complex<double> l = p.at(w) * c.at(w);
    if (before < 0.0 && l.imag() >= 0.0 && l.real() < 0.0) return 1.0 / std::abs(l);
    before = l.imag();
  }
  return 10.0;
}

class ProcessState {
 public:
  explicit ProcessState(const Process& p)
      : p_(p), lags_(p.lags.size(), 0.0), waiting_(p.delay, 0.0) {}
  double step(double u) {
    waiting_.push_back(u);
    double x = waiting_.front();
    waiting_.pop_front();
    constexpr int kParts = 8;
    double y = out_;
    for (int i = 0; i < kParts; ++i) {
      double value = p_.gain * x, slope = 0.0;
      for (std::size_t j = 0; j < lags_.size(); ++j) {
        slope = (value - lags_[j]) / p_.lags[j];
        lags_[j] += slope / kParts;
        value = lags_[j];
      }
      y = value - p_.zero * slope;
      if (p_.integrates) y = sum_ += y / kParts;
    }
    return out_ = y;
  }

 private:
  Process p_;
  std::vector<double> lags_;
  std::deque<double> waiting_;
  double sum_{}, out_{};
};

inline StepResponse stepOf(const Process& p, int steps) {
  StepResponse r{1.0, {}, {}};
  ProcessState state(p);
  for (int k = 0; k < steps; ++k) r.value.push_back(state.step(1.0));
  return r;
}

inline const std::vector<Process>& settingPlants() {
  static const std::vector<Process> plants{{"lag and delay", 1.0, {20.0}, 0.0, 5, false},
                                           {"two lags", 2.0, {10.0, 5.0}, 0.0, 3, false},
                                           {"integrator", 0.05, {}, 0.0, 4, true},
                                           {"slow lag", 3.0, {60.0}, 0.0, 3, false},
                                           {"three lags", 1.5, {8.0, 8.0, 8.0}, 0.0, 2, false},
                                           {"mostly delay", 0.8, {10.0}, 0.0, 12, false},
                                           {"integrator with lag", 0.02, {5.0}, 0.0, 3, true},
                                           {"inverse response", 1.0, {10.0, 6.0}, 4.0, 1, false},
                                           {"fast and slow lag", 4.0, {50.0, 5.0}, 0.0, 6, false}};
  return plants;
}

/// No threshold was chosen with these.
inline const std::vector<Process>& judgingPlants() {
  static const std::vector<Process> plants{{"four lags", 2.5, {12.0, 4.0, 4.0, 2.0}, 0.0, 1, false},
                                           {"lag and long delay", 0.6, {15.0}, 0.0, 9, false},
                                           {"slow integrator", 0.01, {8.0}, 0.0, 5, true},
                                           {"two lags, inverse", 1.2, {25.0, 3.0}, 3.0, 2, false},
                                           {"very slow lag", 5.0, {120.0, 3.0}, 0.0, 4, false}};
  return plants;
}

inline ControlRecord drawLoop(const Process& p, Fault fault, std::uint64_t seed,
                              int samples = 6000) {
  std::mt19937_64 engine = seededEngine(seed, {static_cast<std::uint64_t>(fault)});
  const auto between = [&](double a, double b) { return a + (b - a) * uniform(engine); };
  Pi c = simc(p, between(1.0, 1.8));
  if (fault == Fault::kAggressive) c.gain *= gainMargin(p, c) / between(1.04, 1.2);
  if (fault == Fault::kSluggish) c.gain /= between(6.0, 12.0);
  const double slow =
      p.integrates ? 1.0 / std::abs(p.gain) : *std::max_element(p.lags.begin(), p.lags.end());
  const double scale = p.integrates ? std::abs(p.gain) * 10.0 : std::abs(p.gain);  // of y per u
  const double band = between(3.0, 8.0), jump = between(0.3, 1.0) * band;
  const bool slips = uniform(engine) < 0.5;
  StickingValve sticking(band, fault == Fault::kBacklash ? 0.0 : jump);
  SlippingValve slipping(band, jump);
  const double noise = scale * between(0.05, 0.2), load = between(0.5, 1.5);
  const double lag = between(0.5, 2.0) * std::min(slow, 40.0), keep = std::exp(-1.0 / lag);
  const double period = (p.delay + 2.0) * between(6.0, 20.0) +
                        2.0 * (p.lags.empty() ? 0.0 : p.lags[0]) * between(0.3, 1.0);
  const double swing = fault == Fault::kLoad ? between(2.0, 5.0) : 0.0;
  const bool steps = fault == Fault::kOutdated || uniform(engine) < 0.5;
  const int freeze = static_cast<int>(between(0.2, 0.7) * samples);
  ControlRecord r;
  r.output = "y";
  r.input = "u";
  r.u_lower = 0.0;
  r.u_upper = 100.0;
  if (!steps || uniform(engine) < 0.5) r.dead_time_s = p.delay + 1.0;
  const double level = 50.0;
  ProcessState state(p);
  double integral = 0.0, coloured = 0.0, phase = 0.0, seen = 0.0, setpoint = 0.0, y = 0.0;
  const auto valve = [&](double u) {
    if (fault == Fault::kBacklash) return sticking.move(u);
    if (fault == Fault::kStiction) return slips ? slipping.move(u) : sticking.move(u);
    return u;
  };
  for (int k = 0; k < samples; ++k) {
    if (steps && k % 700 == 350) setpoint = scale * between(-6.0, 6.0);
    const double measured = y + noise * standardNormal(engine);
    if (fault != Fault::kFrozen || k < freeze) seen = measured;
    const double e = setpoint - seen;
    double u = level + c.gain * (e + integral);
    if (u >= 0.0 && u <= 100.0) integral += e / c.integral_time;
    u = std::clamp(u, 0.0, 100.0);
    r.y.push_back(seen);
    r.setpoint.push_back(setpoint);
    r.u.push_back(u);
    coloured = keep * coloured + std::sqrt(1.0 - keep * keep) * load * standardNormal(engine);
    phase += 6.283185307179586 / period * (1.0 + 0.1 * standardNormal(engine));
    const double x = valve(u) - level + coloured + swing * std::sin(phase);
    y = state.step(x);
  }
  Process model = p;
  if (fault == Fault::kOutdated)
    model.gain *= uniform(engine) < 0.5 ? between(0.3, 0.55) : between(1.8, 3.0);
  r.model = stepOf(model, 400);
  return r;
}

}  // namespace health_test
}  // namespace fpc
