// Takagi-Sugeno models whose outputs share one premise partition: rule g then is one affine model
// of all outputs. Source: taieb2017, eqs. 7-12.
#pragma once

#include <vector>

#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// The model taken apart into its rules: each a model of its own with one rule per output and the
/// lags of the whole.
struct RuleSplit {
  std::vector<TsModel> rules;
  std::size_t partition{};  ///< an output whose firing weights are those of the rules
};

/// An output with a single rule goes along with any partition.
/// @throws InputError naming the first output whose antecedents or sets differ from those of the
/// others (by more than 1e-9 of their size): one weight per rule would not be defined.
RuleSplit splitRules(const TsModel& model);

}  // namespace fpc
