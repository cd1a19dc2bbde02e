// The activated-sludge plant at its nominal point, for the tests of Simulation.
#pragma once

#include <limits>

#include "plant/simulation.hpp"

namespace fpc {

inline Vector one(double value) { return Vector::Constant(1, value); }

inline SimulationParams sludgeParams(std::uint32_t samples = 20) {
  SimulationParams p;
  p.plant = "activated_sludge";
  p.initial_state = Vector(6);
  p.initial_state << 200.0, 2000.0, 2.0, 80.0, 600.0, 6000.0;
  p.outputs = {"s", "x"};
  p.measured_disturbances = {"q_i", "s_i"};
  p.actuator.limits = {one(0.0), one(1600.0), one(std::numeric_limits<double>::infinity())};
  p.actuator.initial = one(570.0);
  p.actuator.fallback = one(570.0);
  p.disturbance_nominal = Eigen::Vector2d(1300.0, 366.67);
  p.noise_std = Vector::Zero(2);
  p.sample_time_s = 720.0;
  p.samples = samples;
  return p;
}

/// Column k is (1300 + k, 366.67 - k).
inline DisturbanceRecord rampRecord(std::uint32_t samples) {
  DisturbanceRecord record{Matrix(2, samples + 1), 0};
  for (Eigen::Index k = 0; k <= samples; ++k) {
    record.values(0, k) = 1300.0 + static_cast<double>(k);
    record.values(1, k) = 366.67 - static_cast<double>(k);
  }
  return record;
}

inline Command command(const std::string& name, double value,
                       CommandMode mode = CommandMode::kOverride) {
  return {0, {name}, {value}, mode};
}

}  // namespace fpc
