// No bump when a law starts, takes over from a person or from another law.
#pragma once

#include "fmbpc/base/types.hpp"

namespace fpc {

constexpr double kTransferDecay = 0.9;  ///< share of the bias that is left after a sample

/// A bias on what a law proposes: it makes the first input after a start or a hand-over the one
/// that the process already gets, and dies out from then on. A predictive law has one for its own
/// starts; a session has one on what the plant gets, for the samples after another hand (a person,
/// the fallback, the plant's own) had the inputs. No allocation after construction.
class BumplessTransfer {
 public:
  /// decay: share of the bias that is left after a sample, [0, 1).
  explicit BumplessTransfer(Eigen::Index n_u, double decay = kTransferDecay);
  /// No bias; if `pending`, the next finite proposal becomes the applied input.
  void reset(bool pending);
  bool active() const;  ///< a bias is due, or more than a thousandth of the last one is left
  /// Turns a proposal into the input of the law.
  void apply(VectorRef input_applied, Eigen::Ref<Vector> proposal);
  /// apply() and fade() in one; false, and nothing is done, where no bias is active().
  bool bridge(VectorRef input_applied, Eigen::Ref<Vector> proposal);
  /// Between two laws of one sample: `input` is what the older one gives; the younger one's
  /// proposal then becomes this in finish(), whatever it was.
  void begin(VectorRef input);
  void finish(Eigen::Ref<Vector> proposal);
  /// Adds the bias of the samples k, k+1, ... to the columns.
  void addTo(Eigen::Ref<Matrix> inputs) const;
  void fade();  ///< to the next sample

 private:
  double decay_, left_{0.0};  // left_: share of the last bias
  Vector bias_, kept_;
  bool pending_{false};
};

}  // namespace fpc
