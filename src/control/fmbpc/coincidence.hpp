// Gains of a law that asks the outputs to meet their references at one future sample, the input
// held until then.
#pragma once

#include <Eigen/Cholesky>

#include "fmbpc/base/state_space.hpp"

namespace fpc {

/// From a frozen local model and the horizon H:
///   y(k+H) = P x + S (B u + g),   P = C A^H,   S = C (I + A + ... + A^(H-1)),   M = S B,
///   u = F e + V u(k-1),           e = what y(k+H) lacks when u = 0.
/// Rows of outputs without weight stay zero. Row by row, so that a diverging submodel that an
/// output does not depend on cannot reach it; long horizons by doubling, so that the work grows
/// with log H. No allocation after construction; work is fixed by the sizes and H. Source:
/// vallejo2019, eqs. 19-28; richalet2009 for the single variable. Symbols: P, S n_y n_x, M n_y n_u,
/// F n_u n_y, V n_u n_u
class CoincidenceGains {
 public:
  CoincidenceGains(Eigen::Index n_x, Eigen::Index n_u, Eigen::Index n_y);

  /// One input meets the last output exactly: u = e / m2. The paper solves its matrix M_a = [m1 n';
  /// m2 0] for (u(k), u(k-1)), whose second row is this equation; the matrix itself is
  /// ill-conditioned (up to 2e24) and not needed. Returns false if m2 vanishes or is not finite.
  bool computePublished(const AffineModel& model, int horizon);
  /// u = (M' W M + L)^-1 (M' W e + L u(k-1)) with W = diag(weight_output), L = diag(weight_move).
  /// Returns false if that matrix is singular or not finite, or if no input has an effect: a weight
  /// of moves would hide that.
  bool computeWeighted(const AffineModel& model, int horizon, VectorRef weight_output,
                       VectorRef weight_move);

  /// Whether an input has no effect on any weighted output at the horizon.
  bool isIdle(Eigen::Index input) const;

  const Matrix& free() const { return free_; }           ///< P
  const Matrix& sum() const { return sum_; }             ///< S
  const Matrix& effect() const { return effect_; }       ///< M
  const Matrix& gain() const { return gain_; }           ///< F
  const Matrix& moveGain() const { return move_gain_; }  ///< V

 private:
  void predict(const AffineModel& model, int horizon, VectorRef weight_output);
  void walk(const AffineModel& model, int steps);
  void begin(const AffineModel& model, VectorRef weight_output);
  void twice(const AffineModel& model, bool odd, bool last);
  bool leap(const AffineModel& model, int horizon);
  bool factor();

  Vector last_output_, scale_;
  Matrix free_, sum_, next_, effect_, effect_size_, weighted_, normal_, gain_, move_gain_;
  Matrix power_, square_;  ///< of A
  Eigen::LLT<Matrix> factor_;
};

}  // namespace fpc
