// The Takagi-Sugeno model as a state-space model with coefficients that depend on the antecedents.
#pragma once

#include <vector>

#include "fmbpc/base/state_space.hpp"
#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// xi(k+1) = A xi(k) + B u(k) + g,  y_m = C xi.  g = D d(k) + r (+ w_hat, added by the law).
/// xi stacks, in this order: for each output its lags 0.., for each input u(k-1), u(k-2).., for
/// each disturbance d(k-1), d(k-2).., for each unmeasured one d(k), d(k-1)..: those are taken to
/// stay as they are, and an observer may say what they are. Every input has at least u(k-1), so
/// that moves can be weighed and limited. Source: vallejo2019, eqs. 10-17 (there u(k-1) is part of
/// an extended input).
class LocalModel {
 public:
  /// `model` must be matched to the plant and validated. Keeps a copy.
  explicit LocalModel(TsModel model);

  const TsModel& model() const { return model_; }
  Eigen::Index stateSize() const { return n_x_; }
  Eigen::Index outputState(Eigen::Index output, int lag = 0) const;  ///< row of y(k-lag)
  Eigen::Index inputState(Eigen::Index input, int lag) const;        ///< row of u(k-lag), lag >= 1
  Eigen::Index disturbanceState(Eigen::Index disturbance,
                                int lag) const;  ///< row of d(k-lag), lag >= 1
  Eigen::Index unmeasuredState(Eigen::Index disturbance,
                               int lag = 0) const;  ///< row of an unmeasured d(k-lag)

  /// State of a process that has rested at these values, unmeasured disturbances at 0.
  void restState(VectorRef outputs, VectorRef input, VectorRef disturbances,
                 Eigen::Ref<Vector> state) const;
  /// Moves a state of true values on by one sample: y(k+1) enters, u(k) and d(k) become the newest
  /// past values.
  void shiftState(VectorRef outputs, VectorRef input, VectorRef disturbances,
                  Eigen::Ref<Vector> state) const;
  /// Blends the rules at the antecedent given by `state` (with u(k) replaced by u(k-1)) and d(k).
  /// Fills affine(); no allocation. Returns false if in some output no rule fired (the nearest one
  /// is used). The matrices depend on the antecedent only: hand over measured outputs in `state` to
  /// blend at the measurement.
  bool blend(VectorRef state, VectorRef disturbances);
  /// The same for a u(k) that is known, as along a planned path.
  bool blend(VectorRef state, VectorRef input, VectorRef disturbances);
  /// xi(k+1) of a state under u(k), d(k): blends there, then moves. No allocation once `next` has
  /// its size.
  void advance(VectorRef state, VectorRef input, VectorRef disturbances, Vector& next);
  /// Adds to A (n_x n_x) and B (n_x n_u) what the rules' weights change along xi and u(k), so that
  /// affine().A + A and affine().B + B are the derivatives of xi(k+1) at the values last blended,
  /// which are handed over again. No allocation.
  void addSlopes(VectorRef state, VectorRef input, VectorRef disturbances, Matrix& A, Matrix& B);
  const AffineModel& affine() const { return affine_; }
  const std::vector<FiringResult>& firing() const { return firing_; }

 private:
  /// Where a variable stands: a row of the state, or else (row -1) u(k) or d(k).
  struct Place {
    Eigen::Index row, index;
    bool of_input;
  };
  Place placeOf(const Regressor& variable) const;
  static double value(const Place& place, VectorRef state, VectorRef input, VectorRef disturbances);
  bool blendOutput(Eigen::Index output, VectorRef state, VectorRef input, VectorRef disturbances);
  void addTerm(Eigen::Index row, const Place& regressor, double coefficient,
               VectorRef disturbances);
  void layOut();
  void fillShifts();

  TsModel model_;
  Eigen::Index n_x_{};
  /// Of each signal: its first row, and how many rows it has.
  std::vector<Eigen::Index> output_offset_, input_offset_, disturbance_offset_, unmeasured_offset_;
  std::vector<int> output_lags_, input_lags_, disturbance_lags_, unmeasured_lags_;
  AffineModel affine_;
  std::vector<FiringResult> firing_;
  std::vector<std::vector<Place>> antecedents_, regressors_;  ///< of each output
  std::vector<Vector> antecedent_values_, regressor_values_;
  std::vector<Matrix> slopes_;  ///< of an output's weights: rules x antecedents
  Vector last_input_;           ///< u(k-1) out of a state
};

}  // namespace fpc
