// Source: blazic2007, eq. 17, for any lags.
#include "model/undelayed.hpp"

#include <algorithm>
#include <limits>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

int transportDelay(const TsModel& model) {
  int delay = std::numeric_limits<int>::max();
  for (const auto& submodel : model.submodels)
    for (const auto* list : {&submodel.antecedents, &submodel.regressors})
      for (const auto& regressor : *list)
        if (regressor.kind != SignalKind::kOutput) delay = std::min(delay, regressor.lag);
  return delay == std::numeric_limits<int>::max() ? 0 : delay;
}

int longestDeadTime(const TsModel& model) {
  int longest = 0;
  for (const auto& submodel : model.submodels)
    for (const auto& first : submodel.regressors) {
      if (first.kind != SignalKind::kInput) continue;
      int shortest = first.lag;
      for (const auto& other : submodel.regressors)
        if (other.kind == first.kind && other.index == first.index)
          shortest = std::min(shortest, other.lag);
      longest = std::max(longest, shortest);
    }
  return longest;
}

TsModel withoutDelay(TsModel model, int samples) {
  const int delay = transportDelay(model);
  require(samples >= 0 && samples <= delay, "delay_steps",
          "an integer from 0 to the delay of model '" + model.name + "', " + std::to_string(delay));
  for (auto& submodel : model.submodels)
    for (auto* list : {&submodel.antecedents, &submodel.regressors})
      for (auto& regressor : *list)
        if (regressor.kind != SignalKind::kOutput) regressor.lag -= samples;
  return model;
}

}  // namespace fpc
