// The report of `fmbpc stability` as a person reads it.
#pragma once

#include <string>

#include "base/ordered_json.hpp"

namespace fpc::tool {

using Json = OrderedJson;

std::string stabilityTable(const Json& report);

}  // namespace fpc::tool
