#include "fmbpc/control/registry.hpp"

#include <map>
#include <mutex>
#include <shared_mutex>

#include "base/code_address.hpp"
#include "control/registered_code.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

struct Entry {
  ControllerType type;
  ControllerReader read;
};

/// Made at first use: types of other files register while static objects are still being built.
std::map<std::string, Entry>& registry() {
  static std::map<std::string, Entry> types;
  return types;
}

std::vector<std::string>& refused() {
  static std::vector<std::string> names;
  return names;
}

/// A class of Python may register while other threads read loops.
std::shared_mutex& registryMutex() {
  static std::shared_mutex mutex;
  return mutex;
}

const Entry& entryOf(const std::string& name) {
  const Entry* entry = nullptr;
  {
    const std::shared_lock lock(registryMutex());
    const auto found = registry().find(name);
    if (found != registry().end()) entry = &found->second;
  }
  require(entry != nullptr, "controller.type '" + name + "'", "one of " + join(controllerNames()));
  return *entry;
}

}  // namespace

template <>
void requireSameLayout<ControllerLayout>() {}

SignalUse noSignal(const ControllerContext& loop) {
  return {
      std::vector<bool>(loop.plant.outputs.size() + loop.plant.disturbances.size(), false), {}, {}};
}

SignalUse everySignal(const ControllerContext& loop) {
  SignalUse use = noSignal(loop);
  use.needed.assign(use.needed.size(), true);
  for (Eigen::Index i = 0; i < loop.outputCount(); ++i) use.followed.push_back(i);
  return use;
}

std::vector<bool> theseInputs(const ControllerContext& loop, const std::vector<int>& inputs) {
  std::vector<bool> these(loop.plant.inputs.size(), false);
  for (const int input : inputs) these[static_cast<std::size_t>(input)] = true;
  return these;
}

std::vector<Eigen::Index> weighted(VectorRef weight_output) {
  std::vector<Eigen::Index> outputs;
  for (Eigen::Index i = 0; i < weight_output.size(); ++i)
    if (weight_output[i] > 0.0) outputs.push_back(i);
  return outputs;
}

std::vector<std::string> ControllerContext::outputs() const { return namesOf(plant.outputs); }
std::vector<std::string> ControllerContext::inputs() const { return namesOf(plant.inputs); }
std::vector<std::string> ControllerContext::disturbances() const {
  return namesOf(plant.disturbances);
}
Eigen::Index ControllerContext::outputCount() const {
  return static_cast<Eigen::Index>(plant.outputs.size());
}
Eigen::Index ControllerContext::inputCount() const {
  return static_cast<Eigen::Index>(plant.inputs.size());
}

bool registerControllerReader(ControllerType type, ControllerReader read) {
  const std::unique_lock lock(registryMutex());
  const std::string name = type.name;
  const bool is_new = registry().emplace(name, Entry{std::move(type), std::move(read)}).second;
  if (!is_new) refused().push_back(name);
  return is_new;
}

std::vector<std::string> refusedControllers() {
  const std::shared_lock lock(registryMutex());
  return refused();
}

std::vector<const void*> controllerCode() {
  const std::shared_lock lock(registryMutex());
  std::vector<const void*> code;
  for (const auto& entry : registry()) code.push_back(codeAddress(entry.second.read));
  return code;
}

std::vector<std::string> controllerNames() {
  const std::shared_lock lock(registryMutex());
  std::vector<std::string> names;
  for (const auto& entry : registry()) names.push_back(entry.first);
  return names;
}

const ControllerType& controllerType(const std::string& name) { return entryOf(name).type; }

std::unique_ptr<ControllerConfig> readController(YamlSection& section,
                                                 const ControllerContext& loop) {
  std::string name;
  need(section, "type", "one of " + join(controllerNames()));
  section.oneOf("type", name, controllerNames());
  const Entry& entry = entryOf(name);
  auto config = entry.read(entry.type, section, loop);
  section.finish();
  return config;
}

void readPredictionSteps(YamlSection& section, const ControllerContext& loop, int& steps) {
  const int fixed = loop.perturbation_steps;
  if (fixed > 0) steps = fixed;
  section.integer("prediction_steps", steps, 1, 10000);
  if (fixed > 0 && steps != fixed)
    section.fail("prediction_steps", "clp.perturbation_steps (" + std::to_string(fixed) + ")");
}

}  // namespace fpc
