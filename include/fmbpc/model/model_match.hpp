// A model brought into the order of the plant.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// Reorders the model's names to the plant's (readers may then index by PlantInfo order). Signals
/// the model does not use stay unused; plant outputs the model does not predict are not allowed.
/// A sample time within 0.1 % of the plant's is the plant's: records round their times, and time
/// constants off by as much are far better than any identified.
/// Disturbances of the model that the plant does not measure and `estimated` names become
/// unmeasured ones; what the model calls unmeasured already stays so.
/// @throws InputError naming the signal that the plant lacks, a missing output, another sample
/// time, another unit.
TsModel matchToPlant(const TsModel& model, const PlantInfo& plant,
                     const std::vector<std::string>& estimated = {});

/// The same model with its unmeasured disturbances behind the others, as in files and messages.
TsModel asIdentified(TsModel model);

}  // namespace fpc
