// The stirred-tank reactor (blazic2007): its static curve, the propositions on the horizon, what
// the dead time leaves to any law, and the optimum of the PI.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "analysis/transfer.hpp"
#include "papers/expression.hpp"
#include "papers/picture.hpp"
#include "papers/runs.hpp"
#include "papers/words.hpp"
#include "runtime/plant_continuation.hpp"

namespace fpc::papers {
namespace {

PlantContinuation continuationOf(double compensator) {
  const std::shared_ptr<const Plant> plant = makePlant("cstr", {{"compensator_gain", compensator}});
  return plantContinuation(plant, 0, 6.0, -1.0, -1.0);
}

/// special(fold|hopf, COMPENSATOR, NUMBER, q_c|CA): the largest coolant flow first.
Values special(const Words& w) {
  const SpecialKind kind =
      placeOf(w[0], {"fold", "hopf"}) == 0 ? SpecialKind::kFold : SpecialKind::kHopf;
  const PlantContinuation set = continuationOf(toNumber(w[1]));
  std::vector<SpecialPoint> found;
  for (const auto& branch : continueBranches(set.problem, set.params))
    for (const auto& point : branch.special)
      if (point.kind == kind) found.push_back(point);
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.parameter > b.parameter; });
  const std::size_t i = toIndex(w[2]);
  if (i >= found.size()) return kNotPrinted;
  return placeOf(w[3], {"q_c", "CA"}) == 0 ? found[i].parameter : found[i].state[0];
}

/// nominal(CA|T): of the working branch, at the nominal coolant flow.
Values nominal(const Words& w) {
  const auto i = static_cast<Eigen::Index>(placeOf(w[0], {"CA", "T"}));
  const PlantContinuation set = continuationOf(0.0);
  for (const auto& point : steadyStatesAt(set.problem, set.params, 103.4066))
    if (point.state[0] < 0.12) return point.state[i];
  return kNotPrinted;
}

/// propositions(gain_below|zeros|poles): the largest over the six rules of eq. 12.
Values propositions(const Words& w) {
  constexpr double kA1[] = {-1.3462, -1.4506, -1.5681, -1.7114, -1.8111, -1.9157};
  constexpr double kA2[] = {0.4298, 0.5262, 0.6437, 0.7689, 0.8592, 0.9485};
  constexpr double kB[] = {1.8124e-4, 2.1795e-4, 2.7762e-4, 2.6703e-4, 2.8716e-4, 2.85e-4};
  double Propositions::*const parts[] = {&Propositions::gain_below, &Propositions::zeros_distance,
                                         &Propositions::poles_distance};
  const auto part = parts[placeOf(w[0], {"gain_below", "zeros", "poles"})];
  double worst = 0.0;
  for (int i = 0; i < 6; ++i)
    worst = std::max(worst, checkPropositions(canonicalRule(kA1[i], kA2[i], kB[i]), 3000).*part);
  return worst;
}

constexpr int kDelaySteps = 5;  // of the measurement
constexpr double kReferencePole = 0.96;

/// What is measured before an answer to steps of the setpoint can be: y goes on along the old y_r.
double unansweredSteps(const RunRecord& run) {
  double sum = 0.0, before = run.samples[0].measurement.outputs[0];
  for (const auto& sample : run.samples) {
    if (!sample.has_tracking) continue;
    const double step = sample.tracking.setpoint[0] - before;
    for (int j = 1; j <= kDelaySteps; ++j)
      sum += std::pow(step * (1.0 - std::pow(kReferencePole, j)), 2);
    before += step;
  }
  return sum;
}

/// What a step of the disturbance does in an open loop before an answer to it is measured: one
/// sample and the delay until it is seen, the same again until the answer is.
double unansweredLoad(double step) {
  const RunRecord& run =
      recordOf("cstr_disturbance_pi", {{"controller.loops.0.kp", "0"},
                                       {"controller.loops.0.ki_per_h", "0"},
                                       {"disturbance.commands.0.value", std::to_string(step)}});
  constexpr int kOn = 50;  // 5 min
  double sum = 0.0;
  for (int k = kOn; k <= kOn + 2 * kDelaySteps + 1; ++k)
    sum += std::pow(run.samples.at(static_cast<std::size_t>(k)).measurement.outputs[0] - 0.1, 2);
  return sum;
}

/// dead_time_bound(LOOP): the least sum (y_r - y)^2 of any law without preview.
Values deadTimeBound(const Words& w) {
  return placeOf(w[0], {"cstr_tracking", "cstr_disturbance"}) == 0
             ? unansweredSteps(recordOf(w[0]))
             : 2.0 * (unansweredLoad(3.0) + unansweredLoad(-3.0));  // on and off, twice
}

double tuned(double kp, double Ti_min) {
  const Summary run = freshSummaryOf(
      "cstr_tracking_pi", {{"controller.loops.0.kp", std::to_string(kp)},
                           {"controller.loops.0.ki_per_h", std::to_string(60.0 * kp / Ti_min)}});
  return run.outputs.at(0).ise_reference;
}

/// Least of `cost` over two positive numbers: a compass search in their logarithms.
std::pair<double, double> leastOf(const std::function<double(double, double)>& cost, double a,
                                  double b) {
  double best = cost(a, b);
  for (double factor = 1.3; factor > 1.002; factor = std::sqrt(factor)) {
    for (bool moved = true; moved;) {
      moved = false;
      for (const auto& [p, q] :
           {std::pair{factor, 1.0}, {1.0 / factor, 1.0}, {1.0, factor}, {1.0, 1.0 / factor}}) {
        const double there = cost(a * p, b * q);
        if (!(there < best)) continue;
        best = there;
        a *= p;
        b *= q;
        moved = true;
      }
    }
  }
  return {a, b};
}

/// pi_optimum(kp|Ti|excess): of the PI for experiment 1; excess: the sum at the printed optimum
/// over the least.
Values piOptimum(const Words& w) {
  static const auto least = leastOf(tuned, 40.0, 1.0);
  const std::size_t what = placeOf(w[0], {"kp", "Ti", "excess"});
  if (what == 2) return tuned(64.6454, 0.6721) / tuned(least.first, least.second);
  return what == 0 ? least.first : least.second;
}

const bool kRegistered = registerComputation("special", 4, special) &&
                         registerComputation("nominal", 1, nominal) &&
                         registerComputation("propositions", 1, propositions) &&
                         registerComputation("dead_time_bound", 1, deadTimeBound) &&
                         registerComputation("pi_optimum", 1, piOptimum);

const bool kPicture = registerPicture("cstr_figure_1", [] {
  const LoopFile loop = readLoop("cstr_tracking_literal");
  return pictureOfSets(loop.model.submodels.at(0), 0, "CA [mol/l]", 0.04, 0.19);
});

}  // namespace
}  // namespace fpc::papers
