// Quadratic cost of the closed-loop paradigm in the inputs (vallejo2021b, eqs. 12-14): Hessian by
// the recursion of block Toeplitz matrices, gradient by one backward pass of the adjoint.
#pragma once

#include "control/clp/prediction.hpp"
#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

struct ClpParams;
struct ClpProblem;

/// The steady state that the lq cost aims at, with the terminal weight of its mode 2.
struct ClpAim {
  const Vector& x_ss;
  const Vector& u_ss;
  const Matrix& P;
};

/// least_perturbation: sum_{i<n_c} |c(i)|^2_Wp + |y(i+1) - y_r(i+1)|^2_Wt.
/// lq: sum_{i<n_c} |y(i+1) - y_ss|^2_Wy + |u(i) - u_ss|^2_R + |x(n_c) - x_ss|^2_P, so Q = C' Wy C.
/// Allocates at construction only.
class ClpCost {
 public:
  /// `params` with all weights filled in.
  ClpCost(const ClpParams& params, const ClpSizes& sizes);
  /// True if outputs are weighted: then the cost can move the input without an active limit.
  bool tracks() const { return tracks_; }
  /// Fills H, g (inputs only), cost_scale and cost_constant of `problem`; `aim` is null unless lq.
  void fill(const PredictiveAction& now, const ClpPrediction& prediction, const ClpAim* aim,
            ClpProblem& problem);

 private:
  void stackFactor(const ClpPrediction& prediction, const Vector& unit);
  void fillHessian(const ClpAim* aim, const Vector& unit, Matrix& H);
  void findResiduals(const PredictiveAction& now, const ClpPrediction& prediction,
                     const ClpAim* aim, ClpProblem& problem);
  void fillGradient(const PredictiveAction& now, const ClpAim* aim, Vector& g);
  void scale(ClpProblem& problem) const;

  ClpSizes sizes_;
  bool lq_;
  bool tracks_;
  Vector weight_output_;  ///< Wt or Wy
  Vector weight_input_;   ///< Wp or R
  Vector root_output_, root_input_;
  Matrix factor_;        ///< (n_u n_c) r, weighted pulse responses, backwards in time
  Matrix state_factor_;  ///< (n_u n_c) n_x, pulse responses of x(n_c) (lq)
  Matrix terminal_;      ///< state_factor P
  Matrix output_error_;  ///< n_y n_c, weighted, for U = 0
  Matrix input_error_;   ///< n_u n_c, weighted, for U = 0
  Vector error_, terminal_error_, adjoint_, next_adjoint_;
};

}  // namespace fpc
