// The Wood-Berry column (mekki): gains by recursive least squares (table 1), the swarm and
// its tuning (tables 2 and 3).
#include <cmath>
#include <random>

#include "base/parallel.hpp"
#include "control/pi/tuning.hpp"
#include "identification/fopdt_identification.hpp"
#include "papers/experiment.hpp"
#include "papers/runs.hpp"

namespace fpc::tool {
namespace {

constexpr char kPaper[] = "mekki";
constexpr double kClose = 0.06;
const Fopdt kTop{12.8, 16.7, 1.0}, kBottom{-19.4, 14.4, 3.0};

/// The gain that least squares finds of one element from its own output, as the paper takes it: a
/// binary input held 5 samples of a minute, no noise, 600 samples.
double estimatedGain(const Fopdt& element) {
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
  return found ? found->gain : notPrinted();
}

Rows table1() {
  const struct {
    const char* name;
    Fopdt element;
    double max, min;
  } elements[] = {{"K11", {12.8, 16.7, 1.0}, 15.36, 10.24},
                  {"K12", {-18.9, 21.0, 3.0}, -15.12, -22.68},
                  {"K21", {6.6, 10.9, 7.0}, 7.92, 5.28},
                  {"K22", {-19.4, 14.4, 3.0}, -15.52, -23.28}};
  Rows rows;
  for (const auto& e : elements)
    for (const auto& [what, gain] : {std::pair<const char*, double>{"nominal", e.element.gain},
                                     {"Max", e.max},
                                     {"Min", e.min}}) {
      Fopdt element = e.element;
      element.gain = gain;
      rows.push_back(figure(std::string("estimated ") + e.name + ", " + what, gain,
                            estimatedGain(element), "mol%/(lb/min)", {},
                            "from the element's own output, which no column offers"));
    }
  return rows;
}

double costOf(const Fopdt& element, const PiTuning& tuning) {
  StepExperiment experiment(element, {});
  return experiment.run(tuning).cost();
}

/// Least J with the printed swarm over the least that any of our swarms finds.
Values printedSwarm(const Fopdt& element) {
  std::vector<double> printed(kSeeds), ours(kSeeds);
  parallelFor(printed.size(), 0, [&](std::size_t i) {
    SwarmParams falling;
    falling.seed = i + 1;
    SwarmParams constant = falling;
    constant.inertia_start = constant.inertia_end = 0.9;
    printed[i] = costOf(element, swarmTuning(element, TuningCost::kStepTimes, {}, constant));
    ours[i] = costOf(element, swarmTuning(element, TuningCost::kStepTimes, {}, falling));
  });
  const double least = std::min(Values(ours).lowest(), Values(printed).lowest());
  for (double& cost : printed) cost /= least;
  return printed;
}

Rows table2() {
  const char* note = "w 0.9 constant, C 1.8, 50 particles, 50 iterations; 24 seeds";
  return {check("J of loop 1, printed swarm / least found", printedSwarm(kTop), Direction::kLower,
                1.01, "-", note),
          check("J of loop 2, printed swarm / least found", printedSwarm(kBottom),
                Direction::kLower, 1.01, "-", note)};
}

Rows table3() {
  const char* printed = "loop 2 of table 3 contradicts tables 4 and 5 under every reading";
  const char* fitted =
      "fitted to this figure: lambda, 3.9 and 8 min, of kp = (tau + theta/2) / (K (lambda + "
      "theta/2))";
  const char* rule = "tau + theta/2, whatever lambda is";
  const char* gain = "(lb/min)/mol%";
  const PiTuning imc_1 = imcTuning(kTop, 3.9), imc_2 = imcTuning(kBottom, 8.0);
  const PiTuning pso_1 = swarmTuning(kTop, TuningCost::kStepTimes);
  const PiTuning pso_2 = swarmTuning(kBottom, TuningCost::kStepTimes);
  const Judged judged{kClose};
  return {
      incomparable("IMC-PI 1, Kp", 0.3054, imc_1.kp, gain, fitted),
      figure("IMC-PI 1, Ti", 17.25, imc_1.integral_time_min, "min", judged, rule),
      incomparable("IMC-PI 2, Kp", -0.0863, imc_2.kp, gain, fitted),
      figure("IMC-PI 2, Ti", 15.98, imc_2.integral_time_min, "min", judged, rule),
      figure("PSO-PI 1, Kp", 0.6116, pso_1.kp, gain, judged, "J jumps at the 2 % band"),
      figure("PSO-PI 1, 1/Ti", 0.0475, 1.0 / pso_1.integral_time_min, "1/min", judged,
             "printed as Ti: as a time the loop is unstable"),
      figure("PSO-PI 2, Kp", -0.1442, pso_2.kp, gain, judged, printed),
      figure("PSO-PI 2, 1/Ti", 0.0312, 1.0 / pso_2.integral_time_min, "1/min", judged, printed)};
}

const bool kRegistered = registerExperiments(
    {{"column_table_1", kPaper, "table 1", "gains, nominal and changed, by least squares",
      "12 numbers", "MisoEstimator, one element at a time", table1},
     {"column_table_2", kPaper, "table 2", "settings of the swarm", "4 settings", "swarmTuning()",
      table2},
     {"column_table_3", kPaper, "table 3", "settings of the PI loops", "8 numbers",
      "imcTuning(), swarmTuning()", table3}});

}  // namespace
}  // namespace fpc::tool
