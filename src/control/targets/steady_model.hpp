// What a Takagi-Sugeno model says of rest, linearised where the rules are blended.
#pragma once

#include <Eigen/LU>
#include <vector>

#include "fmbpc/model/local_model.hpp"

namespace fpc {

/// Rest is y = f(y, u, d) + w, with f the model's next output where everything stays as it is, and
/// w an estimated disturbance per output. About a point it is
///   own y = input u + constant,   own = I - df/dy, input = df/du,
/// with the derivatives of the blend, weights of the rules included.
/// An integrating output has no level of its own: it is free, and its row becomes a balance of the
/// other unknowns.
class SteadyModel {
 public:
  /// `model` is matched to the plant. integrating: n_y, stated; an output whose rules all integrate
  /// (own coefficients add up to 1) is so without that.
  SteadyModel(const TsModel& model, const std::vector<bool>& integrating);
  const std::vector<Eigen::Index>& levels() const { return levels_; }  ///< integrating outputs
  /// About rest at y, u under the measured d and the estimated w. Levels that are stated to
  /// integrate but do not quite are taken to stay at `held`, n_y, in their own balance.
  /// False if the other outputs have no rest, or nothing finite came out. No allocation.
  bool linearise(VectorRef y, VectorRef u, VectorRef d, VectorRef w, VectorRef held);
  /// n_y (n_u + n_levels): y = gain v + offset for v = (u, levels).
  const Matrix& gain() const { return gain_; }
  const Vector& offset() const { return offset_; }
  /// n_levels (n_u + n_levels), n_levels: balance v + imbalance is what each level changes by in a
  /// sample.
  const Matrix& balance() const { return balance_; }
  const Vector& imbalance() const { return imbalance_; }
  /// Whether the model there is as it was at the call before, to rounding.
  bool settled() const { return settled_; }

 private:
  void solveOthers();
  void derive(VectorRef y, VectorRef u, VectorRef d, VectorRef w);

  LocalModel local_;
  std::vector<Eigen::Index> levels_, others_;
  std::vector<int> output_lags_, input_lags_;
  Vector state_, next_;
  Matrix slopes_A_, slopes_B_;
  Matrix own_, input_;  // n_y n_y, n_y n_u
  Vector constant_;     // n_y
  Matrix old_own_, old_input_;
  Vector old_constant_;
  Matrix regular_, right_, solved_;  // of the others
  Vector column_;
  Eigen::FullPivLU<Matrix> factors_;
  Matrix gain_, balance_;
  Vector offset_, imbalance_;
  bool settled_{false};
};

}  // namespace fpc
