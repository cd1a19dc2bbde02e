#include "tool/rehearsal.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "runtime/loop_probe.hpp"
#include "runtime/run.hpp"

namespace fpc::tool {
namespace {

constexpr double kMoves = 0.1;                                      // of the cost
constexpr int kPoints = 3;                                          // of the course, probed
constexpr std::uint64_t kChosenBy = 1, kJudgedBy[] = {11, 12, 13};  // seeds of the noise

Judged costOf(LoopFile loop, const RehearsalScale& scale, std::uint64_t seed) {
  loop.simulation.noise_seed = seed;
  const RunRecord record = runLoop(loop);
  const InputLimits& limits = loop.simulation.actuator.limits;
  Judged found{record.complete ? 0.0 : kInfinity, Vector::Zero(scale.output.size()), 0.0};
  const auto n = static_cast<double>(record.samples.size());
  const Vector* before = nullptr;
  for (const SampleRecord& s : record.samples) {
    if (!s.has_state || !s.has_tracking) continue;
    const Vector square = (s.tracking.setpoint - s.state.outputs).array().square();
    found.ise += square;
    found.cost += (square.array() / scale.output.array().square()).sum() / n;
    if (!s.has_action) continue;
    if (before != nullptr) {
      const Vector move = s.action.input - *before;
      found.cost += kMoves * (move.array() / scale.input.array()).square().sum() / n;
      found.movement += (move.array().abs() / (limits.upper - limits.lower).array()).mean() / n;
    }
    before = &s.action.input;
  }
  return found;
}

LoopFile onItsModel(const std::string& text, const std::string& name) {
  return parseLoop(text, name, {{"plant.type", "model"}});
}

double peakOf(const LoopFile& loop) {
  const LoopCourse course(loop);
  double worst = 0.0;
  for (const CoursePoint& point : course.points(kPoints)) {
    const LoopProbe probe = probeLoop(course.stayingAt(loop, point), point);
    if (probe.result == ProbeResult::kHeld) continue;
    if (probe.result != ProbeResult::kLinear) return kInfinity;
    worst = std::max(worst, probe.response->peak());
  }
  return worst;
}

}  // namespace

Rehearsed chosenOf(const std::vector<std::string>& texts, const std::string& name,
                   const RehearsalScale& scale) {
  std::vector<Rehearsed> all;
  all.reserve(texts.size());
  for (const std::string& text : texts) all.push_back({text, kInfinity, kInfinity});
  parallelFor(all.size(), 0, [&](std::size_t i) {
    all[i].cost = costOf(onItsModel(all[i].text, name), scale, kChosenBy).cost;
  });
  std::stable_sort(all.begin(), all.end(),
                   [](const Rehearsed& a, const Rehearsed& b) { return a.cost < b.cost; });
  const auto together = static_cast<std::size_t>(coreCount());  // a probe takes as long as 20 runs
  for (std::size_t first = 0; first < all.size(); first += together) {
    const std::size_t n = std::min(together, all.size() - first);
    parallelFor(n, 0, [&](std::size_t i) {
      all[first + i].peak = peakOf(onItsModel(all[first + i].text, name));
    });
    for (std::size_t i = first; i < first + n; ++i)
      if (all[i].peak < kUsualPeak) return all[i];
  }
  return *std::min_element(all.begin(), all.end(),
                           [](const Rehearsed& a, const Rehearsed& b) { return a.peak < b.peak; });
}

Judged judged(const std::string& text, const std::string& name, const RehearsalScale& scale) {
  const LoopFile loop = onItsModel(text, name);
  Judged mean{0.0, Vector::Zero(scale.output.size()), 0.0};
  const double part = 1.0 / static_cast<double>(std::size(kJudgedBy));
  for (const std::uint64_t seed : kJudgedBy) {
    const Judged one = costOf(loop, scale, seed);
    mean.cost += part * one.cost;
    mean.ise += part * one.ise;
    mean.movement += part * one.movement;
  }
  return mean;
}

}  // namespace fpc::tool
