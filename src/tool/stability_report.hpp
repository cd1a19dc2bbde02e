// The report of `fmbpc stability` as a person reads it.
#pragma once

#include <string>

#include "base/ordered_json.hpp"
#include "tool/stability_subject.hpp"

namespace fpc::tool {

using Json = OrderedJson;

struct StabilityArguments;
/// What `fmbpc stability --json` prints. @throws InputError naming what was not understood.
Json stabilityReport(const StabilityArguments& arguments);
/// By name, of the model's signals and the plant's states and inputs.
Json unitsOf(const StabilitySubject& subject);
/// `report` with the key "units" of unitsOf().
std::string stabilityTable(const Json& report);

}  // namespace fpc::tool
