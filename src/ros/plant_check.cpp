#include "ros/plant_check.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

std::string names(const std::vector<SignalInfo>& signals) {
  std::vector<std::string> list;
  list.reserve(signals.size());
  for (const SignalInfo& signal : signals) list.push_back(signal.name + "[" + signal.unit + "]");
  return list.empty() ? "none" : join(list);
}

std::string difference(const std::string& what, const std::string& expected,
                       const std::string& arrived) {
  if (expected == arrived) return "";
  return "plant_info: " + what + " are " + arrived + ", the loop file expects " + expected;
}

std::string rangeOf(const SignalInfo& signal) {
  return shortText(signal.lower) + ".." + shortText(signal.upper);
}

std::string boundsOf(const std::vector<SignalInfo>& expected,
                     const std::vector<SignalInfo>& arrived) {
  for (std::size_t i = 0; i < std::min(expected.size(), arrived.size()); ++i) {
    const bool lower = std::isfinite(expected[i].lower) && expected[i].lower != arrived[i].lower;
    const bool upper = std::isfinite(expected[i].upper) && expected[i].upper != arrived[i].upper;
    if (lower || upper)
      return "plant_info: " + arrived[i].name + " may be " + rangeOf(arrived[i]) +
             ", the loop file says " + rangeOf(expected[i]);
  }
  return "";
}

}  // namespace

std::string boundsDifference(const PlantInfo& expected, const PlantInfo& arrived) {
  for (const std::string& text :
       {boundsOf(expected.inputs, arrived.inputs), boundsOf(expected.outputs, arrived.outputs),
        boundsOf(expected.disturbances, arrived.disturbances)})
    if (!text.empty()) return text;
  return "";
}

std::string plantMismatch(const PlantInfo& expected, const PlantInfo& arrived) {
  if (expected.sample_time_s != arrived.sample_time_s)
    return "plant_info: the sample time is " + exactText(arrived.sample_time_s) +
           " s, the loop file expects " + exactText(expected.sample_time_s) + " s";
  for (const std::string& text :
       {difference("outputs", names(expected.outputs), names(arrived.outputs)),
        difference("inputs", names(expected.inputs), names(arrived.inputs)),
        difference("measured disturbances", names(expected.disturbances),
                   names(arrived.disturbances))})
    if (!text.empty()) return text;
  return "";
}

}  // namespace fpc
