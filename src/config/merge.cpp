#include "config/merge.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

#include "base/split.hpp"
#include "base/yaml_load.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

namespace fs = std::filesystem;
using Origins = std::map<std::string, Origin>;

std::string at(const std::string& file, const YAML::Mark& mark) {
  return file + ":" + std::to_string(mark.line + 1) + ": ";
}

std::string below(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

/// Notes where every path of a file stands; keys must be plain and unique.
void noteOrigins(const YAML::Node& node, const std::string& path, const std::string& file,
                 Origins& origins) {
  if (node.IsSequence()) {
    for (std::size_t i = 0; i < node.size(); ++i) {
      const std::string item = path + "[" + std::to_string(i) + "]";
      origins[item] = {file, node[i].Mark().line + 1};
      noteOrigins(node[i], item, file, origins);
    }
  } else if (node.IsMap()) {
    std::set<std::string> seen;
    for (const auto& entry : node) {
      const std::string place = at(file, entry.first.Mark());
      require(entry.first.IsScalar(), place + path, "keys that are plain words");
      const std::string child = below(path, entry.first.Scalar());
      require(seen.insert(entry.first.Scalar()).second, place + child, "the key only once");
      origins[child] = {file, entry.first.Mark().line + 1};
      noteOrigins(entry.second, child, file, origins);
    }
  }
}

bool isBelow(const std::string& path, const std::string& parent) {
  if (path.compare(0, parent.size(), parent) != 0) return false;
  return path.size() == parent.size() || path[parent.size()] == '.' || path[parent.size()] == '[';
}

void replaceOrigins(Origins& origins, const Origins& news, const std::string& path) {
  for (auto it = origins.begin(); it != origins.end();)
    it = isBelow(it->first, path) ? origins.erase(it) : std::next(it);
  for (const auto& [key, origin] : news)
    if (isBelow(key, path)) origins[key] = origin;
}

bool changesType(const YAML::Node& old, const YAML::Node& young) {
  const YAML::Node before = old["type"];
  const YAML::Node after = young["type"];
  return before.IsDefined() && after.IsDefined() && before.IsScalar() && after.IsScalar() &&
         before.Scalar() != after.Scalar();
}

/// A key without a value over a section that has keys: one person means to keep them, another to be
/// rid of them.
void requireSaid(const YAML::Node& there, const YAML::Node& value, const std::string& where,
                 const std::string& remedy) {
  const bool loses = there.IsDefined() && there.IsMap() && there.size() > 0 && value.IsNull();
  require(!loses, where, "a mapping of keys to values, got nothing; " + remedy);
}

/// Writes `young`, a mapping of the loop `source`, over the mapping `old`.
void mergeMaps(YAML::Node old, const YAML::Node& young, const std::string& path, Origins& origins,
               const MergedLoop& source) {
  const Origins& news = source.origins;
  for (const auto& entry : young) {
    const std::string key = entry.first.Scalar();
    const std::string child = below(path, key);
    const YAML::Node& before = old;
    const YAML::Node there = before[key];
    requireSaid(there, entry.second, source.whereIs(child),
                "leave the key out or write {} to keep what is inherited");
    const bool both_maps = there.IsDefined() && there.IsMap() && entry.second.IsMap();
    if (both_maps && !changesType(there, entry.second)) {
      mergeMaps(there, entry.second, child, origins, source);
      const auto origin = news.find(child);
      if (origin != news.end()) origins[child] = origin->second;
    } else {
      old[key] = entry.second;
      replaceOrigins(origins, news, child);
    }
  }
}

YAML::Node parseFile(const std::string& file) {
  std::ifstream stream(file);
  require(stream.good(), file, "a readable file");
  std::stringstream text;
  text << stream.rdbuf();
  YAML::Node root = loadYaml(text.str(), file);
  require(root.IsMap(), file + ":1", "a mapping of sections");
  return root;
}

/// The extended file: beside the extending one, or in the config folders.
std::string findExtended(const std::string& name, const std::string& file,
                         const std::string& where) {
  for (const auto& candidate :
       {fs::path(file).parent_path() / (name + ".yaml"), fs::path(file).parent_path() / name})
    if (fs::is_regular_file(candidate)) return candidate.lexically_normal().string();
  try {
    return findLoop(name);
  } catch (const InputError&) {
    throw InputError(where + ": expected a loop file beside this one or one of " +
                     join(loopNames()) + ", got '" + name + "'");
  }
}

MergedLoop mergeChain(const std::string& file, std::vector<std::string> chain) {
  chain.push_back(file);
  MergedLoop loop;
  loop.root = parseFile(file);
  noteOrigins(loop.root, "", file, loop.origins);
  loop.root = detached(loop.root);  // an alias is a copy: --set changes the place that it names
  const YAML::Node extends = loop.root["extends"];
  if (!extends.IsDefined()) return loop;
  const std::string where = loop.whereIs("extends");
  require(extends.IsScalar(), where, "the name of one loop file");
  const std::string parent = findExtended(extends.Scalar(), file, where);
  chain.push_back(parent);
  const bool cycle = std::find(chain.begin(), chain.end() - 1, parent) != chain.end() - 1;
  require(!cycle, where, "no cycle, got " + join(chain, " -> "));
  chain.pop_back();
  loop.root.remove("extends");
  MergedLoop merged = mergeChain(parent, chain);
  mergeMaps(merged.root, loop.root, "", merged.origins, loop);
  return merged;
}

/// Sets `value` at the parts from `index` on; `node` is the mapping or list that holds part
/// `index`.
void setAt(YAML::Node node, const std::vector<std::string>& parts, std::size_t index,
           std::string path, const YAML::Node& value, Origins& origins) {
  const std::string& part = parts[index];
  const bool last = index + 1 == parts.size();
  const std::string asked = "--set " + join(parts, ".");
  if (node.IsSequence()) {
    const bool is_number = !part.empty() && part.size() < 7 &&
                           part.find_first_not_of("0123456789") == std::string::npos;
    require(is_number && std::stoul(part) < node.size(), asked,
            "a number below " + std::to_string(node.size()) + " for an item of " + path +
                ", got '" + part + "'");
    path += "[" + part + "]";
    const std::size_t item = std::stoul(part);
    if (!last) return setAt(node[item], parts, index + 1, path, value, origins);
    node[item] = value;
  } else {
    require(node.IsMap(), asked, "a mapping or list at '" + path + "'");
    path = below(path, part);
    const YAML::Node& before = node;
    const YAML::Node there = before[part];
    if (!last) {
      if (!there.IsDefined() || there.IsNull()) {
        node[part] = YAML::Node(YAML::NodeType::Map);
        origins[path] = {"", 0};
      }
      return setAt(node[part], parts, index + 1, path, value, origins);
    }
    requireSaid(there, value, asked,
                "leave it out to keep what is there, " + part + "={} begins with the defaults");
    YAML::Node one(YAML::NodeType::Map);
    one[part] = value;
    if (part == "type" && changesType(node, one))
      while (node.size() > 0) node.remove(node.begin()->first);
    node[part] = value;
  }
  replaceOrigins(origins, {}, path);
  origins[path] = {"", 0};
}

}  // namespace

std::string MergedLoop::whereIs(const std::string& path) const {
  const auto found = origins.find(path);
  if (found == origins.end()) return path;
  if (found->second.file.empty()) return "--set " + path;
  return found->second.file + ":" + std::to_string(found->second.line) + ": " + path;
}

std::shared_ptr<YamlTrace> MergedLoop::trace() const {
  auto trace = std::make_shared<YamlTrace>();
  for (const auto& [path, origin] : origins) {
    const std::string where = whereIs(path);
    trace->origins[path] = where.substr(0, where.size() - path.size());
  }
  return trace;
}

MergedLoop mergeLoop(const std::string& file) { return mergeChain(file, {}); }

void applyOverrides(MergedLoop& loop, const Overrides& overrides) {
  for (const auto& [path, text] : overrides) {
    const auto parts = split(path, '.');
    require(!parts.empty() && std::count(parts.begin(), parts.end(), "") == 0, "--set " + path,
            "path=value");
    require(parts.front() != "extends", "--set extends", "a key of a section");
    const YAML::Node value = detached(loadYaml(text, "--set " + path));
    setAt(loop.root, parts, 0, "", value, loop.origins);
  }
}

}  // namespace fpc
