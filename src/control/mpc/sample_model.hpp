// What a controller that plans by simulation knows of a process: where it stands one sample
// later. A fuzzy model (FuzzySampleModel), or equations that the loop hands over.
#pragma once

#include "fmbpc/model/local_model.hpp"

namespace fpc {

/// x(k+1) = F(x(k), u(k), d(k)) of any process whose present outputs are rows of its state.
class SampleModel {
 public:
  virtual ~SampleModel() = default;
  virtual Eigen::Index stateSize() const = 0;
  /// Row of y(k) of an output, in the order of PlantInfo.
  virtual Eigen::Index outputState(Eigen::Index output) const = 0;
  /// State of a process that has rested at these values; d: the measured disturbances, n_d.
  virtual void rest(VectorRef outputs, VectorRef input, VectorRef disturbances,
                    Eigen::Ref<Vector> state) = 0;
  /// The state one sample later, in place, without allocation. Returns false if it is not finite.
  virtual bool step(VectorRef input, VectorRef disturbances, Eigen::Ref<Vector> state) = 0;
  /// How many samples ago the measured outputs were true.
  virtual int delaySteps() const { return 0; }
};

/// A Takagi-Sugeno model along its own path: rules are blended anew at every sample, with the
/// u(k) that is tried. State: see LocalModel.
class FuzzySampleModel final : public SampleModel {
 public:
  explicit FuzzySampleModel(const TsModel& model);  ///< matched to the plant
  Eigen::Index stateSize() const override { return local_.stateSize(); }
  Eigen::Index outputState(Eigen::Index output) const override {
    return local_.outputState(output);
  }
  void rest(VectorRef outputs, VectorRef input, VectorRef disturbances,
            Eigen::Ref<Vector> state) override;
  bool step(VectorRef input, VectorRef disturbances, Eigen::Ref<Vector> state) override;

 private:
  LocalModel local_;
  Vector next_;
};

}  // namespace fpc
