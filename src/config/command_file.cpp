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

std::vector<std::string> disturbedNames(const LoopFile& loop) {
  requireSimulated(loop);
  std::vector<std::string> names = disturbanceNames(loop);
  for (const SignalInfo& input : loop.plant_info.inputs) names.push_back("input/" + input.name);
  for (const SignalInfo& output : loop.plant_info.outputs) names.push_back("output/" + output.name);
  return names;
}

/// {x: 1900, s: 50} with `mode`; a list of names suffices to release.
Command readSignals(YamlSection& entry, const std::string& key,
                    const std::vector<std::string>& known) {
  Command command;
  readMode(entry, command);
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

Settings readSettings(YamlSection& entry, const std::string& key) {
  Settings settings;
  YamlSection section = entry.section(key);
  for (const std::string& name : section.keys()) {
    std::string text;
    section.text(name, text);
    settings.emplace_back(name, text);
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

TsModel readModelOf(YamlSection& entry, const std::string& key, const LoopFile& loop) {
  std::string file;
  entry.text(key, file);
  try {
    return matchToPlant(readModel(findModelFile(file, entry.file())), loop.plant_info);
  } catch (const InputError& error) {
    throw InputError(entry.where(key) + ": " + error.what());
  }
}

using What = decltype(TimedCommand::what);
using Key = const std::string&;

/// What an entry may be: its key, and how that is read.
struct Kind {
  std::string key;
  What (*read)(YamlSection& entry, Key key, const LoopFile& loop);
};

const std::vector<Kind>& kinds() {
  using Entry = YamlSection&;
  using Loop = const LoopFile&;
  static const std::vector<Kind> all{
      {"setpoint",
       [](Entry entry, Key key, Loop loop) -> What {
         return SetpointCommand{readSignals(entry, key, namesOf(loop.plant_info.outputs))};
       }},
      {"disturbance",
       [](Entry entry, Key key, Loop loop) -> What {
         return DisturbanceCommand{readSignals(entry, key, disturbedNames(loop))};
       }},
      {"manual", [](Entry entry, Key key, Loop) -> What { return SetManual{readOn(entry, key)}; }},
      {"manual_input",
       [](Entry entry, Key key, Loop loop) -> What {
         Vector input;
         entry.byName(key, input, namesOf(loop.plant_info.inputs), kFinite);
         return SetManualInput{input};
       }},
      {"hold", [](Entry entry, Key key, Loop) -> What { return HoldRecipe{readOn(entry, key)}; }},
      {"adapt", [](Entry entry, Key key, Loop) -> What { return SetAdapt{readOn(entry, key)}; }},
      {"settings",
       [](Entry entry, Key key, Loop) -> What { return Retune{readSettings(entry, key)}; }},
      {"model",
       [](Entry entry, Key key, Loop loop) -> What {
         return UseModel{readModelOf(entry, key, loop)};
       }},
      {"identify", [](Entry entry, Key key, Loop) -> What {
         int window = 0;
         entry.integer(key, window, 0);
         return Identify{window};
       }}};
  return all;
}

const Kind& kindOf(const YamlSection& entry) {
  std::vector<std::string> known;
  const Kind* found = nullptr;
  int count = 0;
  for (const Kind& kind : kinds()) {
    known.push_back(kind.key);
    if (!entry.has(kind.key)) continue;
    found = &kind;
    ++count;
  }
  if (count != 1) entry.fail("", "one of " + join(known));
  return *found;
}

TimedCommand readEntry(YamlSection& entry, const LoopFile& loop) {
  TimedCommand timed;
  const Kind& kind = kindOf(entry);
  need(entry, "time_h", "a time >= 0");
  entry.number("time_h", timed.time_h, {0.0, 1e7});
  timed.what = kind.read(entry, kind.key, loop);
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
