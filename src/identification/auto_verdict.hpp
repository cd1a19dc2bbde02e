// Which kind of model an output is best served with, in words too.
#pragma once

#include "identification/auto_identify.hpp"

namespace fpc {

/// Sets `best`, `beats_linear` and `verdict` from the figures: a fuzzy model where it beats linear
/// beyond the spread, otherwise linear is safer. `fuzzy_model` becomes false where that of the
/// measured past does not beat the linear model that stands beside it by now.
void decide(AutoOutput& found);

}  // namespace fpc
