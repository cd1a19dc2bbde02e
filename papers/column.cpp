// The Wood-Berry column (mekki): gains by recursive least squares (table 1), the swarm and its
// tuning (tables 2 and 3).
#include <algorithm>
#include <random>

#include "base/parallel.hpp"
#include "control/pi/tuning.hpp"
#include "papers/expression.hpp"
#include "papers/fopdt_identification.hpp"
#include "papers/runs.hpp"
#include "papers/words.hpp"

namespace fpc::papers {
namespace {

/// `top` or `bottom`: the element of each loop.
Fopdt elementOf(const std::string& word) {
  return placeOf(word, {"top", "bottom"}) == 0 ? Fopdt{12.8, 16.7, 1.0} : Fopdt{-19.4, 14.4, 3.0};
}

/// estimated_gain(GAIN, TAU, DELAY): what least squares finds of one element from its own output,
/// as the paper takes it: a binary input held 5 samples of a minute, no noise, 600 samples.
Values estimatedGain(const Words& w) {
  const Fopdt element{toNumber(w[0]), toNumber(w[1]), toNumber(w[2])};
  std::mt19937_64 generator(1);
  MisoParams params;
  params.bias = false;
  MisoEstimator estimator(1, 1.0, params);
  LagResponse lag(element, 1.0);
  Vector u = Vector::Constant(1, 1.0);
  for (int k = 0; k < 600; ++k) {
    if (k % 5 == 0) u[0] = generator() & 1U ? 1.0 : -1.0;
    estimator.update(u, element.gain * lag.advance(u[0]));
  }
  const auto found = estimator.element(0);
  return found ? found->gain : kNotPrinted;
}

/// printed_swarm(LOOP): least J with the printed swarm over the least that any swarm finds, 24
/// seeds.
Values printedSwarm(const Words& w) {
  const Fopdt element = elementOf(w[0]);
  const auto cost = [&](const SwarmParams& swarm) {
    StepExperiment experiment(element, {});
    return experiment.run(swarmTuning(element, TuningCost::kStepTimes, {}, swarm)).cost();
  };
  std::vector<double> printed(seeds()), ours(seeds());
  parallelFor(printed.size(), 0, [&](std::size_t i) {
    SwarmParams falling;
    falling.seed = i + 1;
    SwarmParams constant = falling;
    constant.inertia_start = constant.inertia_end = 0.9;
    printed[i] = cost(constant);
    ours[i] = cost(falling);
  });
  const double least = std::min(Values(ours).lowest(), Values(printed).lowest());
  for (double& one : printed) one /= least;
  return printed;
}

/// pi_tuning(LOOP, imc|pso, kp|Ti, LAMBDA): by internal model control, or by our swarm.
Values piTuning(const Words& w) {
  const Fopdt element = elementOf(w[0]);
  const PiTuning tuning = placeOf(w[1], {"imc", "pso"}) == 0
                              ? imcTuning(element, toNumber(w[3]))
                              : swarmTuning(element, TuningCost::kStepTimes);
  return placeOf(w[2], {"kp", "Ti"}) == 0 ? tuning.kp : tuning.integral_time_min;
}

const bool kRegistered = registerComputation("estimated_gain", 3, estimatedGain) &&
                         registerComputation("printed_swarm", 1, printedSwarm) &&
                         registerComputation("pi_tuning", 4, piTuning);

}  // namespace
}  // namespace fpc::papers
