// The plant's own equations as a controller's model: for a baseline that is told the truth.
#pragma once

#include <memory>

#include "control/mpc/sample_model.hpp"
#include "plant/simulation.hpp"

namespace fpc {

/// One sample of the plant: its difference equation if it is one without memory, otherwise Runge
/// and Kutta's rule, and its local loop. Measured disturbances as measured, the others nominal.
/// State: the plant's states, then those of one sample before. Where all states are measured that
/// is all there is to know; otherwise the other states are simulated beside the plant, and rest()
/// brings them to where they rest while the measured ones are held: by Newton's method from the
/// plant's initial state, so that they need not settle by themselves; where that ends at values the
/// plant cannot have, by simulation.
/// @throws InputError for a plant that remembers more than its states (dead times) or whose outputs
/// are measured late.
std::unique_ptr<SampleModel> makePlantSampleModel(const SimulationParams& params,
                                                  int integration_steps);

}  // namespace fpc
