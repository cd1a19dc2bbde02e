// Model files: readable YAML, lossless both ways.
#pragma once

#include <string>

#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// @throws InputError naming file, line and key.
TsModel readModel(const std::string& file);
TsModel parseModel(const std::string& text, const std::string& name);
std::string writeModel(const TsModel& model);

}  // namespace fpc
