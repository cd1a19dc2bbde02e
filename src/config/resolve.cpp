// From a loop's name to the one text that tool and nodes read: merged, checked, with names of files
// that other machines can find too.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "base/yaml_load.hpp"
#include "config/disturbance_source.hpp"
#include "config/merge.hpp"
#include "config/model_file.hpp"
#include "config/model_file_parts.hpp"
#include "config/plugins.hpp"
#include "config/public_record.hpp"
#include "config/read.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "plant/model_plant.hpp"

namespace fpc {
namespace {

namespace fs = std::filesystem;

constexpr char kOnModel[] = "model", kLoopFolder[] = "loop";

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
  if (folder == kLoopFolder && !fs::is_regular_file(beside / file.Scalar())) {
    file = fs::absolute(findLoop(file.Scalar())).lexically_normal().string();
    return;
  }
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
  use({"plant", "model"}, "model");
  use({"model", "identify", "structure"}, "structure");
  use({"candidate", "loop"}, kLoopFolder);
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

/// Same signals, sample time and optimizer, and a model.
void requireSuitable(const LoopFile& candidate, const LoopFile& in_charge,
                     const std::string& file) {
  const auto same = [&](const char* kind, const std::vector<SignalInfo>& mine,
                        const std::vector<SignalInfo>& theirs) {
    bool equal = mine.size() == theirs.size();
    for (std::size_t i = 0; equal && i < mine.size(); ++i)
      equal = mine[i].name == theirs[i].name && mine[i].unit == theirs[i].unit;
    require(equal, file + ": " + kind,
            "those of the loop in charge, with their units: " + join(namesOf(theirs)));
  };
  const PlantInfo &mine = candidate.plant_info, &theirs = in_charge.plant_info;
  same("outputs", mine.outputs, theirs.outputs);
  same("inputs", mine.inputs, theirs.inputs);
  same("measured disturbances", mine.disturbances, theirs.disturbances);
  require(mine.sample_time_s == theirs.sample_time_s, file + ": sampling.sample_time_s",
          exactText(theirs.sample_time_s) + ", as in the loop in charge");
  require(candidate.has_clp == in_charge.has_clp, file + ": clp",
          in_charge.has_clp ? "an optimizer as in the loop in charge"
                            : "none, as in the loop in charge");
  require(candidate.has_model, file + ": model.file",
          "a model: a candidate is judged by what its model foresees");
}

/// [lower, upper] of a signal that the model has too.
void addRanges(YAML::Node ranges, const std::vector<SignalInfo>& known,
               const std::vector<SignalInfo>& of_model) {
  for (const SignalInfo& signal : known)
    for (const SignalInfo& m : of_model)
      if (m.name == signal.name && std::isfinite(signal.lower) && std::isfinite(signal.upper) &&
          signal.lower < signal.upper)
        for (const double end : {signal.lower, signal.upper})
          ranges[signal.name].push_back(yamlNumber(end));
}

/// The model at rest under the loop's first input; nothing where it does not rest.
void startAtRest(YAML::Node plant, const LoopFile& loop, const TsModel& model) {
  Vector u(countOf(model.inputs)), d(countOf(model.disturbances));
  const auto take = [](const std::vector<SignalInfo>& to, const std::vector<SignalInfo>& from,
                       const Vector& values, Vector& result) {
    result.setConstant(std::nan(""));
    for (std::size_t i = 0; i < to.size(); ++i)
      for (std::size_t j = 0; j < from.size(); ++j)
        if (to[i].name == from[j].name)
          result[static_cast<Eigen::Index>(i)] = values[static_cast<Eigen::Index>(j)];
  };
  take(model.inputs, loop.plant_info.inputs, loop.simulation.actuator.initial, u);
  take(model.disturbances, loop.plant_info.disturbances, loop.disturbance_nominal, d);
  if (!u.allFinite() || !d.allFinite()) return;
  const std::optional<Vector> rest = restOf(model, u, d);
  for (std::size_t i = 0; rest && i < model.outputs.size(); ++i)
    plant["initial_state"][model.outputs[i].name] =
        yamlNumber((*rest)[static_cast<Eigen::Index>(i)]);
}

/// The loop's model in the place of its plant, with the plant's ranges; instruments that are part
/// of the model, and the way to a real plant, are left out.
void rehearse(MergedLoop& merged, const std::string& file, void (*find)(MergedLoop&)) {
  MergedLoop whole = merged;
  whole.root = YAML::Clone(merged.root);
  find(whole);
  YamlSection root(whole.root, file, "", whole.trace());
  const LoopFile loop = readSections(root, fs::path(file).stem().string());
  require(loop.has_model, file + ": model.file",
          "the model on which the loop is to run (plant.type model)");
  const TsModel model = readModel(loop.model_file);
  YAML::Node plant(YAML::NodeType::Map);
  plant["type"] = "model";
  plant["model"] = merged.root["model"]["file"].Scalar();
  for (const auto& output : loop.plant_info.outputs) plant["outputs"].push_back(output.name);
  YAML::Node ranges(YAML::NodeType::Map);
  addRanges(ranges, loop.plant_info.outputs, model.outputs);
  addRanges(ranges, loop.plant_info.inputs, model.inputs);
  addRanges(ranges, loop.plant_info.disturbances, model.disturbances);
  plant["ranges"] = ranges;
  startAtRest(plant, loop, model);
  merged.root["plant"] = plant;
  for (const char* section : {"gateway", "tf"}) merged.root.remove(section);
  if (merged.root["model"]["instruments"].as<std::string>("included") == "included") {
    merged.root.remove("sensors");
    if (merged.root["actuator"].IsMap()) merged.root["actuator"].remove("lag");
  }
  if (const auto origin = merged.origins.find("model.file"); origin != merged.origins.end())
    merged.origins["plant.model"] = Origin(origin->second);
}

/// Overrides in their order; plant.type=model over another type rehearses.
void applyInOrder(MergedLoop& merged, const std::string& file, const Overrides& overrides,
                  void (*find)(MergedLoop&)) {
  for (const auto& [path, value] : overrides) {
    const YAML::Node type = scalarAt(merged.root, {"plant", "type"});
    const bool other = type.IsDefined() && type.IsScalar() && type.Scalar() != value;
    if (path == "plant.type" && value == kOnModel && other)
      rehearse(merged, file, find);
    else
      applyOverrides(merged, {{path, value}});
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
  applyInOrder(merged, name, overrides, &findFilesHere);
  const std::string resolved = textOf(merged.root);
  findFilesHere(merged);
  YamlSection root(merged.root, name, "", merged.trace());
  LoopFile loop = readSections(root, name);
  loop.resolved = resolved;
  return loop;
}

std::shared_ptr<const LoopFile> readCandidateLoop(const std::string& name_or_path,
                                                  const LoopFile& in_charge) {
  const std::string file = findLoop(name_or_path);
  MergedLoop merged = mergeLoop(file);
  merged.root.remove("candidate");
  makeFilesAbsolute(merged);
  YamlSection root(merged.root, file, "", merged.trace());
  auto loop = std::make_shared<LoopFile>(readSections(root, fs::path(file).stem().string()));
  loop->resolved = textOf(merged.root);
  requireSuitable(*loop, in_charge, file);
  return loop;
}

std::string resolveLoop(const std::string& name_or_path, const Overrides& overrides) {
  const std::string file = findLoop(name_or_path);
  MergedLoop merged = mergeLoop(file);
  applyInOrder(merged, file, overrides, &makeFilesAbsolute);
  makeFilesAbsolute(merged);
  validate(merged, file);
  makeFilesPortable(merged);
  return textOf(merged.root);
}

}  // namespace fpc
