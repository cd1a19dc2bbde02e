// The report of `fmbpc stability` as a person reads it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace fpc::tool {

using Json = nlohmann::ordered_json;

std::string stabilityTable(const Json& report);

}  // namespace fpc::tool
