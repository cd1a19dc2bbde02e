// Prior knowledge inside the fits of an automatic search.
#pragma once

#include "identification/auto_candidate.hpp"

namespace fpc {

/// Moves the unknowns of a fit of `shape` to the nearest that agree with data.known, see
/// RecurrentFitParams::admit; empty if nothing is known. Of models with hidden states signs of
/// gains and poles are kept by refusing steps; `fitted` holds shape and exogenous values.
std::function<bool(const Matrix&, Vector&)> admission(const AutoData& data, const Fitted& fitted);

/// A hidden-state model comes to rest where the known steady states say, and there its gains have
/// the known signs.
bool restsAsKnown(const AutoData& data, const Fitted& fitted);

}  // namespace fpc
