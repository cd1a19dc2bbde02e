#include "config/fitness_index.hpp"

#include <algorithm>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using Entry = std::pair<const char*, IndexOf>;

constexpr Entry kIndices[] = {
    {"iae", IndexOf::kOutput},
    {"ise", IndexOf::kOutput},
    {"ise_reference", IndexOf::kOutput},
    {"itae", IndexOf::kOutput},
    {"itse", IndexOf::kOutput},
    {"rmse", IndexOf::kOutput},
    {"offset", IndexOf::kStep},
    {"overshoot", IndexOf::kStep},
    {"rise", IndexOf::kStep},
    {"settling", IndexOf::kStep},
    {"step_cost", IndexOf::kStep},
    {"effort", IndexOf::kInput},
    {"energy", IndexOf::kInput},
    {"mean_abs_move", IndexOf::kInput},
    {"switches", IndexOf::kInput},
    {"travel", IndexOf::kInput},
    {"actuator_clips", IndexOf::kRun},
    {"clp_infeasible", IndexOf::kRun},
    {"input_violations", IndexOf::kRun},
    {"move_violations", IndexOf::kRun},
    {"output_violations", IndexOf::kRun},
    {"violations", IndexOf::kRun},
    {"consumption", IndexOf::kConsumption},
    {"AE", IndexOf::kEffluent},
    {"EQI", IndexOf::kEffluent},
    {"NH_95", IndexOf::kEffluent},
    {"NH_share", IndexOf::kEffluent},
    {"OCI", IndexOf::kEffluent},
    {"PE", IndexOf::kEffluent},
    {"SP", IndexOf::kEffluent},
    {"TN_95", IndexOf::kEffluent},
    {"TN_share", IndexOf::kEffluent},
    {"TSS_share", IndexOf::kEffluent},
};

}  // namespace

std::vector<std::string> fitnessIndices() {
  std::vector<std::string> names;
  for (const Entry& entry : kIndices) names.emplace_back(entry.first);
  return names;
}

IndexOf kindOf(const std::string& index) {
  const auto* found = std::find_if(std::begin(kIndices), std::end(kIndices),
                                   [&](const Entry& entry) { return index == entry.first; });
  require(found != std::end(kIndices), "index '" + index + "'", "one of " + join(fitnessIndices()));
  return found->second;
}

}  // namespace fpc
