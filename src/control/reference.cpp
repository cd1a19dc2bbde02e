// First-order reference trajectories. Source: vallejo2019, eqs. 29, 30, 37.
#include "fmbpc/control/reference.hpp"

#include <utility>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

ReferenceTrajectory::ReferenceTrajectory(Vector pole, bool preview)
    : pole_(std::move(pole)),
      present_(Vector::Zero(pole_.size())),
      preview_(preview),
      scheduled_(Vector::Zero(pole_.size())) {
  for (Eigen::Index i = 0; i < pole_.size(); ++i)
    require(pole_[i] >= 0.0 && pole_[i] < 1.0, "reference_pole", "numbers >= 0 and < 1");
}

void ReferenceTrajectory::reset(VectorRef outputs) { present_ = outputs; }

const Vector& ReferenceTrajectory::target(const SetpointSource& setpoint,
                                          std::uint32_t step) const {
  if (!preview_) return setpoint.present();
  setpoint.scheduled(step + 1, scheduled_);
  return scheduled_;
}

void ReferenceTrajectory::predict(const SetpointSource& setpoint, std::uint32_t step,
                                  Eigen::Ref<Matrix> future) const {
  for (Eigen::Index i = 0; i < future.cols(); ++i) {
    const Vector& aim = target(setpoint, step + static_cast<std::uint32_t>(i));
    for (Eigen::Index row = 0; row < present_.size(); ++row) {
      const double last = i == 0 ? present_[row] : future(row, i - 1);
      future(row, i) = pole_[row] * last + (1.0 - pole_[row]) * aim[row];
    }
  }
}

void ReferenceTrajectory::advance(const SetpointSource& setpoint, std::uint32_t step) {
  const Vector& aim = target(setpoint, step);
  present_ = (pole_.array() * present_.array() + (1.0 - pole_.array()) * aim.array()).matrix();
}

}  // namespace fpc
