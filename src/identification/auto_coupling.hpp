// Models in which outputs depend on each other, after each was searched alone.
#pragma once

#include "identification/auto_output.hpp"

namespace fpc {

/// Linear models with other outputs among their regressors, then the fuzzy ones found alone with
/// them, are judged by free runs of all outputs together over the held-out blocks: several orders
/// for all outputs at once, then one output after the other. An output keeps such a model only
/// where it beats the one found alone by 3 % and beyond the spread; it then stands in `result`
/// with its figures and a trial. Outputs that something is known of, and whatever the budget
/// leaves no time for, stay alone.
void coupleOutputs(const std::vector<SearchedOutput>& alone, const SearchLimits& limits,
                   AutoIdentification& result);

}  // namespace fpc
