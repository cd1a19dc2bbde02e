// What `fmbpc health` writes: a page with pictures for each loop, a table of the plant, JSON.
#pragma once

#include <string>
#include <vector>

#include "base/ordered_json.hpp"
#include "supervision/health/loop_health.hpp"
#include "tool/health_records.hpp"

namespace fpc::tool {

OrderedJson toJson(const LoopHealth& health, const std::string& name);
std::string healthTable(const std::vector<NamedRecord>& records,
                        const std::vector<LoopHealth>& loops);
/// NAME.html of each loop, index.html, health.json. @throws InputError if they cannot be written.
void writeHealth(const std::vector<NamedRecord>& records, const std::vector<LoopHealth>& loops,
                 const std::string& folder);

}  // namespace fpc::tool
