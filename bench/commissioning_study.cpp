// What a commissioning claims of its test and of its model, on processes drawn anew from each seed:
// bench/commissioning_study [records | time | fuzzy] [CASES OF EACH KIND] [FIRST SEED].
//   records: how often the gain and the dead time of a process lie within the bounds that are
//     stated, over records under feedback with coloured noise, a drift and loads;
//   time: plant time of the designed test beside that of an open-loop staircase whose record gives
//     bounds as narrow, with the steps that the test ended with;
//   fuzzy: how often a fuzzy model is confirmed, of processes that are linear and of such whose
//   gain
//     grows with the output, and its error in a free run on another record, without noise, beside
//     that of the elements.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "fmbpc/model/local_model.hpp"
#include "identification/closed_loop_record.hpp"
#include "identification/process_fit.hpp"
#include "runtime/commissioning/plant_test.hpp"
#include "runtime/drawn_record.hpp"

namespace fpc::bench {
namespace {

using Eigen::Index;
using Engine = std::mt19937_64;

double between(Engine& engine, double lower, double upper) {
  return lower + (upper - lower) * uniform(engine);
}

struct Kind {
  const char* name;
  ProcessElement (*draw)(Engine&);
};

ProcessElement drawnLag(Engine& engine) {
  ProcessElement e;
  e.gain = (uniform(engine) < 0.5 ? -1.0 : 1.0) * std::pow(10.0, between(engine, -0.3, 0.5));
  e.time_constant = between(engine, 4.0, 30.0);
  e.dead_time = between(engine, 0.0, 0.7) * e.time_constant;
  return e;
}
ProcessElement drawnTwoLags(Engine& engine) {
  ProcessElement e = drawnLag(engine);
  e.second = between(engine, 0.3, 0.9) * e.time_constant;
  return e;
}
ProcessElement drawnInverse(Engine& engine) {
  ProcessElement e = drawnTwoLags(engine);
  e.lead = -between(engine, 0.2, 0.6) * e.time_constant;
  return e;
}
ProcessElement drawnPair(Engine& engine) {
  ProcessElement e = drawnLag(engine);
  e.second = e.time_constant;
  e.damping = between(engine, 0.3, 0.9);
  return e;
}
ProcessElement drawnIntegrator(Engine& engine) {
  ProcessElement e = drawnLag(engine);
  e.gain *= 0.05;
  e.second = between(engine, 1.0, 6.0);
  e.dead_time = between(engine, 0.0, 8.0);
  e.time_constant = 0.0;
  e.integrating = true;
  return e;
}
const Kind kKinds[] = {{"a lag and a dead time", drawnLag},
                       {"two lags and a dead time", drawnTwoLags},
                       {"with an inverse response", drawnInverse},
                       {"a pair of complex poles", drawnPair},
                       {"an integrator", drawnIntegrator}};

// ---- records

/// Within the bounds; of the whole record.
struct Covered {
  bool gain{}, dead_time{}, kind{};
  double width{};  // of the gain's bound, in parts of the gain
};

/// Gains of a PI that holds the element with half of what the IMC rule asks (skogestad2003).
void presentControl(const ProcessElement& e, double& kp, double& ki) {
  const double late = e.dead_time + e.second - std::min(e.lead, 0.0) + 0.5;
  if (e.integrating) {
    kp = 0.25 / (e.gain * late);
    ki = kp / (8.0 * late);
  } else {
    kp = 0.5 * e.time_constant / (e.gain * (e.time_constant + late));
    ki = kp / e.time_constant;
  }
}

test::Noise drawnNoise(Engine& engine, const ProcessElement& e, double level) {
  const double effect = std::abs(e.gain) * (e.integrating ? 20.0 : 1.0);
  test::Noise noise;
  noise.measurement = between(engine, 0.02, 0.10) * effect * level;
  noise.coloured = between(engine, 0.0, 0.04) * effect * level;
  noise.drift = between(engine, 0.0, 0.02) * effect * level;
  const double stable = e.integrating ? 1.0 : 1.0 / (e.time_constant + e.second);
  noise.load = between(engine, 0.0, 0.05) * effect * level * stable;
  return noise;
}

Covered coveredBy(const Kind& kind, std::uint64_t seed) {
  auto engine = seededEngine(seed, {35});
  const ProcessElement e = kind.draw(engine);
  double kp = 0.0, ki = 0.0;
  presentControl(e, kp, ki);
  const double level = 1.0;
  const test::Noise noise = drawnNoise(engine, e, level);
  const auto settled = e.integrating ? 40.0 : e.settling();
  const auto rows = static_cast<Index>(between(engine, 20.0, 40.0) * settled) + 200;
  const test::Data d = test::record(e, kp, ki, level, noise, std::min<Index>(rows, 2500), seed);
  Covered c;
  try {
    ProcessFitParams p;
    p.ensemble = 0;
    p.seed = seed;
    const ProcessFit fit = fitProcess(d.u, d.y, 1.0, p);
    const ElementEstimate& found = fit.elements.front();
    c.kind = (fit.kind == ProcessKind::kIntegrating) == e.integrating &&
             fit.kind != ProcessKind::kUnstable;
    c.gain = c.kind && std::abs(found.element.gain - e.gain) <= found.gain_bound;
    c.dead_time =
        c.kind && std::abs(found.element.dead_time - e.dead_time) <= found.dead_time_bound;
    c.width = found.gain_bound / std::abs(e.gain);
  } catch (const std::exception&) {
  }
  return c;
}

double middle(std::vector<double> values) {
  if (values.empty()) return kNaN;
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

void studyRecords(int cases, std::uint64_t first) {
  std::printf("%-26s %4s %8s %8s %11s %14s\n", "process", "n", "kind", "gain", "dead time",
              "gain +- [%]");
  for (const Kind& kind : kKinds) {
    int gains = 0, delays = 0, kinds = 0;
    std::vector<double> widths;
    for (int i = 0; i < cases; ++i) {
      const Covered c = coveredBy(kind, first + static_cast<std::uint64_t>(i));
      gains += c.gain;
      delays += c.dead_time;
      kinds += c.kind;
      if (c.kind) widths.push_back(100.0 * c.width);
    }
    std::printf("%-26s %4d %8d %8d %11d %14.1f\n", kind.name, cases, kinds, gains, delays,
                middle(widths));
    std::fflush(stdout);
  }
}

// ---- fuzzy models

struct Bent {
  bool confirmed{};
  double ratio{1.0};  // of the free runs' errors, the fuzzy model's over the elements'
};

/// Deviation of y less a free run from rest: an offset is an observer's.
double freeRunError(const TsModel& model, const test::Data& d) {
  LocalModel local(model);
  Vector state(local.stateSize()), next(local.stateSize());
  const Vector none = Vector::Zero(countOf(model.disturbances));
  local.restState(d.y.head(1), d.u.row(0).transpose(), none, state);
  double square = 0.0, sum = 0.0;
  for (Index k = 0; k + 1 < d.y.size(); ++k) {
    local.advance(state, d.u.row(k).transpose(), none, next);
    state = next;
    const double e = state[local.outputState(0)] - d.y[k + 1];
    square += e * e;
    sum += e;
  }
  const auto n = static_cast<double>(d.y.size());
  return std::sqrt(square / n - sum * sum / (n * n));
}

Bent bentBy(const Kind& kind, double bend, std::uint64_t seed) {
  auto engine = seededEngine(seed, {38});
  const ProcessElement e = kind.draw(engine);
  double kp = 0.0, ki = 0.0;
  presentControl(e, kp, ki);
  const double level = 1.0;
  const test::Noise noise = drawnNoise(engine, e, level);
  const auto rows = static_cast<Index>(between(engine, 20.0, 40.0) * e.settling()) + 200;
  const test::Data d =
      test::record(e, kp, ki, level, noise, std::min<Index>(rows, 2500), seed, bend);
  Bent result;
  try {
    const test::DrawnModels found = test::drawnModels(test::plantRecord(d), 8, seed);
    result.confirmed = found.hasCurve();
    if (!result.confirmed) return result;
    const test::Data other = test::record(e, 0.0, 0.0, level, {}, 1000, seed + 100000, bend);
    result.ratio =
        freeRunError(found.curved.model, other) / freeRunError(found.straight.model, other);
  } catch (const std::exception&) {
  }
  return result;
}

void studyFuzzy(int cases, std::uint64_t first) {
  std::printf("%-26s %10s %4s %10s %6s %20s\n", "process", "gain grows", "n", "confirmed", "closer",
              "error, of elements'");
  for (const Kind* kind : {&kKinds[0], &kKinds[1], &kKinds[3]})
    for (const double bend : {0.0, 0.4, 0.8}) {
      int confirmed = 0, closer = 0;
      std::vector<double> ratios;
      for (int i = 0; i < cases; ++i) {
        const Bent found = bentBy(*kind, bend, first + static_cast<std::uint64_t>(i));
        confirmed += found.confirmed;
        closer += found.confirmed && found.ratio < 1.0;
        if (found.confirmed) ratios.push_back(found.ratio);
      }
      std::printf("%-26s %10.2g %4d %10d %6d %20.2f\n", kind->name, std::exp(2.0 * bend), cases,
                  confirmed, closer, middle(ratios));
      std::fflush(stdout);
    }
}

// ---- plant time

/// A plant of 1 x 1 or 2 x 2 elements with noise on its outputs.
class DrawnPlant {
 public:
  DrawnPlant(std::vector<std::vector<ProcessElement>> elements, Vector noise, std::uint64_t seed)
      : elements_(std::move(elements)),
        noise_(std::move(noise)),
        engine_(seededEngine(seed, {36})) {
    for (const auto& row : elements_)
      for (const ProcessElement& e : row) responses_.emplace_back(e);
    const auto n = static_cast<Index>(elements_.size());
    u_ = Matrix::Zero(kMost, n);
    coloured_ = Vector::Zero(n);
  }
  Index n() const { return static_cast<Index>(elements_.size()); }
  /// y(k).
  Vector measured() {
    Vector y(n());
    for (Index i = 0; i < n(); ++i) {
      y[i] = 0.0;
      for (Index j = 0; j < n(); ++j)
        y[i] += responses_[static_cast<std::size_t>(i * n() + j)].next(u_.col(j));
      coloured_[i] = 0.9 * coloured_[i] + 0.2 * noise_[i] * standardNormal(engine_);
      y[i] += coloured_[i] + noise_[i] * standardNormal(engine_);
    }
    return y;
  }
  void send(VectorRef input) { u_.row(k_++) = input.transpose(); }
  static constexpr Index kMost = 40000;

 private:
  std::vector<std::vector<ProcessElement>> elements_;
  Vector noise_;
  Engine engine_;
  std::vector<test::Response> responses_;
  Matrix u_;
  Vector coloured_;
  Index k_{};
};

struct Drawn {
  std::vector<std::vector<ProcessElement>> elements;
  Vector noise;
  double settling{};
};

Drawn drawnPlant(const Kind& kind, Index n, std::uint64_t seed) {
  auto engine = seededEngine(seed, {37});
  Drawn d;
  d.noise = Vector::Zero(n);
  for (Index i = 0; i < n; ++i) {
    d.elements.emplace_back();
    for (Index j = 0; j < n; ++j) {
      ProcessElement e = kind.draw(engine);
      if (i != j) e.gain *= 0.5;
      d.settling = std::max(d.settling, e.settling());
      d.elements.back().push_back(e);
    }
    d.noise[i] = 0.02 * std::abs(d.elements.back()[static_cast<std::size_t>(i)].gain);
  }
  return d;
}

struct Known {
  bool all{false};
  std::vector<double> gain, dead_time;  // bounds
};
Known knownFrom(const Matrix& u, const Matrix& y) {
  Known known;
  known.all = true;
  ProcessFitParams p;
  p.ensemble = 0;
  p.passing = true;  // as those with which the test ends
  for (Index i = 0; i < y.cols(); ++i) {
    try {
      const ProcessFit fit = fitProcess(u, y.col(i), 1.0, p);
      for (const ElementEstimate& e : fit.elements) {
        known.all = known.all && e.seen;
        known.gain.push_back(e.gain_bound);
        known.dead_time.push_back(e.dead_time_bound);
      }
    } catch (const std::exception&) {
      known.all = false;
    }
  }
  return known;
}

/// Not wider, but for a tenth.
bool asGood(const Known& a, const Known& b) {
  if (!a.all || a.gain.size() != b.gain.size()) return false;
  double gains = 0.0, delays = 0.0;
  for (std::size_t i = 0; i < a.gain.size(); ++i) {
    gains = std::max(gains, a.gain[i] / std::max(b.gain[i], 1e-12));
    delays = std::max(delays, a.dead_time[i] / std::max(b.dead_time[i], 1e-12));
  }
  return gains <= 1.1 && delays <= 1.1;
}

struct Times {
  double test{}, staircase{};  // settling times; 0: not reached
};

Times timesOf(const Kind& kind, Index n, std::uint64_t seed) {
  const Drawn drawn = drawnPlant(kind, n, seed);
  DrawnPlant plant(drawn.elements, drawn.noise, seed);
  PlantInfo info;
  info.sample_time_s = 1.0;
  for (Index i = 0; i < n; ++i) {
    info.outputs.push_back({"y" + std::to_string(i), "-", -100.0, 100.0});
    info.inputs.push_back({"u" + std::to_string(i), "-", -10.0, 10.0});
  }
  PlantTestParams p;
  p.limits.lower = Vector::Constant(n, -10.0);
  p.limits.upper = Vector::Constant(n, 10.0);
  p.limits.move = Vector::Constant(n, 20.0);
  p.lower.resize(n);
  p.upper.resize(n);
  for (Index i = 0; i < n; ++i) {  // half of what the own input can do
    const auto k = static_cast<std::size_t>(i);
    p.upper[i] = 5.0 * std::abs(drawn.elements[k][k].gain);
    p.lower[i] = -p.upper[i];
  }
  p.hold = Vector::Zero(n);
  p.noise = drawn.noise;
  p.deviation = 1.1 * drawn.noise;
  p.start_input = Vector::Zero(n);
  p.most_rows = DrawnPlant::kMost - 200;
  p.seed = seed;
  PlantRecord watched(info);
  Measurement now;
  now.disturbances.resize(0);
  now.input_applied = Vector::Zero(n);
  for (int k = 0; k < 60; ++k) {
    now.outputs = plant.measured();
    watched.add(now, Vector::Zero(n));
    plant.send(Vector::Zero(n));
  }
  PlantTest test(p, watched);
  const Vector present = Vector::Zero(n);
  while (test.end() == TestEnd::kNone) {
    now.outputs = plant.measured();
    const Vector sent = test.choose(now, present);
    test.add(now, sent);
    plant.send(sent);
  }
  Times times;
  if (test.end() != TestEnd::kEnough) return times;
  times.test = static_cast<double>(test.rows()) / drawn.settling;
  Known reached;
  reached.all = true;
  for (const ProcessFit& fit : test.fits())
    for (const ElementEstimate& e : fit.elements) {
      reached.gain.push_back(e.gain_bound);
      reached.dead_time.push_back(e.dead_time_bound);
    }

  // Up, back, down, back: one input after the other, each level for the true settling time.
  DrawnPlant other(drawn.elements, drawn.noise, seed + 1000);
  const auto hold = static_cast<Index>(std::ceil(drawn.settling));
  const Index most = static_cast<Index>(20.0 * static_cast<double>(test.rows()));
  Matrix u = Matrix::Zero(most + 60, n), y(most + 60, n);
  double next = 2.0 * static_cast<double>(hold * n);
  static constexpr double kLevels[] = {1.0, 0.0, -1.0, 0.0};
  for (Index k = 0; k < most + 60; ++k) {
    y.row(k) = other.measured().transpose();
    if (k >= 60) {
      const Index stair = (k - 60) / hold;
      const Index j = (stair / 4) % n;
      u(k, j) = kLevels[stair % 4] * test.amplitude()[j];
    }
    other.send(u.row(k).transpose());
    const Index tested = k + 1 - 60;
    if (tested < static_cast<Index>(next)) continue;
    next *= 1.25;
    if (!asGood(knownFrom(u.topRows(k + 1), y.topRows(k + 1)), reached)) continue;
    times.staircase = static_cast<double>(tested) / drawn.settling;
    return times;
  }
  return times;
}

void studyTime(int cases, std::uint64_t first) {
  std::printf("%-26s %6s %4s %8s %22s %22s %8s %12s\n", "process", "inputs", "n", "ended",
              "test [settling times]", "staircase", "ratio", "not in 20 x");
  for (const Index n : {Index{1}, Index{2}})
    for (const Kind& kind : {kKinds[0], kKinds[1]}) {
      std::vector<double> test, staircase, ratio;
      int never = 0;
      for (int i = 0; i < cases; ++i) {
        const Times t = timesOf(kind, n, first + static_cast<std::uint64_t>(i));
        if (t.test == 0.0) continue;
        test.push_back(t.test);
        never += t.staircase == 0.0;
        staircase.push_back(t.staircase > 0.0 ? t.staircase : 20.0 * t.test);
        ratio.push_back(t.test / staircase.back());
      }
      std::printf("%-26s %6d %4d %8zu %22.1f %22.1f %8.2f %12d\n", kind.name, static_cast<int>(n),
                  cases, test.size(), middle(test), middle(staircase), middle(ratio), never);
      std::fflush(stdout);
    }
}

}  // namespace
}  // namespace fpc::bench

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  const int cases = argc > 2 ? std::atoi(argv[2]) : 100;
  const auto first = static_cast<std::uint64_t>(argc > 3 ? std::atoi(argv[3]) : 1);
  if (what.empty() || what == "records") fpc::bench::studyRecords(cases, first);
  if (what.empty() || what == "fuzzy") fpc::bench::studyFuzzy(cases, first);
  if (what.empty() || what == "time") fpc::bench::studyTime(std::max(1, cases / 5), first);
  return 0;
}
