#include "config/extending_loop.hpp"

#include <filesystem>
#include <sstream>

#include "base/split.hpp"
#include "base/yaml_load.hpp"
#include "config/merge.hpp"

namespace fpc {
namespace {

/// The item of a list or mapping; undefined if there is none.
YAML::Node childOf(const YAML::Node& node, const std::string& part) {
  if (node.IsSequence()) {
    const bool is_number = !part.empty() && part.size() < 7 &&
                           part.find_first_not_of("0123456789") == std::string::npos;
    if (!is_number || std::stoul(part) >= node.size()) return YAML::Node(YAML::NodeType::Undefined);
    return node[std::stoul(part)];
  }
  if (!node.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
  return node[part];
}

/// Copies what stands at the path, and no more than the mappings that lead to it.
void copyPath(const YAML::Node& from, YAML::Node to, const std::vector<std::string>& parts,
              std::size_t index) {
  const std::string& part = parts[index];
  const YAML::Node child = childOf(from, part);
  if (index + 1 == parts.size() || !child.IsMap()) {
    to[part] = YAML::Clone(child);
    return;
  }
  const YAML::Node& seen = to;
  if (!seen[part].IsDefined()) to[part] = YAML::Node(YAML::NodeType::Map);
  copyPath(child, to[part], parts, index + 1);
}

}  // namespace

std::string extendingLoop(const std::string& name_or_path, const Overrides& overrides,
                          const std::string& title, const std::string& comment) {
  const std::string file = findLoop(name_or_path);
  MergedLoop merged = mergeLoop(file);
  applyOverrides(merged, overrides);
  YAML::Node root(YAML::NodeType::Map);
  root["extends"] = name_or_path == std::filesystem::path(file).stem() ? name_or_path : file;
  root["title"] = title;
  for (const auto& [path, value] : overrides) copyPath(merged.root, root, split(path, '.'), 0);
  std::string text;
  std::stringstream lines(comment);
  for (std::string line; std::getline(lines, line);) text += "# " + line + "\n";
  YAML::Emitter emitter;
  emitter << root;
  return text + emitter.c_str() + "\n";
}

std::string scalarOf(const std::string& resolved, const std::string& path) {
  YAML::Node node = loadYaml(resolved, "loop");
  for (const auto& part : split(path, '.')) {
    const YAML::Node child = childOf(node, part);
    if (!child.IsDefined()) return "";
    node.reset(child);
  }
  return node.IsScalar() ? node.Scalar() : "";
}

}  // namespace fpc
