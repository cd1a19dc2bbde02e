// What `fmbpc health` judges: loops out of run folders, and of any historian's table.
#pragma once

#include <string>
#include <vector>

#include "supervision/health/loop_health.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {

/// One loop with the name of its page.
struct NamedRecord {
  std::string name;
  ControlRecord record;
};

/// All loops of the records that the command names; `remarks`: what was done to them.
/// @throws InputError naming file, column and what was expected.
std::vector<NamedRecord> healthRecords(const HealthArguments& arguments,
                                       std::vector<std::string>& remarks);

}  // namespace fpc::tool
