#include "fmbpc/plant/plant.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <shared_mutex>

#include "base/code_address.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "plant/registered_code.hpp"

namespace fpc {
namespace {

/// Made at first use: plants of other files register while static objects are still being built.
std::map<std::string, PlantFactory>& registry() {
  static std::map<std::string, PlantFactory> plants;
  return plants;
}

struct ReadPlant {
  std::string title;
  PlantReader reader;
};

std::map<std::string, ReadPlant>& readers() {
  static std::map<std::string, ReadPlant> plants;
  return plants;
}

std::vector<std::string>& refused() {
  static std::vector<std::string> names;
  return names;
}

/// A class of Python may register while other threads make plants.
std::shared_mutex& registryMutex() {
  static std::shared_mutex mutex;
  return mutex;
}

}  // namespace

std::unique_ptr<PlantStepper> Plant::makeStepper(double) const { return nullptr; }

template <>
void requireSameLayout<PlantLayout>() {}

bool addPlant(const std::string& name, PlantFactory factory) {
  const std::unique_lock lock(registryMutex());
  const bool is_new =
      readers().count(name) == 0 && registry().emplace(name, std::move(factory)).second;
  if (!is_new) refused().push_back(name);
  return is_new;
}

bool registerPlantReader(const std::string& name, const std::string& title, PlantReader reader) {
  const std::unique_lock lock(registryMutex());
  const bool is_new = registry().count(name) == 0 &&
                      readers().emplace(name, ReadPlant{title, std::move(reader)}).second;
  if (!is_new) refused().push_back(name);
  return is_new;
}

std::map<std::string, std::string> plantTypes() {
  std::map<std::string, std::string> types;
  for (const std::string& name : plantNames()) types[name] = makePlant(name)->description().title;
  const std::shared_lock lock(registryMutex());
  for (const auto& [name, read] : readers()) types[name] = read.title;
  return types;
}

PlantFactory plantFactory(const std::string& type, YamlSection& plant) {
  const auto read = readers().find(type);
  if (read != readers().end()) return read->second.reader(plant);
  return [type](const PlantParameters& parameters) { return makePlant(type, parameters); };
}

std::vector<std::string> refusedPlants() { return refused(); }

std::unique_ptr<Plant> makePlant(const std::string& name, const PlantParameters& parameters) {
  PlantFactory make;
  {
    const std::shared_lock lock(registryMutex());
    const auto found = registry().find(name);
    if (found != registry().end()) make = found->second;
  }
  require(make != nullptr, "plant.type '" + name + "'", "one of " + join(plantNames()));
  return make(parameters);
}

std::vector<std::string> plantNames() {
  const std::shared_lock lock(registryMutex());
  std::vector<std::string> names;
  for (const auto& entry : registry()) names.push_back(entry.first);
  return names;
}

std::vector<const void*> plantCode() {
  std::vector<const void*> code;
  for (const auto& entry : registry()) code.push_back(codeAddress(entry.second));
  for (const auto& entry : readers()) code.push_back(codeAddress(entry.second.reader));
  return code;
}

void Plant::algebraic(VectorRef, VectorRef, VectorRef, Eigen::Ref<Vector>) const {}

void Plant::localLoop(VectorRef, VectorRef, Eigen::Ref<Vector>) const {}

Vector parameterValues(const PlantDescription& description, const PlantParameters& parameters) {
  const auto& known = description.parameters;
  Vector values(static_cast<Eigen::Index>(known.size()));
  for (std::size_t i = 0; i < known.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = known[i].nominal;
  for (const auto& [name, value] : parameters) {
    const std::string where = "plant.parameters." + name;
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&key = name](const Quantity& q) { return q.name == key; });
    require(found != known.end(), where, "one of " + join(namesOf(known)));
    require(std::isfinite(value) && value >= found->lower && value <= found->upper, where,
            "a number >= " + exactText(found->lower) + " and <= " + exactText(found->upper) + " [" +
                found->unit + "], got " + exactText(value));
    values[found - known.begin()] = value;
  }
  return values;
}

}  // namespace fpc
