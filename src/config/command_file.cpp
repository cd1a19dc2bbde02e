#include "config/command_file.hpp"

#include <algorithm>
#include <filesystem>

#include "config/disturbance_source.hpp"
#include "config/model_file.hpp"
#include "config/read.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

const std::string kActuator = "the limits of the actuator";

/// What an entry may disturb: the plant's own and the inputs with their ranges (a stuck valve stays
/// inside the limits of the actuator), and every output.
struct Disturbable {
  std::vector<std::string> names;
  std::vector<SignalInfo> ranges;
};

Disturbable disturbableOf(const LoopFile& loop) {
  Disturbable all;
  for (const Quantity& q : disturbancesOf(loop))
    all.ranges.push_back({q.name, q.unit, q.lower, q.upper});
  for (SignalInfo input : loop.plant_info.inputs) {
    input.name = "input/" + input.name;
    all.ranges.push_back(std::move(input));
  }
  all.names = namesOf(all.ranges);
  for (const SignalInfo& output : loop.plant_info.outputs)
    all.names.push_back("output/" + output.name);
  return all;
}

void requireInRanges(const YamlSection& values, const Command& command,
                     const std::vector<SignalInfo>& ranges, const std::string& what) {
  if (command.mode != CommandMode::kOverride) return;
  for (std::size_t i = 0; i < command.name.size(); ++i)
    for (const SignalInfo& range : ranges)
      if (range.name == command.name[i])
        requireInRange(values, range.name, command.value[i], range, what,
                       range.name.rfind("input/", 0) == 0 ? kActuator : "the range of the plant");
}

/// {x: 1900, s: 50} with `mode`; a list of names suffices to release. What overrides lies in its
/// range, as in a loop file.
Command readSignals(YamlSection& entry, const std::string& key,
                    const std::vector<std::string>& known, const std::vector<SignalInfo>& ranges) {
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
  requireInRanges(values, command, ranges, key);
  return command;
}

/// Inside the limits of the actuator, which would clip it.
Vector readManualInput(YamlSection& entry, const std::string& key, const LoopFile& loop) {
  Vector input;
  entry.byName(key, input, namesOf(loop.plant_info.inputs), kFinite);
  const InputLimits& limits = loop.simulation.actuator.limits;
  for (Eigen::Index i = 0; i < input.size(); ++i) {
    SignalInfo range = loop.plant_info.inputs[static_cast<std::size_t>(i)];
    range.lower = limits.lower[i];
    range.upper = limits.upper[i];
    requireInRange(entry, key + "." + range.name, input[i], range, "manual input", kActuator);
  }
  return input;
}

bool readOn(YamlSection& entry, const std::string& key) {
  bool on = false;
  entry.boolean(key, on);
  return on;
}

/// Without a schedule there is nothing to hold.
bool readHold(YamlSection& entry, const std::string& key, const LoopFile& loop) {
  if (loop.setpoint.schedule.empty()) entry.fail(key, "a loop with setpoint.schedule");
  return readOn(entry, key);
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
    return matchToLoop(readModel(findModelFile(file, entry.file())), loop);
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
         const auto& outputs = loop.plant_info.outputs;
         return SetpointCommand{readSignals(entry, key, namesOf(outputs), outputs)};
       }},
      {"disturbance",
       [](Entry entry, Key key, Loop loop) -> What {
         const Disturbable known = disturbableOf(loop);
         return DisturbanceCommand{readSignals(entry, key, known.names, known.ranges)};
       }},
      {"manual", [](Entry entry, Key key, Loop) -> What { return SetManual{readOn(entry, key)}; }},
      {"manual_input",
       [](Entry entry, Key key, Loop loop) -> What {
         return SetManualInput{readManualInput(entry, key, loop)};
       }},
      {"hold",
       [](Entry entry, Key key, Loop loop) -> What {
         return HoldRecipe{readHold(entry, key, loop)};
       }},
      {"adapt", [](Entry entry, Key key, Loop) -> What { return SetAdapt{readOn(entry, key)}; }},
      {"settings",
       [](Entry entry, Key key, Loop) -> What { return Retune{readSettings(entry, key)}; }},
      {"model",
       [](Entry entry, Key key, Loop loop) -> What {
         return UseModel{readModelOf(entry, key, loop)};
       }},
      {"identify",
       [](Entry entry, Key key, Loop) -> What {
         int window = 0;
         entry.integer(key, window, 0);
         return Identify{window};
       }},
      {"watch",
       [](Entry entry, Key key, Loop loop) -> What {
         std::string file;
         entry.text(key, file);
         try {
           return WatchCandidate{readCandidateLoop(file, loop), loop.candidate.params};
         } catch (const InputError& error) {
           throw InputError(entry.where(key) + ": " + error.what());
         }
       }},
      {"handover",
       [](Entry entry, Key key, Loop) -> What { return HandOver{readOn(entry, key)}; }}};
  return all;
}

/// "file:12: commands[3]"
std::string placeOf(const YamlSection& entry) {
  std::string place = entry.where("");
  if (place.back() == '.') place.pop_back();
  return place;
}

/// A key that no entry has: the slip is named, not what is missing because of it.
void requireKnown(const YamlSection& entry, const std::vector<std::string>& kinds) {
  for (const std::string& key : entry.keys()) {
    const bool known = key == "time_h" || key == "mode" ||
                       std::find(kinds.begin(), kinds.end(), key) != kinds.end();
    if (!known)
      throw InputError(entry.where(key) + ": unknown key; expected time_h, mode and one of " +
                       join(kinds));
  }
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
  requireKnown(entry, known);
  if (count != 1) throw InputError(placeOf(entry) + ": expected one of " + join(known));
  return *found;
}

TimedCommand readEntry(YamlSection& entry, const LoopFile& loop) {
  TimedCommand timed;
  const Kind& kind = kindOf(entry);
  need(entry, "time_h", "a time >= 0");
  entry.number("time_h", timed.time_h, {0.0, kLatestCommandH});
  timed.what = kind.read(entry, kind.key, loop);
  entry.finish();
  return timed;
}

}  // namespace

std::vector<TimedCommand> readCommands(const std::string& file, const LoopFile& loop) {
  YamlSection root = YamlSection::load(file);
  std::vector<TimedCommand> commands;
  root.markRead("commands");
  root.finish();  // a misspelt section is named, not the one that is missing because of it
  need(root, "commands", "a list of commands");
  for (YamlSection& entry : root.list("commands")) commands.push_back(readEntry(entry, loop));
  std::stable_sort(commands.begin(), commands.end(),
                   [](const auto& a, const auto& b) { return a.time_h < b.time_h; });
  return commands;
}

}  // namespace fpc
