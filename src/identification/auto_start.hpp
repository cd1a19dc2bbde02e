// Where the fits of an automatic search begin.
#pragma once

#include "identification/auto_candidate.hpp"

namespace fpc {

/// Linear parameters of `shape` (one rule): one-step least squares for a model of the output's
/// past.
Vector arxStart(const RecurrentShape& shape, const RecurrentData& data,
                const std::vector<Stretch>& stretches);
/// The same least squares as a hidden state in observer form. `v` holds one value per input.
Vector observerStart(const RecurrentShape& shape, const RecurrentData& data,
                     const std::vector<Stretch>& stretches);
/// A chain of equal lags of `samples` each, the inputs at its end.
Vector chainStart(const RecurrentShape& shape, double samples);
/// Some stable system.
Vector randomStart(const RecurrentShape& shape, std::uint64_t seed);
/// Rules around the linear model: sets by k-means in the antecedents' space, consequents near it.
Vector ruleStart(const RecurrentShape& shape, const Matrix& antecedents, const Vector& linear,
                 double jitter, std::uint64_t seed);

}  // namespace fpc
