// The oldest value that a model looks back at.
#pragma once

#include <algorithm>

namespace fpc {

/// [samples] before the value that is explained; of a TsModel or a Structure.
template <typename Model>
int longestLag(const Model& model) {
  int longest = 0;
  for (const auto& submodel : model.submodels)
    for (const auto* list : {&submodel.antecedents, &submodel.regressors})
      for (const auto& variable : *list) longest = std::max(longest, variable.lag);
  return longest;
}

}  // namespace fpc
