#include "ros/plant_check.hpp"

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

}  // namespace

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
