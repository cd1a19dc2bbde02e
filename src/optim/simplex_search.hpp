// The least value of a function of few numbers that is dear, noisy or not smooth.
#pragma once

#include <functional>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// f(x), or anything that is not below `least` where f(x) is not.
using SimplexCost = std::function<double(const Vector& x, double least)>;

/// The best point of some `evaluations` of f, by a simplex that begins at `start` with sides of 1.
/// Source: nelder1965. A last shrink may take as many evaluations more as x has numbers.
Vector simplexSearch(const Vector& start, int evaluations, const SimplexCost& f);

}  // namespace fpc
