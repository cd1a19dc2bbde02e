#include "papers/perturbations.hpp"

#include <cmath>
#include <map>
#include <memory>

#include "base/number.hpp"
#include "base/split.hpp"
#include "base/yaml_load.hpp"
#include "base/yaml_node.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/plant/plant.hpp"
#include "papers/paper_file.hpp"
#include "papers/runs.hpp"

namespace fpc::papers {
namespace {

/// Factors of the numbers at dotted paths, by the type of a plant or a controller.
using Factors = std::map<std::string, std::map<std::string, double>>;

YamlSection file() { return YamlSection::load(paperFile("perturbations")); }

Factors factorsOf(const std::string& name) {
  YamlSection all = file();
  require(all.has(name), name, "one of " + join(all.keys()));
  YamlSection section = all.section(name);
  Factors factors;
  for (const std::string& type : section.keys()) {
    YamlSection of = section.section(type);
    for (const std::string& path : of.keys()) of.number(path, factors[type][path], kFinite);
  }
  return factors;
}

/// What the loop has there, NaN if nothing: of a plant's parameter that it does not name, the
/// plant's own.
double numberAt(const LoopFile& loop, const YAML::Node& text, const std::string& path) {
  YAML::Node node = YAML::Clone(text);
  for (const std::string& key : split(path, '.')) {
    const bool list = node.IsSequence() && std::stoul(key) < node.size();
    if (!list && !(node.IsMap() && node[key])) {
      node.reset();
      break;
    }
    node.reset(list ? node[std::stoul(key)] : node[key]);
  }
  if (node.IsScalar()) return parseNumber(node.Scalar()).value_or(kNotPrinted);
  const auto plant = makePlant(loop.simulation);
  for (const auto& quantity : plant->description().parameters)
    if (path == "plant.parameters." + quantity.name) return quantity.nominal;
  return kNotPrinted;
}

}  // namespace

std::vector<std::string> perturbationNames() { return file().keys(); }

void perturb(const std::string& name) {
  const auto factors = std::make_shared<Factors>(factorsOf(name));
  perturbEachLoop([factors](const LoopFile& loop) {
    Overrides changes;
    const YAML::Node text = loadYaml(loop.resolved, loop.name);
    for (const std::string& type : {loop.simulation.plant, loop.controllerType().name}) {
      const auto known = factors->find(type);
      if (known == factors->end()) continue;
      for (const auto& [path, factor] : known->second) {
        const double value = numberAt(loop, text, path);
        if (std::isfinite(value)) {
          const double changed = value * factor;
          const bool whole = value == std::round(value) && factor == std::round(factor);
          changes.emplace_back(path,
                               whole ? std::to_string(std::lround(changed)) : printNumber(changed));
        }
      }
    }
    return changes;
  });
}

}  // namespace fpc::papers
