#include "fmbpc/config/loop_file.hpp"

#include <filesystem>

#include "config/read.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

/// Lets the plant describe itself, so that nodes and process agree to the last bit.
void describePlant(YamlSection& root, LoopFile& loop) {
  if (!loop.external_plant) {
    checked(root.section("plant"), [&] { loop.plant_info = Simulation(loop.simulation).info(); });
  }
  PlantInfo& info = loop.plant_info;
  info.sample_time_s = loop.simulation.sample_time_s;
  info.header = SampleClock(info.sample_time_s, loop.simulation.start_time_s).header(0, 0);
}

}  // namespace

void need(const YamlSection& section, const std::string& key, const std::string& expected) {
  if (!section.has(key)) section.fail(key, expected);
}

int indexByName(YamlSection& section, const std::string& key,
                const std::vector<std::string>& names) {
  std::string name;
  need(section, key, "one of " + join(names));
  section.oneOf(key, name, names);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return static_cast<int>(i);
  section.fail(key, "one of " + join(names));
}

void failAt(const YamlSection& section, const std::string& message) {
  const auto colon = message.find(':');
  std::string field = message.substr(0, colon);
  field = field.substr(field.find_last_of('.') + 1);
  const bool is_field =
      colon != std::string::npos && field.find_first_of(" /[]") == std::string::npos;
  if (is_field) throw InputError(section.where(field) + message.substr(colon));
  std::string place = section.where("");
  if (place.back() == '.') place.pop_back();
  throw InputError(place + ": " + message);
}

LoopFile readSections(YamlSection& root, const std::string& name) {
  LoopFile loop;
  LoopNames names;
  loop.name = name;
  loop.report.title = name;
  root.text("title", loop.report.title);
  readPlant(root, loop, names);
  readSampling(root, loop);
  readActuator(root, loop, names);
  readNoise(root, loop, names);
  readDisturbance(root, loop, names);
  readTf(root, loop, names);
  describePlant(root, loop);
  readSetpoint(root, loop, names);
  readClp(root, loop, names);
  readController(root, loop, names);
  readModelSection(root, loop);
  readRing(root, loop);
  readReport(root, loop, names);
  root.finish();
  return loop;
}

LoopFile parseLoop(const std::string& text, const std::string& name) {
  YamlSection root = YamlSection::parse(text, name);
  LoopFile loop = readSections(root, name);
  loop.resolved = text;
  return loop;
}

LoopFile readLoop(const std::string& name_or_path, const Overrides& overrides) {
  const std::string file = findLoop(name_or_path);
  LoopFile loop =
      parseLoop(resolveLoop(file, overrides), std::filesystem::path(file).stem().string());
  loop.file = file;
  return loop;
}

}  // namespace fpc
