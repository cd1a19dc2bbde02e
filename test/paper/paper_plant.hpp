// The activated-sludge plant as the papers' experiments use it: 0.2 h samples over 166 h.
#pragma once

#include <cstdint>
#include <limits>

#include "plant/simulation.hpp"

namespace fpc::test {

constexpr std::uint32_t kPaperSamples = 830;  // 166 h
constexpr double kNominalInput = 570.0;       // q_r [m3/h]

inline Vector loads(double q_i, double s_i) {
  Vector d(2);
  d << q_i, s_i;
  return d;
}

/// Nominal steady state, constant loads, q_r within 0..upper.
inline SimulationParams paperPlant(const Vector& nominal_loads, double upper) {
  SimulationParams params;
  params.plant = "activated_sludge";
  const PlantDescription plant = makePlant(params.plant)->description();
  params.initial_state.resize(static_cast<Eigen::Index>(plant.states.size()));
  for (std::size_t i = 0; i < plant.states.size(); ++i)
    params.initial_state[static_cast<Eigen::Index>(i)] = plant.states[i].nominal;
  params.measured_disturbances = {"q_i", "s_i"};
  const Vector none = Vector::Constant(1, std::numeric_limits<double>::infinity());
  params.actuator.limits = {Vector::Zero(1), Vector::Constant(1, upper), none};
  params.actuator.initial = params.actuator.fallback = Vector::Constant(1, kNominalInput);
  params.disturbance_nominal = nominal_loads;
  params.sample_time_s = 720.0;
  params.samples = kPaperSamples;
  return params;
}

/// Replaces the constant loads by the seeded pattern of the same means.
inline void usePattern(SimulationParams& params, std::uint64_t seed) {
  PatternParams pattern;
  pattern.seed = seed;
  pattern.channels = {{"q_i", "flow", 700.0, 2300.0, params.disturbance_nominal[0]},
                      {"s_i", "load", 150.0, 650.0, params.disturbance_nominal[1]}};
  params.disturbance =
      makePattern(pattern, params.measured_disturbances, params.disturbance_nominal,
                  params.sample_time_s, params.samples);
}

}  // namespace fpc::test
