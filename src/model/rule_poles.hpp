#pragma once

#include <complex>
#include <vector>

#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// Poles of a rule in its own output, z^n = a_0 z^(n-1) + ... + a_(n-1), the largest modulus first;
/// none if the output's past is no regressor.
std::vector<std::complex<double>> rulePoles(const OutputModel& model, const Rule& rule,
                                            std::size_t output);

}  // namespace fpc
