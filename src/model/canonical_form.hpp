// The state-space form in which one paper printed its fuzzy model: for comparison, not for use.
#pragma once

#include "fmbpc/base/state_space.hpp"
#include "fmbpc/model/ts_model.hpp"

namespace fpc {

/// x(k+1) = A x(k) + B u(k) + R,  y = C x, every matrix the weighted mean over the rules of
///   A_i = companion form of the output's coefficients,  B_i = [0 .. 0 1]',
///   C_i = [.. b_i2 b_i1 0],  R_i = [0 .. 0 r_i / sum_j b_ij]'.
/// C stands one place to the left of where the model's own b would be, so y answers u one sample
/// later than in the model; and since C changes with the weights, so does the scale of the state.
/// Source: blazic2007, eqs. 13-16 and 28, as printed.
class CanonicalForm {
 public:
  /// One output, one input, no disturbances, fewer input lags than output lags, both from lag 0.
  /// @throws InputError naming `realisation` if the model does not fit, or if a rule's b vanish.
  explicit CanonicalForm(const TsModel& model);

  void blend(const FiringResult& firing);  ///< no allocation
  const AffineModel& affine() const { return affine_; }
  /// The state that rests under this input, as blended now; not finite if the model integrates.
  void restState(double input, Eigen::Ref<Vector> state) const;

 private:
  struct Row {
    Vector output, input;  // coefficients by lag
    double offset{};       // r / sum b
  };
  std::vector<Row> rules_;
  AffineModel affine_;
};

}  // namespace fpc
