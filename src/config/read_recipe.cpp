// Recipes: what a batch plant does one thing after the other.
#include <cmath>

#include "config/read.hpp"

namespace fpc {

void readHours(YamlSection& section, const std::string& key, double& hours) {
  double seconds = 3600.0 * hours;
  section.number(key, seconds, {0.0, 3.6e10});
  if (section.has(key)) hours = seconds / 3600.0;
}

std::vector<SetpointStep> readRecipe(YamlSection& setpoint,
                                     const std::vector<std::string>& outputs) {
  std::vector<SetpointStep> entries;
  double time_h = 0.0;
  for (auto& item : setpoint.list("recipe")) {
    SetpointStep entry;
    double hold_h = 0.0;
    entry.time_h = time_h;
    readHours(item, "ramp_s", entry.ramp_h);
    readHours(item, "hold_s", hold_h);
    entry.value = Vector::Constant(static_cast<Eigen::Index>(outputs.size()), std::nan(""));
    for (std::size_t i = 0; i < outputs.size(); ++i)
      item.number(outputs[i], entry.value[static_cast<Eigen::Index>(i)], kFinite);
    item.finish();
    time_h += entry.ramp_h + hold_h;
    entries.push_back(std::move(entry));
  }
  return entries;
}

}  // namespace fpc
