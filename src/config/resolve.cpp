// From a loop's name to the one text that tool and nodes read: merged, checked, with names of files
// that other machines can find too.
#include <cstdlib>
#include <filesystem>

#include "base/yaml_load.hpp"
#include "config/disturbance_source.hpp"
#include "config/merge.hpp"
#include "config/plugins.hpp"
#include "config/public_record.hpp"
#include "config/read.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

namespace fs = std::filesystem;

/// The scalar at a path of keys; undefined if it is not there.
YAML::Node scalarAt(const YAML::Node& root, const std::vector<std::string>& keys) {
  YAML::Node node = root;
  for (const auto& key : keys) {
    if (!node.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
    const YAML::Node parent = node;
    const YAML::Node child = parent[key];
    if (!child.IsDefined()) return YAML::Node(YAML::NodeType::Undefined);
    node.reset(child);
  }
  return node;
}

/// Beside the file that names it, or in the config folders.
std::string findFile(const std::string& name, const std::string& beside, const std::string& folder,
                     const std::string& where) {
  std::vector<fs::path> candidates{fs::path(beside) / name};
  if (fs::path(name).is_relative())
    for (const auto& config : configFolders())
      candidates.push_back(fs::path(config) / folder / name);
  for (const auto& candidate : candidates)
    if (fs::is_regular_file(candidate)) return fs::absolute(candidate).lexically_normal().string();
  std::vector<std::string> looked;
  for (const auto& candidate : candidates)
    looked.push_back(candidate.parent_path().lexically_normal().string());
  const std::string record = whereToGet(name);
  throw InputError(where + ": expected an existing file, got '" + name + "'" +
                   (record.empty() ? " (looked in " + join(looked) + ")" : ": " + record));
}

/// A public record is named with what it is also where the folder of records is not set.
std::string expanded(const std::string& text, const std::string& where) {
  const std::string start = std::string("${") + kRecordFolder + "}/";
  const bool ours = text.rfind(start, 0) == 0 && std::getenv(kRecordFolder) == nullptr;
  const std::string record = ours ? whereToGet(text) : "";
  require(record.empty(), where, "an existing file: " + record);
  return expandEnvironment(text, where);
}

/// Replaces a `file` key by an absolute name; `folder` is its usual place below a config folder.
void makeAbsolute(MergedLoop& loop, const std::vector<std::string>& keys,
                  const std::string& folder) {
  YAML::Node file = scalarAt(loop.root, keys);
  if (!file.IsDefined() || !file.IsScalar() || file.Scalar().empty()) return;
  const std::string path = join(keys, ".");
  const std::string where = loop.whereIs(path);
  const auto origin = loop.origins.find(path);
  const bool from_file = origin != loop.origins.end() && !origin->second.file.empty();
  const fs::path beside =
      from_file ? fs::path(origin->second.file).parent_path() : fs::current_path();
  file = findFile(expanded(file.Scalar(), where), beside.string(), folder, where);
}

/// Plugins that are paths; those that are names are looked up where they are loaded.
void makePluginsAbsolute(MergedLoop& loop) {
  YAML::Node plugins = scalarAt(loop.root, {"plugins"});
  if (!plugins.IsDefined() || !plugins.IsSequence()) return;
  const std::string where = loop.whereIs("plugins");
  const auto origin = loop.origins.find("plugins");
  const bool from_file = origin != loop.origins.end() && !origin->second.file.empty();
  const fs::path beside =
      from_file ? fs::path(origin->second.file).parent_path() : fs::current_path();
  for (std::size_t i = 0; i < plugins.size(); ++i) {
    if (!plugins[i].IsScalar()) continue;
    const std::string name = expandEnvironment(plugins[i].Scalar(), where);
    if (isPluginPath(name)) plugins[i] = fs::absolute(beside / name).lexically_normal().string();
  }
}

/// Calls use(keys, folder) for each key that names a file.
template <typename Use>
void eachFile(const MergedLoop& loop, Use use) {
  use({"model", "file"}, "model");
  use({"model", "identify", "structure"}, "structure");
  const YAML::Node source = scalarAt(loop.root, {"disturbance", "source"});
  const std::string csv = wordOf(DisturbanceSource::kCsv);
  if (!source.IsDefined() || !source.IsScalar() || source.Scalar() != csv) return;
  use({"disturbance", "csv", "file"}, "data");
  use({"disturbance", "csv", "next", "file"}, "data");
}

void makeFilesAbsolute(MergedLoop& loop) {
  makePluginsAbsolute(loop);
  eachFile(loop, [&](const std::vector<std::string>& keys, const char* folder) {
    makeAbsolute(loop, keys, folder);
  });
}

/// The first file of this name in the config folders; empty if there is none.
std::string inConfigFolders(const std::string& name, const std::string& folder) {
  for (const auto& config : configFolders()) {
    const fs::path candidate = fs::path(config) / folder / name;
    if (fs::is_regular_file(candidate)) return fs::absolute(candidate).lexically_normal().string();
  }
  return "";
}

/// `path` seen from `base`; empty if it is not below it.
std::string below(const fs::path& path, const fs::path& base) {
  const std::string name =
      path.lexically_relative(fs::absolute(base).lexically_normal()).generic_string();
  return name.empty() || name == "." || name.rfind("..", 0) == 0 ? "" : name;
}

/// A name that means the same file on another machine, where there is one: below the config folders
/// or ${FMBPC_DATA}.
std::string portableName(const std::string& path, const std::string& folder) {
  for (const auto& config : configFolders()) {
    const std::string name = below(path, fs::path(config) / folder);
    if (!name.empty() && inConfigFolders(name, folder) == path) return name;
  }
  const char* data = std::getenv("FMBPC_DATA");
  const std::string name = data == nullptr || *data == '\0' ? "" : below(path, data);
  return name.empty() ? path : "${FMBPC_DATA}/" + name;
}

/// So that the text can be read on another machine.
void makeFilesPortable(MergedLoop& loop) {
  eachFile(loop, [&](const std::vector<std::string>& keys, const char* folder) {
    YAML::Node file = scalarAt(loop.root, keys);
    if (file.IsDefined() && file.IsScalar() && !file.Scalar().empty())
      file = portableName(file.Scalar(), folder);
  });
}

/// The same back: where these files are on this machine.
void findFilesHere(MergedLoop& loop) {
  eachFile(loop, [&](const std::vector<std::string>& keys, const char* folder) {
    YAML::Node file = scalarAt(loop.root, keys);
    if (!file.IsDefined() || !file.IsScalar() || file.Scalar().empty()) return;
    std::string name = expandEnvironment(file.Scalar(), loop.whereIs(join(keys, ".")));
    if (fs::path(name).is_relative() && !fs::is_regular_file(name)) {
      const std::string found = inConfigFolders(name, folder);
      if (!found.empty()) name = found;
    }
    file = name;
  });
}

std::string textOf(const YAML::Node& root) {
  YAML::Emitter text;
  text << root;
  return std::string(text.c_str()) + "\n";
}

/// Reads everything once, so that errors name the line that a person wrote.
void validate(const MergedLoop& merged, const std::string& file) {
  YamlSection root(merged.root, file, "", merged.trace());
  LoopFile loop = readSections(root, fs::path(file).stem().string());
  if (loop.external_plant) return;
  loop.resolved = textOf(merged.root);
  try {
    makeDisturbance(loop);
  } catch (const InputError& e) {
    throw InputError(root.where("disturbance") + ": " + e.what());
  }
}

}  // namespace

