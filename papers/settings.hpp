// Changes of a loop that papers/KEY.yaml names, for runs such as "column_pso+gains_max".
#pragma once

#include <map>
#include <string>
#include <vector>

#include "config/loop_file.hpp"

namespace fpc::papers {

/// More than one: as many runs.
using Settings = std::map<std::string, std::vector<Overrides>>;
const Settings& settings();

}  // namespace fpc::papers
