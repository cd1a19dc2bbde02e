// Relative degree, poles and zeros of one input-output pair, and what they mean for the horizon:
// the propositions of blazic2007, sections 3 and 4.
#pragma once

#include <string>

#include "analysis/closed_loop.hpp"

namespace fpc {

struct Transfer {
  int relative_degree{0};  ///< first H with an effect; 0: the input never reaches the output
  Vector numerator;        ///< of z^(n - relative_degree) downwards, n states
  Eigenvalues poles, zeros;
};
/// From Markov parameters C A^i B (zeros of structure stay exact) and the characteristic polynomial
/// (Faddeev and LeVerrier). @throws InputError on indices out of range.
Transfer transferOf(const AffineModel& model, Eigen::Index input, Eigen::Index output);

/// Smallest H in [1, limit] from which on every loop up to `limit` is stable; 0 if there is none.
int smallestStableHorizon(const LinearModel& model, LoopLaw law, int limit);

/// Largest distances found, for one linear model with one input; the last output counts.
struct Propositions {
  int relative_degree{};
  double gain_below{};      ///< 1: largest |g0| for H < rho (must be exactly 0)
  double zeros_distance{};  ///< 2: H = rho: poles against the plant's zeros and rho times 0
  double poles_distance{};  ///< 3: H = long_horizon: poles against the plant's own
};
Propositions checkPropositions(const LinearModel& model, int long_horizon);

/// The published realisation of a second-order rule y(k+1) = -a1 y(k) - a2 y(k-1) + b u(k), eq. 15:
/// A = [0 1; -a2 -a1], B = [0; 1], C = [b 0]. Relative degree 2, no zeros.
LinearModel canonicalRule(double a1, double a2, double b);

}  // namespace fpc
