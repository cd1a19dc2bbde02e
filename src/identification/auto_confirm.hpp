// Choices confirmed: what would have been chosen without a look at a block, judged on that block.
#pragma once

#include "identification/auto_search.hpp"

namespace fpc {

/// Held-out free runs (rows of the record, NaN outside the blocks), block by block of the
/// structures that the other blocks alone would have chosen. The lowest of many errors flatters the
/// chosen one; these do not, but that the stages of the search saw all blocks. Empty: none of that
/// kind.
struct Confirmation {
  Vector linear, regressors, state;
};
Confirmation confirmChoices(const AutoData& data, const StructureSearch& found);

}  // namespace fpc
