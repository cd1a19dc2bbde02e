// A model whose inputs carry what an observer has found on them.
#pragma once

#include <memory>
#include <utility>

#include "control/mpc/sample_model.hpp"

namespace fpc {

/// The model `inside` under u + offset, whose rest is left as it is.
class ShiftedModel final : public SampleModel {
 public:
  ShiftedModel(std::unique_ptr<SampleModel> inside, Eigen::Index n_u)
      : inside_(std::move(inside)), offset_(Vector::Zero(n_u)), input_(offset_) {}
  void setOffset(VectorRef offset) { offset_ = offset; }
  const Vector& offset() const { return offset_; }

  Eigen::Index stateSize() const override { return inside_->stateSize(); }
  Eigen::Index outputState(Eigen::Index output) const override {
    return inside_->outputState(output);
  }
  void rest(VectorRef outputs, VectorRef input, VectorRef disturbances,
            Eigen::Ref<Vector> state) override {
    inside_->rest(outputs, input, disturbances, state);
  }
  bool step(VectorRef input, VectorRef disturbances, Eigen::Ref<Vector> state) override {
    input_ = input + offset_;
    return inside_->step(input_, disturbances, state);
  }
  int delaySteps() const override { return inside_->delaySteps(); }

 private:
  std::unique_ptr<SampleModel> inside_;
  Vector offset_, input_;
};

}  // namespace fpc
