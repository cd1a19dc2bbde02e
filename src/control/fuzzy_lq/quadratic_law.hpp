// The explicit quadratic law of one affine model: the best moves over a prediction horizon without
// limits, as gains that are computed once. Source: taieb2017, eqs. 1-6 and 13,
// there for one step; longer horizons and moves as in dynamic matrix control.
#pragma once

#include <string>

#include "fmbpc/base/state_space.hpp"

namespace fpc {

/// Diagonals of the weights: Gamma_y, of moves, and Gamma_u.
struct QuadraticWeights {
  Vector output;  ///< n_y, of (y - y_r)^2 at each sample of the horizon
  Vector move;    ///< n_u, of (u(k+l) - u(k+l-1))^2 for each of the moves
  Vector input;   ///< n_u, of (u(k+l) - u_t)^2 for each of the moves
  /// @throws InputError naming `where`.weight_output, .weight_move or .weight_input: sizes, finite,
  /// not negative, one output > 0.
  void validate(Eigen::Index n_y, Eigen::Index n_u, const std::string& where) const;
};

struct QuadraticHorizon {
  int prediction{1};    ///< P >= 1, samples
  int moves{1};         ///< M, 1..P; the input rests afterwards
  bool together{true};  ///< false: each input is found with the others at their last values, as
                        ///< eq. 6 is printed
};

/// u(k) = reference Y_r - K x(k) - offset g + previous u(k-1) + target u_t, the minimiser of
///   J = sum_{j=1..P} |y_r(k+j) - y(k+j)|^2_output + sum_{l<M} |du(k+l)|^2_move
///     + sum_{l<M} |u(k+l) - u_t|^2_input
/// for x(k+1) = A x + B u + g, y = C x. With P = M = 1, together and without moves it is
///   (G' Gy G + Gu) u = G' Gy (y_r - C (A x + g)) + Gu u_t,  G = C B.
/// The papers' one-step law has u_t = u(k-1): that is the weight of moves.
/// Symbols: Y_r n_y P, y_r(k+1)..y_r(k+P) stacked.
struct QuadraticLaw {
  Matrix reference;  ///< n_u (n_y P)
  Matrix K;          ///< n_u n_x
  Matrix offset;     ///< n_u n_x
  Matrix previous;   ///< n_u n_u
  Matrix target;     ///< n_u n_u
  bool usable{};     ///< false: an input has no effect and no weight, or nothing finite came out
  /// The effect of some input has hardly begun at the horizon (less than a tenth of what it is one
  /// sample later): the law then asks for huge moves, or none.
  bool short_sighted{};
};

/// @throws InputError naming controller.horizon_steps or controller.move_steps.
QuadraticLaw makeQuadraticLaw(const AffineModel& model, const QuadraticHorizon& horizon,
                              const QuadraticWeights& weights);

}  // namespace fpc
