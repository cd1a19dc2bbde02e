// Where a fuzzy model rests while its inputs and disturbances are held.
#pragma once

#include <vector>

#include "analysis/closed_loop.hpp"

namespace fpc {

struct FuzzyEquilibrium {
  Vector outputs;      ///< n_y
  Eigenvalues values;  ///< of the blended matrices there, weights frozen, past inputs held
  bool stable() const { return spectralRadius(values) < 1.0; }
};

/// All rests that a scan of starts (rule centres, a grid over their range) leads to; empty if there
/// is none. u n_u, d n_d, absolute. @throws InputError on wrong sizes.
std::vector<FuzzyEquilibrium> fuzzyEquilibria(const TsModel& model, VectorRef u, VectorRef d);

/// Middle of a rule's set on a variable; NaN if the set has none.
double centre(const Membership& set);
/// Mean of the centres of all sets on a signal, or of its finite range, else 0.
double usualValue(const TsModel& model, SignalKind kind, int index);

}  // namespace fpc
