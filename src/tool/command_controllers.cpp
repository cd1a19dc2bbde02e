// fmbpc controllers: what a loop file may name as controller.type.
#include <iostream>

#include "base/ordered_json.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/control/registry.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {
namespace {

using Json = OrderedJson;

std::vector<std::string> settingsOf(const ControllerType& type) {
  std::vector<std::string> keys;
  for (const SettingInfo& setting : type.settings) keys.push_back(setting.key);
  return keys;
}

Json toJson(const ControllerType& type) {
  return {
      {"type", type.name},         {"summary", type.summary},     {"needs_model", type.needs_model},
      {"predicts", type.predicts}, {"open_loop", type.open_loop}, {"settings", settingsOf(type)}};
}

std::string word(bool value) { return value ? "yes" : "no"; }

}  // namespace

int controllers(bool json) {
  loadPluginsOfLoops();
  Json all = Json::array();
  std::vector<std::vector<std::string>> rows{
      {"type", "needs model", "predicts", "follows setpoint", "may change in a run"}};
  std::string summaries;
  for (const auto& name : controllerNames()) {
    const ControllerType& type = controllerType(name);
    all.push_back(toJson(type));
    const auto keys = settingsOf(type);
    rows.push_back({name, word(type.needs_model), word(type.predicts), word(!type.open_loop),
                    keys.empty() ? "-" : join(keys, " ")});
    summaries += "  " + name + ": " + type.summary + "\n";
  }
  if (json)
    std::cout << Json{{"controllers", all}}.dump(2) << "\n";
  else
    std::cout << alignedTable(rows) << "\n" << summaries;
  return 0;
}

}  // namespace fpc::tool
