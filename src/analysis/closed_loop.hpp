// The linear loop that a predictive law closes around its own model: matrices and eigenvalues for
// any lags, delays and horizon. Source: vallejo2021a, sections 4 and 5;
// blazic2007, section 4.
#pragma once

#include <complex>
#include <vector>

#include "analysis/rule_models.hpp"

namespace fpc {

using Eigenvalues = std::vector<std::complex<double>>;

/// Largest modulus first; pairs with the positive imaginary part first.
/// @throws InputError unless A is square.
Eigenvalues eigenvalues(MatrixRef A);
double spectralRadius(const Eigenvalues& values);  ///< 0 without values, NaN if one is NaN

/// What of a law matters to the loop; see FmbpcParams.
struct LoopLaw {
  bool published{true};  ///< u = e / m2 of the last output; else the weighted law
  int coincidence_steps{6};
  Vector weight_output;  ///< n_y (weighted)
  Vector weight_move;    ///< n_u (weighted)
};

/// xi(k+1) = A xi(k) + B_e e_r(k) for a perfect model, past inputs in xi; u = F e_r - K xi.
/// Symbols: A n_x n_x, K n_u n_x, F n_u n_y (reference or noise to input), B n_x n_u
struct ClosedLoop {
  bool applicable{false};  ///< false: the law has no gain there (g0 = 0), the rest is empty
  Matrix A, B, K, F;
  Eigenvalues values;  ///< of A
};

/// The loop of a law around one linear model: A_cl = A - B (F C A^H - V E).
/// @throws InputError if horizon < 1 or weights do not fit.
ClosedLoop closeLoop(const LinearModel& model, const LoopLaw& law);
/// g0 of the last output and first input: its forced response after H samples of a unit input.
double forcedGain(const LinearModel& model, int horizon);

}  // namespace fpc
