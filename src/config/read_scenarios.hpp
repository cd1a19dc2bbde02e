// What tuning files and study files share. Private to the room.
#pragma once

#include <string>
#include <vector>

#include "base/yaml_node.hpp"
#include "config/tuning_file.hpp"

namespace fpc {

/// Section `fitness`; in a tuning with the keys that make one number of many runs.
FitnessParams readFitness(YamlSection& root, bool of_tuning);
/// Under `set`: changes of the loop as --set makes them.
Overrides readSet(YamlSection& section);
/// Under `key`: a list of scenarios, or {seeds: [...]}; each with a name of its own.
std::vector<TuningScenario> readScenarios(YamlSection& root, const std::string& key);

}  // namespace fpc
