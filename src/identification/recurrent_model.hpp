// Takagi-Sugeno models as recursions with parameters, for fits to free runs: one output, its state
// either the output's own past or hidden, every derivative carried along through time.
#pragma once

#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// What a model looks like, without its numbers. Everything is in scaled units (see RecurrentData).
/// phi = [x; v; 1] with state x (n) and exogenous values v (m).
///   weights     w_i(phi) = product of Gaussian sets on the antecedents, normalised
///   companion   x = (y(k), y(k-1), ..): x1+ = sum w_i theta_i' phi_r, the rest shifts
///   otherwise   x+ = sum w_i Theta_i phi_r, x1 is the output before its map
///   output      y = x1, or |x1| with `absolute`, then clipped to [lower, upper]
struct RecurrentShape {
  Eigen::Index states{1};
  Eigen::Index exogenous{};
  bool companion{true};
  std::vector<Eigen::Index> regressors;   ///< of phi without the 1
  std::vector<Eigen::Index> antecedents;  ///< of phi without the 1
  Eigen::Index rules{1};
  bool absolute{false};
  double lower{}, upper{};  ///< of the sensor; lower = upper: none

  Eigen::Index rows() const { return companion ? 1 : states; }
  Eigen::Index terms() const { return static_cast<Eigen::Index>(regressors.size()) + 1; }
  Eigen::Index linearCount() const { return rules * rows() * terms(); }
  Eigen::Index setCount() const {
    return rules > 1 ? rules * static_cast<Eigen::Index>(antecedents.size()) : 0;
  }
  Eigen::Index parameterCount() const { return linearCount() + 2 * setCount(); }
  /// First of the terms of a row of a rule.
  Eigen::Index at(Eigen::Index rule, Eigen::Index row) const {
    return (rule * rows() + row) * terms();
  }
  Eigen::Index centre(Eigen::Index rule) const {
    return linearCount() + rule * static_cast<Eigen::Index>(antecedents.size());
  }
  Eigen::Index logWidth(Eigen::Index rule) const { return centre(rule) + setCount(); }
  double output(double x1) const;  ///< with its map and limits
};

/// One output's record: y and v row by row, NaN where missing.
struct RecurrentData {
  Vector y;  ///< N
  Matrix v;  ///< m x N: exogenous values that act on y(k+1), a column per sample
};

/// One step of the recursion and its derivatives. No allocation after construction.
class RecurrentStep {
 public:
  explicit RecurrentStep(const RecurrentShape& shape);
  /// next = f(x, v; parameters).
  void predict(VectorRef parameters, VectorRef x, VectorRef v, Eigen::Ref<Vector> next);
  /// After predict(): d next / d x (n x n), and d next / d parameters + jacobian * sensitivity
  /// (n x P) in place of `sensitivity`, whose columns may go on beyond P (start values).
  void differentiate(VectorRef parameters, Eigen::Ref<Matrix> sensitivity);
  /// After predict(): only the direct derivatives of row 0 (companion: one step ahead).
  void direct(VectorRef parameters, Eigen::Ref<Vector> gradient);
  const Matrix& jacobian() const { return jacobian_; }
  const Vector& weights() const { return weights_; }

 private:
  void weigh(VectorRef parameters);
  void slopes(VectorRef parameters);
  void addDirect(VectorRef parameters, Eigen::Index row, Eigen::Ref<Matrix> sensitivity,
                 Eigen::Index target);

  const RecurrentShape& shape_;
  Vector phi_, terms_, weights_, log_, value_;  ///< value_: rows() blended
  Matrix local_;                                ///< rows x rules, each rule's own consequent
  Matrix away_, inverse_;                       ///< antecedents x rules: z - c, 1 / s^2
  Vector log_width_;                            ///< of which inverse_ was made
  Matrix jacobian_, moved_;
};

}  // namespace fpc
