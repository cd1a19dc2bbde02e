// The stacked prediction of the closed-loop paradigm (vallejo2021b, eqs. 4-11, solved for the
// inputs): pulse responses of states, outputs and law, and the free response, each by one recursion
// over the horizon.
#pragma once

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

struct ClpProblem;

/// Sizes of a problem: states, outputs, inputs and samples of mode 1.
struct ClpSizes {
  Eigen::Index n_x{}, n_y{}, n_u{}, n_c{};
  Eigen::Index inputs() const { return n_u * n_c; }
};

/// With x(i) = x_free(i) + sum_{j<i} A^(i-1-j) B u(j):
///   y(i) = C x(i) + offset_output,  c(i) = u(i) + K x(i) - law_offset(i).
/// Symbols: block k of a pulse response is the effect of u(j) on sample j + 1 + k.
struct ClpPrediction {
  explicit ClpPrediction(const ClpSizes& sizes);

  /// Fills everything but law_offset from the model of `now`; sizes are not checked.
  void compute(const PredictiveAction& now);
  /// Writes the dense matrices that tests and reports look at: X, T and t.
  void stack(ClpProblem& problem) const;

  ClpSizes sizes;
  Matrix state_pulse;        ///< n_x (n_u n_c), blocks A^k B
  Matrix output_pulse;       ///< n_y (n_u n_c), blocks C A^k B
  Matrix law_pulse;          ///< n_u (n_u n_c), blocks K A^k B
  Matrix state_free;         ///< n_x (n_c + 1), x(0)..x(n_c) for U = 0
  Matrix law_offset;         ///< n_u n_c: feedforward, or u_ss + K x_ss of the incremental law
  Matrix perturbation_free;  ///< n_u n_c, t = K x_free - law_offset
};

}  // namespace fpc
