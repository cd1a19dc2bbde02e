// Gains, time constants, poles, dead times and step responses of a model, as a table and as JSON.
#pragma once

#include <string>

#include "base/ordered_json.hpp"
#include "fmbpc/model/ts_model.hpp"

namespace fpc::tool {

/// Empty if the model does not say the ranges of its signals.
std::string pointsTable(const TsModel& model);
/// [{name, rests, inputs, outputs, poles, time_constants_s, gains.<y>.<u>, dead_time_s.<y>.<u>,
/// steps.<y>.<u>}]; gains of an integrator are null.
OrderedJson pointsJson(const TsModel& model);

}  // namespace fpc::tool
