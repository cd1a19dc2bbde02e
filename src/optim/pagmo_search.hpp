// Differential evolution and CMA-ES of pagmo2 (biscani2020). Only programs that tune link
// them (target fmbpc_pagmo: pagmo_search.cpp, which registers itself): nodes do not map pagmo2.
#pragma once

#include <memory>

#include "optim/population_search.hpp"

namespace fpc {

constexpr int kPagmoPopulation = 7;  ///< what every variant of its methods accepts

using PagmoMaker = std::unique_ptr<PopulationSearch> (*)(const SearchParams& params,
                                                         const Matrix& first, const Vector& lower,
                                                         const Vector& upper);
bool registerPagmo(PagmoMaker maker);  ///< @return true

bool hasPagmo();
/// `first`: the first generation, n x population. @throws InputError in a program without pagmo2.
std::unique_ptr<PopulationSearch> makePagmoSearch(const SearchParams& params, const Matrix& first,
                                                  const Vector& lower, const Vector& upper);

}  // namespace fpc
