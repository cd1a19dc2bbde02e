// Signals of a random transfer matrix, and a law with a model for them.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/plant/plant.hpp"
#include "random/dice.hpp"

namespace fpc {

/// In plain units; the first output and the first input are written in units so many times as
/// large, and the first output above a zero of its own.
struct MatrixSignals {
  std::vector<Quantity> outputs, inputs;
  double output_unit{1.0}, input_unit{1.0}, output_zero{0.0};
};

/// The file of a model of one to three rules.
std::string matrixModel(Dice& dice, const MatrixSignals& signals, double sample_time_s);
/// Sections `controller` of type fmbpc, fuzzy_optimal or swarm_mpc, and maybe `clp`.
std::string matrixLaw(Dice& dice, const std::string& type, const MatrixSignals& signals);

}  // namespace fpc
