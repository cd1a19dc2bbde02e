// One output of an automatic search, from delays to a verdict.
#pragma once

#include "fuzzy/auto_search.hpp"

namespace fpc {

/// Adds the output's submodels, state model, figures, trials and remarks to `result`.
/// @throws InputError if not even a linear model runs freely.
void searchOutput(const DataSet& data, int output, const AutoParams& params,
                  const SearchLimits& limits, AutoIdentification& result);

}  // namespace fpc
