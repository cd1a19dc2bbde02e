// Smith predictor: the model with its transport delay, run beside the undelayed one that the law
// predicts with.
// Private to the room.
#pragma once

#include <optional>

#include "fmbpc/model/local_model.hpp"
#include "model/canonical_form.hpp"

namespace fpc {

/// Smith predictor: the undelayed model again, fed with inputs and disturbances out of a shift
/// register. A law that predicts y0(k + H) with the undelayed model compares the delayed
/// measurement with this one's output. No allocation after construction.
class SmithPredictor {
 public:
  /// Copies of the undelayed model, and the samples taken out of it (>= 1).
  SmithPredictor(LocalModel local, std::optional<CanonicalForm> canonical, int delay);

  /// Everything, the register too, has rested at these values.
  void rest(VectorRef outputs, VectorRef input, VectorRef disturbances);
  void advance(VectorRef input);       ///< from k-1 to k; `input` acted at k-1
  void foresee(Eigen::Ref<Vector> y);  ///< y_m(k+1), after blend()
  /// Rules at the model's own outputs, or at `antecedents` (laid out as LocalModel's state) if
  /// given.
  void blend(VectorRef disturbances, const Vector* antecedents);
  void output(Eigen::Ref<Vector> y) const;  ///< y_m(k), after blend()

 private:
  void predict();  ///< next_ from state_
  const AffineModel& affine() const { return canonical_ ? canonical_->affine() : local_.affine(); }

  LocalModel local_;
  std::optional<CanonicalForm> canonical_;
  Vector rest_, state_, next_, disturbance_;
  Matrix inputs_, disturbances_;  // column: one sample, a ring
  Eigen::Index oldest_input_{}, oldest_disturbance_{};
};

}  // namespace fpc
