// Does a new model push the plant the same way as the one it replaces?
#pragma once

#include "fmbpc/base/ring.hpp"
#include "fmbpc/fuzzy/ts_model.hpp"

namespace fpc {

/// n_y n_u: how far each output has moved kGainSamples samples after a step of one unit in an
/// input, with the rules frozen as they fire at the sample, taken as a state of rest. `model` must
/// be matched to the plant. Not finite where the model is unstable.
Matrix stepGains(const TsModel& model, const Measurement& at);
inline constexpr int kGainSamples = 1024;

/// Gains count where they are at least a third of the largest of their output, in both models and
/// in parts of the inputs' ranges. A model that was learned anew may know better in some of them:
/// it is refused if more than half of the outputs have one turned round. Models whose gains are not
/// finite are not judged.
/// @throws InputError naming the first output and input whose sign is turned round.
void requireSameGainSigns(const TsModel& running, const TsModel& fresh, const Measurement& at);

}  // namespace fpc
