// One output of an automatic search, from delays to a verdict.
#pragma once

#include <optional>

#include "identification/auto_search.hpp"

namespace fpc {

/// What stands for one output as long as it is looked at alone.
struct SearchedOutput {
  AutoData data;
  Candidate linear;                ///< of result.linear
  std::optional<Candidate> fuzzy;  ///< the best one of the measured past, if any
};

/// Adds the output's submodels, state model, figures, trials and remarks to `result`; its verdict
/// is still to come, see decide(). @throws InputError if not even a linear model runs freely.
SearchedOutput searchOutput(const DataSet& data, int output, const AutoParams& params,
                            const SearchLimits& limits, AutoIdentification& result);

}  // namespace fpc
