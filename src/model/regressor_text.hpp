// Variables as they stand in model and structure files: "NAME(k)" or "NAME(k-LAG)".
#pragma once

#include <optional>
#include <string>

#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// The variable that TsModel::text() writes so; nothing if the text has another form or names no
/// signal of the model.
std::optional<Regressor> parseRegressor(const TsModel& model, const std::string& text);

}  // namespace fpc
