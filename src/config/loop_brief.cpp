#include "config/loop_brief.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "config/merge.hpp"

namespace fpc {
namespace {

/// The scalar SECTION.KEY, or of the root if the section is empty; empty if there is none.
std::string scalar(const YAML::Node& root, const std::string& section, const std::string& key) {
  const YAML::Node from = section.empty() ? root : root[section];
  if (!from.IsDefined() || !from.IsMap()) return "";
  const YAML::Node value = from[key];
  return value.IsDefined() && value.IsScalar() ? value.Scalar() : "";
}

bool hasClp(const YAML::Node& root) {
  const YAML::Node clp = root["clp"];
  if (!clp.IsDefined() || clp.IsNull()) return false;
  return clp.IsMap();
}

void collectUnset(const YAML::Node& node, std::vector<std::string>& unset) {
  if (node.IsMap())
    for (const auto& entry : node) collectUnset(entry.second, unset);
  if (node.IsSequence())
    for (const auto& item : node) collectUnset(item, unset);
  if (!node.IsScalar()) return;
  const std::string& text = node.Scalar();
  for (auto open = text.find("${"); open != std::string::npos; open = text.find("${", open + 2)) {
    const auto close = text.find('}', open);
    if (close == std::string::npos) return;
    const std::string name = text.substr(open + 2, close - open - 2);
    if (std::getenv(name.c_str()) == nullptr && std::count(unset.begin(), unset.end(), name) == 0)
      unset.push_back(name);
  }
}

}  // namespace

LoopBrief briefOf(const std::string& name_or_path) {
  const std::string file = findLoop(name_or_path);
  const MergedLoop merged = mergeLoop(file);
  const YAML::Node& root = merged.root;
  LoopBrief brief;
  brief.title = scalar(root, "", "title");
  if (brief.title.empty()) brief.title = std::filesystem::path(file).stem().string();
  brief.plant = scalar(root, "plant", "type");
  brief.controller = scalar(root, "controller", "type");
  brief.has_clp = hasClp(root);
  collectUnset(root, brief.unset);
  return brief;
}

}  // namespace fpc
