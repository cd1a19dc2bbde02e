#include "ros/settings_server.hpp"

#include <dynamic_reconfigure/ConfigDescription.h>

#include <algorithm>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using dynamic_reconfigure::Config;
using dynamic_reconfigure::ConfigDescription;

std::string valueOf(const Settings& settings, const std::string& key) {
  const auto found = std::find_if(settings.begin(), settings.end(),
                                  [&](const auto& setting) { return setting.first == key; });
  return found == settings.end() ? "" : found->second;
}

const char* typeName(SettingKind kind) {
  switch (kind) {
    case SettingKind::kNumber:
      return "double";
    case SettingKind::kInteger:
      return "int";
    case SettingKind::kBoolean:
      return "bool";
    case SettingKind::kText:
      break;
  }
  return "str";
}

template <typename Parameter, typename Value>
void add(std::vector<Parameter>& parameters, const std::string& key, Value value) {
  Parameter parameter;
  parameter.name = key;
  parameter.value = value;
  parameters.push_back(parameter);
}

void addValue(Config& config, const SettingInfo& info, const std::string& text) {
  switch (info.kind) {
    case SettingKind::kNumber:
      return add(config.doubles, info.key, settingNumber(text, info.key));
    case SettingKind::kInteger:
      return add(config.ints, info.key, settingInteger(text, info.key));
    case SettingKind::kBoolean:
      return add(config.bools, info.key,
                 static_cast<unsigned char>(settingBoolean(text, info.key) ? 1 : 0));
    case SettingKind::kText:
      return add(config.strs, info.key, text);
  }
}

/// The same range end for every number; texts and booleans have none.
Config endOfRange(const std::vector<SettingInfo>& table, double SettingInfo::*end) {
  Config config;
  for (const SettingInfo& info : table) {
    const double value = info.*end;
    if (info.kind == SettingKind::kNumber) add(config.doubles, info.key, value);
    if (info.kind == SettingKind::kInteger)
      add(config.ints, info.key, static_cast<int>(std::clamp(value, -2147483648.0, 2147483647.0)));
    if (info.kind == SettingKind::kBoolean)
      add(config.bools, info.key, static_cast<unsigned char>(end == &SettingInfo::upper ? 1 : 0));
    if (info.kind == SettingKind::kText) add(config.strs, info.key, "");
  }
  return config;
}

dynamic_reconfigure::GroupState defaultGroup() {
  dynamic_reconfigure::GroupState group;
  group.name = "Default";
  group.state = 1;
  return group;
}

ConfigDescription describe(const std::vector<SettingInfo>& table, const Settings& settings) {
  ConfigDescription description;
  dynamic_reconfigure::Group group;
  group.name = "Default";
  for (const SettingInfo& info : table) {
    dynamic_reconfigure::ParamDescription parameter;
    parameter.name = info.key;
    parameter.type = typeName(info.kind);
    parameter.level = 1;
    parameter.description = info.description;
    group.parameters.push_back(parameter);
  }
  description.groups.push_back(group);
  description.min = endOfRange(table, &SettingInfo::lower);
  description.max = endOfRange(table, &SettingInfo::upper);
  description.dflt = settingsMessage(table, settings);
  for (Config* config : {&description.min, &description.max})
    config->groups.push_back(defaultGroup());
  return description;
}

template <typename Parameter>
const Parameter* find(const std::vector<Parameter>& parameters, const std::string& key) {
  for (const Parameter& parameter : parameters)
    if (parameter.name == key) return &parameter;
  return nullptr;
}

/// A number that a person sent as an integer or as a double.
bool readNumber(const Config& config, const SettingInfo& info, std::string& text) {
  const auto* number = find(config.doubles, info.key);
  const auto* integer = find(config.ints, info.key);
  if (!number && !integer) return false;
  const double value = number ? number->value : integer->value;
  require(value >= info.lower && value <= info.upper, "controller." + info.key,
          "a number >= " + exactText(info.lower) + " and <= " + exactText(info.upper));
  text = exactText(value);
  return true;
}

bool readValue(const Config& config, const SettingInfo& info, std::string& text) {
  if (info.kind == SettingKind::kNumber || info.kind == SettingKind::kInteger)
    return readNumber(config, info, text);
  if (info.kind == SettingKind::kBoolean) {
    const auto* flag = find(config.bools, info.key);
    if (flag) text = flag->value ? "true" : "false";
    return flag != nullptr;
  }
  const auto* word = find(config.strs, info.key);
  if (word) text = word->value;
  return word != nullptr;
}

}  // namespace

Config settingsMessage(const std::vector<SettingInfo>& table, const Settings& settings) {
  Config config;
  for (const SettingInfo& info : table) addValue(config, info, valueOf(settings, info.key));
  config.groups.push_back(defaultGroup());
  return config;
}

Settings settingsOf(const std::vector<SettingInfo>& table, const Config& config) {
  Settings settings;
  std::string text;
  for (const SettingInfo& info : table)
    if (readValue(config, info, text)) settings.emplace_back(info.key, text);
  return settings;
}

SettingsServer::SettingsServer(ros::NodeHandle private_node, std::vector<SettingInfo> table,
                               Current current, Change change, Refused refused, Allowed allowed)
    : name_(private_node.getNamespace()),
      table_(std::move(table)),
      current_(std::move(current)),
      change_(std::move(change)),
      refused_(std::move(refused)),
      allowed_(std::move(allowed)) {
  if (table_.empty()) return;
  descriptions_ =
      private_node.advertise<ConfigDescription>("parameter_descriptions", 1, /*latch=*/true);
  updates_ = private_node.advertise<Config>("parameter_updates", 1, /*latch=*/true);
  descriptions_.publish(describe(table_, current_()));
  publish();
  set_ = private_node.advertiseService("set_parameters", &SettingsServer::onSet, this);
}

void SettingsServer::publish() {
  if (!table_.empty()) updates_.publish(settingsMessage(table_, current_()));
}

bool SettingsServer::onSet(Event& event) {
  try {
    if (allowed_(event.getCallerName())) {
      change_(settingsOf(table_, event.getRequest().config));
      ROS_INFO("%s: new settings from the next sample on", name_.c_str());
    }
  } catch (const InputError& error) {
    refused_(error.what());
  }
  event.getResponse().config = settingsMessage(table_, current_());
  publish();
  return true;
}

}  // namespace fpc
