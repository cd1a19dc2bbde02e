// fmbpc resolve LOOP: the one text that nodes read.
#include <iostream>

#include "config/plant_loops.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {

int resolve(const std::string& loop, const std::vector<std::string>& set, const std::string& sets,
            bool on_model) {
  Overrides overrides = parseOverrides(set);
  if (on_model) overrides.emplace(overrides.begin(), "plant.type", "model");
  for (const auto& override : parseOverrides(sets)) overrides.push_back(override);
  std::cout << resolveLoop(loop, overrides);
  return 0;
}

int resolvePlant(const std::string& file, const std::vector<std::string>& set,
                 const std::string& sets) {
  Overrides overrides = parseOverrides(set);
  for (const auto& override : parseOverrides(sets)) overrides.push_back(override);
  const PlantLoops plant = readPlantLoops(file, overrides);
  for (const PlantLoop& one : plant.loops) {
    std::cout << one.name << ": " << one.loop.controllerType().name << " on "
              << one.loop.plant_info.name << (one.isolate ? ", in a process of its own" : "")
              << (one.machine.empty() ? "" : ", on " + one.machine) << "\n";
    for (const LoopLink& link : one.links)
      std::cout << "  " << link.name << " from " << link.from << "\n";
  }
  return 0;
}

}  // namespace fpc::tool