std::pair<std::string, std::string> parseOverride(const std::string& text) {
  const auto equals = text.find('=');
  require(equals != std::string::npos && equals > 0, "--set " + text, "path=value");
  require(text.find_first_of("'\"") > equals, "--set " + text,
          "path=value without quotes around the path");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

LoopFile parseLoop(const std::string& text, const std::string& name) {
  MergedLoop merged;
  merged.root = loadYaml(text, name);
  findFilesHere(merged);
  YamlSection root(merged.root, name, "");
  LoopFile loop = readSections(root, name);
  loop.resolved = text;
  return loop;
}

LoopFile parseLoop(const std::string& text, const std::string& name, const Overrides& overrides) {
  MergedLoop merged;
  merged.root = detached(loadYaml(text, name));
  applyOverrides(merged, overrides);
  const std::string resolved = textOf(merged.root);
  findFilesHere(merged);
  YamlSection root(merged.root, name, "", merged.trace());
  LoopFile loop = readSections(root, name);
  loop.resolved = resolved;
  return loop;
}

std::string resolveLoop(const std::string& name_or_path, const Overrides& overrides) {
  const std::string file = findLoop(name_or_path);
  MergedLoop merged = mergeLoop(file);
  applyOverrides(merged, overrides);
  makeFilesAbsolute(merged);
  validate(merged, file);
  makeFilesPortable(merged);
  return textOf(merged.root);
}

}  // namespace fpc
