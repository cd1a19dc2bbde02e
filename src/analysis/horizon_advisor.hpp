// Proposes a coincidence horizon and a reference speed from what a user can tolerate.
#pragma once

#include <string>
#include <vector>

#include "analysis/closed_loop.hpp"

namespace fpc {

/// Of the linear loop at one horizon, last output, first input.
struct HorizonFigures {
  int coincidence_steps{};
  bool stable{false};  ///< applicable and inside the unit circle
  double radius{};
  double noise_gain{};  ///< std of u per std of white measurement noise [input/output unit]
  int settling{};       ///< samples until a setpoint step stays within 2 %, a_r = 0; -1: never seen
};
HorizonFigures horizonFigures(const LinearModel& model, const LoopLaw& law);
/// The same settling with a reference of pole a_r in [0, 1).
int settlingSamples(const LinearModel& model, const LoopLaw& law, double reference_pole);

struct HorizonLimits {
  double noise_gain;  ///< largest [input/output unit]
  int settling;       ///< largest [samples]
  int longest{200};   ///< horizons tried
};
struct HorizonAdvice {
  bool found{false};
  int coincidence_steps{};
  double reference_pole{};
  HorizonFigures figures;
  std::vector<std::string> reasons;  ///< sentences
};
/// The shortest stable horizon that keeps the noise gain, then the slowest reference that still
/// settles in time: the horizon decides on noise and robustness, the reference on moves.
/// @throws InputError unless the limits are > 0.
HorizonAdvice adviseHorizon(const LinearModel& model, LoopLaw law, const HorizonLimits& limits);

}  // namespace fpc
