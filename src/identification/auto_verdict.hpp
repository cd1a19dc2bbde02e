// Which kind of model an output is best served with, in words too.
#pragma once

#include "identification/auto_identify.hpp"

namespace fpc {

/// Sets `best`, `beats_linear` and `verdict` from the figures: a fuzzy model where it beats linear
/// beyond the spread (fuzzy_model: that of the measured past does), otherwise linear is safer.
void decide(AutoOutput& found);

}  // namespace fpc
