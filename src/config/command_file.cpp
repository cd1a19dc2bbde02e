#include "fmbpc/config/command_file.hpp"

#include <algorithm>
#include <filesystem>

#include "config/read.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/config/disturbance_source.hpp"
#include "fmbpc/config/model_file.hpp"
#include "fmbpc/fuzzy/model_match.hpp"

namespace fpc {
namespace {

const char* const kKinds[] = {"setpoint", "disturbance", "manual", "manual_input", "hold",
                              "adapt",    "settings",    "model",  "identify"};

std::vector<std::string> disturbanceNames(const LoopFile& loop) {
  requireSimulated(loop);
  std::vector<std::string> names;
  const auto plant = makePlant(loop.simulation);
  for (const Quantity& q : plant->description().disturbances) names.push_back(q.name);
  for (const SignalInfo& input : loop.plant_info.inputs) names.push_back("input/" + input.name);
  for (const SignalInfo& output : loop.plant_info.outputs) names.push_back("output/" + output.name);
  return names;
}

/// {x: 1900, s: 50} with `mode`; a list of names suffices to release.
Command readSignals(YamlSection& entry, const std::string& key,
                    const std::vector<std::string>& known) {
  Command command;
  std::string mode = "override";
  entry.oneOf("mode", mode, {"override", "offset", "release"});
  command.mode = mode == "override" ? CommandMode::kOverride
                 : mode == "offset" ? CommandMode::kOffset
                                    : CommandMode::kRelease;
  if (command.mode == CommandMode::kRelease) {
    entry.subset(key, command.name, known);
    if (command.name.empty()) entry.fail(key, "a list of names out of " + join(known));
    command.value.assign(command.name.size(), 0.0);
    return command;
  }
  YamlSection values = entry.section(key);
  for (const std::string& name : known) {
    double value = 0.0;
    values.number(name, value, kFinite);
    if (!values.has(name)) continue;
    command.name.push_back(name);
    command.value.push_back(value);
  }
  values.finish();
  if (command.name.empty()) values.fail("", "names out of " + join(known));
  return command;
}

bool readOn(YamlSection& entry, const std::string& key) {
  bool on = false;
  entry.boolean(key, on);
  return on;
}

Settings readSettings(YamlSection& entry) {
  Settings settings;
  YamlSection section = entry.section("settings");
  for (const std::string& key : section.keys()) {
    std::string text;
    section.text(key, text);
    settings.emplace_back(key, text);
  }
  section.finish();
  return settings;
}

/// Beside the file that names it, or below a config folder.
std::string findModelFile(const std::string& name, const std::string& named_in) {
  namespace fs = std::filesystem;
  std::vector<fs::path> places{fs::path(named_in).parent_path() / name, name};
  for (const std::string& folder : configFolders())
    places.push_back(fs::path(folder) / "model" / name);
  for (const fs::path& place : places)
    if (fs::is_regular_file(place)) return place.string();
  return name;  // readModel() says that it is not there
}

TsModel readModelOf(YamlSection& entry, const LoopFile& loop) {
  std::string file;
  entry.text("model", file);
  try {
    return matchToPlant(readModel(findModelFile(file, entry.file())), loop.plant_info);
  } catch (const InputError& error) {
    throw InputError(entry.where("model") + ": " + error.what());
  }
}

std::string kindOf(const YamlSection& entry) {
  std::vector<std::string> kinds(std::begin(kKinds), std::end(kKinds)), found;
  for (const std::string& kind : kinds)
    if (entry.has(kind)) found.push_back(kind);
  if (found.size() != 1) entry.fail("", "one of " + join(kinds));
  return found.front();
}

TimedCommand readEntry(YamlSection& entry, const LoopFile& loop) {
  TimedCommand timed;
  const std::string kind = kindOf(entry);
  need(entry, "time_h", "a time >= 0");
  entry.number("time_h", timed.time_h, {0.0, 1e7});
  if (kind == "setpoint") {
    timed.what = SetpointCommand{readSignals(entry, kind, namesOf(loop.plant_info.outputs))};
  } else if (kind == "disturbance") {
    timed.what = DisturbanceCommand{readSignals(entry, kind, disturbanceNames(loop))};
  } else if (kind == "manual") {
    timed.what = SetManual{readOn(entry, kind)};
  } else if (kind == "manual_input") {
    Vector input;
    entry.byName(kind, input, namesOf(loop.plant_info.inputs), kFinite);
    timed.what = SetManualInput{input};
  } else if (kind == "hold") {
    timed.what = HoldRecipe{readOn(entry, kind)};
  } else if (kind == "adapt") {
    timed.what = SetAdapt{readOn(entry, kind)};
  } else if (kind == "settings") {
    timed.what = Retune{readSettings(entry)};
  } else if (kind == "model") {
    timed.what = UseModel{readModelOf(entry, loop)};
  } else {
    int window = 0;
    entry.integer(kind, window, 0);
    timed.what = Identify{window};
  }
  entry.finish();
  return timed;
}

}  // namespace

std::vector<TimedCommand> readCommands(const std::string& file, const LoopFile& loop) {
  YamlSection root = YamlSection::load(file);
  std::vector<TimedCommand> commands;
  need(root, "commands", "a list of commands");
  for (YamlSection& entry : root.list("commands")) commands.push_back(readEntry(entry, loop));
  root.finish();
  std::stable_sort(commands.begin(), commands.end(),
                   [](const auto& a, const auto& b) { return a.time_h < b.time_h; });
  return commands;
}

}  // namespace fpc
