// Statements of prior knowledge that a record speaks against.
#pragma once

#include <string>

#include "identification/auto_search.hpp"

namespace fpc {

/// Models that agree with data.known beside models that know nothing, over the held-out blocks,
/// with each of the delays. Where the best that agrees runs more than a tenth further off, by more
/// than the spread over parts of the blocks, the statements to blame, by name, with both errors;
/// else empty. So it is where not even a free model says more than the mean.
std::string contradiction(const AutoData& data, const std::vector<std::vector<int>>& delays,
                          const SearchLimits& limits);

/// The same for a structure: with its inputs and disturbances, each from its first lag on. Empty
/// without a cause, or with fewer rows than --auto asks for.
std::string contradiction(const DataSet& data, int output, const std::vector<Regressor>& regressors,
                          const PriorKnowledge& known);

}  // namespace fpc
