// Open-loop records of the activated-sludge plant and the models that they give: the seeded runs
// that stand for the records of the thesis, which were never published.
#pragma once

#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "fmbpc/model/ts_model.hpp"
#include "identification/data_set.hpp"

namespace fpc::papers {

/// The run of a loop with `seed` for influent and excitation, as identification data.
/// @throws InputError if it cannot be run.
DataSet excited(const std::string& loop, const Structure& structure, int seed,
                const Overrides& overrides = {});
/// Models of a shipped structure from the records of asp_excite with seeds 1 to seeds(), identified
/// once in a call of the tool, on all cores.
const std::vector<TsModel>& modelsOver(const std::string& structure);

}  // namespace fpc::papers
