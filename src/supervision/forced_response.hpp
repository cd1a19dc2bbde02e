// What the inputs have done to the outputs since a sample, as a model says.
#pragma once

#include "fmbpc/base/ring.hpp"
#include "fmbpc/model/local_model.hpp"

namespace fpc {

/// Two runs of the model that begin at rest at one sample, under the same disturbances: one with
/// the inputs that were applied since, one with those of that sample. Their difference is due to
/// the inputs alone: an offset of the model has no part in it.
class ForcedResponse {
 public:
  /// `model` is matched to the plant.
  explicit ForcedResponse(const TsModel& model);
  void begin(const Measurement& now);
  /// The sample after the last one that was begun or moved to. No allocation.
  void move(const Measurement& now);
  /// Of an output, in its unit; NaN after a sample in which something was no number.
  double of(Eigen::Index output) const;

 private:
  LocalModel local_;
  Vector moved_, held_, next_, input_, disturbances_;
  bool apart_{false}, known_{false};
};

}  // namespace fpc
