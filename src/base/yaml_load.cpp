#include "base/yaml_load.hpp"

#include <yaml-cpp/eventhandler.h>

#include <optional>
#include <sstream>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr int kDeepest = 100;
constexpr int kMostNodes = 1'000'000;
constexpr int kMostDocuments = 10;

std::string lineOf(const std::string& name, const YAML::Mark& mark) {
  return name + (mark.line >= 0 ? ":" + std::to_string(mark.line + 1) : "");
}

void count(int& nodes, const std::string& name, const YAML::Mark& mark) {
  require(++nodes <= kMostNodes, lineOf(name, mark), "at most 1000000 values");
}

/// An alias of a node that holds it has no end: the depth says so.
void checkSize(const YAML::Node& node, const std::string& name, int depth, int& nodes) {
  require(depth <= kDeepest, lineOf(name, node.Mark()), "at most 100 levels, and no endless alias");
  count(nodes, name, node.Mark());
  if (node.IsSequence())
    for (const auto& item : node) checkSize(item, name, depth + 1, nodes);
  if (!node.IsMap()) return;
  for (const auto& entry : node) {
    checkSize(entry.first, name, depth + 1, nodes);
    checkSize(entry.second, name, depth + 1, nodes);
  }
}

/// Where the first thing is said after the first document. Counts values while they cost nothing:
/// a node of the tree takes 170 bytes.
class LaterDocuments : public YAML::EventHandler {
 public:
  explicit LaterDocuments(const std::string& name) : name_(name) {}
  std::optional<YAML::Mark> said;

  void OnDocumentStart(const YAML::Mark&) override { ++documents_; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { count(nodes_, name_, mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { note(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string&) override {
    note(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    note(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    note(mark);
  }
  void OnMapEnd() override {}

 private:
  void note(const YAML::Mark& mark) {
    count(nodes_, name_, mark);
    if (documents_ > 1 && !said) said = mark;
  }
  const std::string& name_;
  int documents_{}, nodes_{};
};

/// The parser makes documents of nothing without end from some stray commas: few are enough.
void requireOneDocument(const std::string& text, const std::string& name) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  LaterDocuments later(name);
  int documents = 0;
  while (documents <= kMostDocuments && parser.HandleNextDocument(later)) ++documents;
  require(!later.said && documents <= kMostDocuments, later.said ? lineOf(name, *later.said) : name,
          "one YAML document, not a second one");
}

}  // namespace

YAML::Node loadYaml(const std::string& text, const std::string& name) {
  try {
    requireOneDocument(text, name);
    YAML::Node root = YAML::Load(text);
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
