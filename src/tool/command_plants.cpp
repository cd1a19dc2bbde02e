// fmbpc plants: what can be simulated.
#include <algorithm>
#include <iomanip>
#include <iostream>

#include "base/finite_json.hpp"
#include "base/ordered_json.hpp"
#include "fmbpc/plant/plant.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {
namespace {

using Json = OrderedJson;
using Groups = std::vector<std::pair<std::string, const std::vector<Quantity>*>>;

Groups groupsOf(const PlantDescription& plant) {
  return {{"states", &plant.states},
          {"algebraic", &plant.algebraic},
          {"inputs", &plant.inputs},
          {"disturbances", &plant.disturbances},
          {"parameters", &plant.parameters}};
}

Json toJson(const PlantDescription& plant) {
  Json json{{"name", plant.name}, {"title", plant.title}, {"time_unit_s", plant.time_unit_s}};
  json["outputs"] = plant.outputs;
  for (const auto& [group, quantities] : groupsOf(plant)) {
    json[group] = Json::array();
    for (const auto& q : *quantities)
      json[group].push_back({{"name", q.name},
                             {"unit", q.unit},
                             {"nominal", q.nominal},
                             {"lower", numberOrNull(q.lower)},
                             {"upper", numberOrNull(q.upper)}});
  }
  return json;
}

void print(const PlantDescription& plant) {
  std::cout << plant.name << ": " << plant.title << "\n";
  for (const auto& [group, quantities] : groupsOf(plant)) {
    if (!quantities->empty())
      std::cout << "  " << std::left << std::setw(26) << group << std::setw(8) << "unit"
                << std::right << std::setw(12) << "nominal"
                << "   range\n";
    for (const auto& q : *quantities)
      std::cout << "    " << std::left << std::setw(24) << q.name << std::setw(8) << q.unit
                << std::right << std::setw(12) << q.nominal << "   " << q.lower << " .. " << q.upper
                << "\n";
  }
}

}  // namespace

int plants(bool json) {
  loadPluginsOfLoops();
  Json all = Json::array();
  for (const auto& name : plantNames()) {
    const PlantDescription description = makePlant(name)->description();
    if (json)
      all.push_back(toJson(description));
    else
      print(description);
  }
  for (const auto& [name, title] : plantTypes()) {
    const auto known = plantNames();
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    if (json)
      all.push_back({{"name", name}, {"title", title}});
    else
      std::cout << name << ": " << title << "\n";
  }
  if (json) std::cout << Json{{"plants", all}}.dump(2) << "\n";
  return 0;
}

}  // namespace fpc::tool
