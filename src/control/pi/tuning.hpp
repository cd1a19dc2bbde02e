// PI settings for a lag with dead time: by rule, or by a particle swarm on the step response.
#pragma once

#include <cstdint>
#include <vector>

#include "base/fopdt.hpp"
#include "optim/particle_swarm.hpp"

namespace fpc {

/// u = kp (e + (1/Ti) int e dt).
struct PiTuning {
  double kp{};
  double integral_time_min{};
};

/// kp = (tau + theta/2) / (K (lambda + theta/2)), Ti = tau + theta/2: internal model control with a
/// first-order Pade dead time (rivera1986). lambda: time constant asked for.
/// @throws InputError unless lambda > 0.
PiTuning imcTuning(const Fopdt& element, double lambda_min);

/// How the closed loop answers a unit step of the setpoint.
struct StepQuality {
  double rise_time{};                                                    ///< 10 to 90 %, min
  double settling_time{};                                                ///< into 2 % for good, min
  double overshoot{};                                                    ///< fraction of the step
  double iae{};                                                          ///< integral of |e|, min
  double cost() const { return rise_time + settling_time + overshoot; }  ///< J of mekki
};
struct StepTest {
  double duration_min{60.0};
  double sample_time_min{0.02};
};
/// The PI is sampled (backward Euler), the element exact. A rise or settling that does not happen
/// counts as the whole duration; a loop that runs away gives infinite numbers. No allocation in
/// run(), so that a swarm can call it often.
class StepExperiment {
 public:
  StepExperiment(const Fopdt& element, const StepTest& test);
  StepQuality run(const PiTuning& tuning);

 private:
  Fopdt element_;
  StepTest test_;
  LagResponse response_;
  std::vector<double> outputs_;
};

/// What the swarm minimises.
enum class TuningCost { kStepTimes, kIae };
/// The swarm's optimum over kp in (0, 3] tau / (K theta) (or 30 / K without dead time) and Ti in
/// [0.1, 5] (tau + theta). Same params, same answer.
PiTuning swarmTuning(const Fopdt& element, TuningCost cost, const StepTest& test = {},
                     SwarmParams params = {});

}  // namespace fpc
