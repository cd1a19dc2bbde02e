// Differential evolution and CMA-ES of pagmo2 (Biscani and Izzo 2020), or, in a build without it,
// the news that they are missing: pagmo_search.cpp or no_pagmo_search.cpp is linked.
#pragma once

#include <memory>

#include "fmbpc/optim/population_search.hpp"

namespace fpc {

constexpr int kPagmoPopulation = 7;  ///< what every variant of its methods accepts

bool hasPagmo();
/// `first`: the first generation, n x population. @throws InputError in a build without pagmo2.
std::unique_ptr<PopulationSearch> makePagmoSearch(const SearchParams& params, const Matrix& first,
                                                  const Vector& lower, const Vector& upper);

}  // namespace fpc
