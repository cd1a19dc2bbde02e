#include "base/yaml_load.hpp"

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr int kDeepest = 100;
constexpr int kMostNodes = 1'000'000;

std::string lineOf(const std::string& name, const YAML::Mark& mark) {
  return name + (mark.line >= 0 ? ":" + std::to_string(mark.line + 1) : "");
}

/// An alias of a node that holds it has no end: the depth says so.
void checkSize(const YAML::Node& node, const std::string& name, int depth, int& nodes) {
  require(depth <= kDeepest, lineOf(name, node.Mark()), "at most 100 levels, and no endless alias");
  require(++nodes <= kMostNodes, lineOf(name, node.Mark()), "at most 1000000 values");
  if (node.IsSequence())
    for (const auto& item : node) checkSize(item, name, depth + 1, nodes);
  if (!node.IsMap()) return;
  for (const auto& entry : node) {
    checkSize(entry.first, name, depth + 1, nodes);
    checkSize(entry.second, name, depth + 1, nodes);
  }
}

}  // namespace

YAML::Node loadYaml(const std::string& text, const std::string& name) {
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    for (std::size_t i = 1; i < documents.size(); ++i)
      require(documents[i].IsNull(), lineOf(name, documents[i].Mark()),
              "one YAML document, not a second one");
    YAML::Node root = documents.empty() ? YAML::Node() : documents.front();
    int nodes = 0;
    checkSize(root, name, 0, nodes);
    return root;
  } catch (const YAML::Exception& e) {
    throw InputError(lineOf(name, e.mark) + ": expected valid YAML: " + e.msg);
  }
}

YAML::Node detached(const YAML::Node& node) {
  YAML::Node copy(node.Type());
  if (node.IsScalar()) copy = node.Scalar();
  if (node.IsSequence())
    for (const auto& item : node) copy.push_back(detached(item));
  if (node.IsMap())
    for (const auto& entry : node) copy.force_insert(detached(entry.first), detached(entry.second));
  copy.SetTag(node.Tag());
  if (!node.IsNull()) copy.SetStyle(node.Style());
  return copy;
}

}  // namespace fpc
