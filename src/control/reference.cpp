// First-order reference trajectories. Source: vallejo2019, eqs. 29, 30, 37.
#include "fmbpc/control/reference.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr Eigen::Index kFar = 32;  // steps that are gone one by one

}  // namespace

ReferenceTrajectory::ReferenceTrajectory(Vector pole, bool preview)
    : pole_(std::move(pole)),
      present_(Vector::Zero(pole_.size())),
      asked_(present_),
      preview_(preview),
      scheduled_(Vector::Zero(pole_.size())),
      last_(scheduled_) {
  for (Eigen::Index i = 0; i < pole_.size(); ++i)
    require(pole_[i] >= 0.0 && pole_[i] < 1.0, "reference_pole", "numbers >= 0 and < 1");
}

void ReferenceTrajectory::reset(VectorRef outputs) { present_ = asked_ = outputs; }

void ReferenceTrajectory::goOnFrom(const ReferenceTrajectory& other) {
  present_ = other.present_;
  asked_ = other.asked_;
}

bool ReferenceTrajectory::holdBack(VectorRef outputs, const Vector& reach) {
  bool farther = false;
  for (Eigen::Index i = 0; i < present_.size(); ++i) {
    const double near = std::clamp(present_[i], outputs[i] - reach[i], outputs[i] + reach[i]);
    farther = farther || near != present_[i];
    present_[i] = near;
  }
  return farther;
}

const Vector& ReferenceTrajectory::target(const SetpointSource& setpoint,
                                          std::uint32_t step) const {
  if (!preview_) return setpoint.present();
  setpoint.scheduled(step + 1, scheduled_);
  return scheduled_;
}

/// Every setpoint on the way counts.
void ReferenceTrajectory::predictAhead(const SetpointSource& setpoint, std::uint32_t step,
                                       Eigen::Ref<Matrix> future, Eigen::Index first) const {
  last_ = present_;
  for (Eigen::Index i = 0; i < future.cols(); ++i) {
    const Vector& aim = target(setpoint, step + static_cast<std::uint32_t>(i));
    for (Eigen::Index row = 0; row < last_.size(); ++row)
      last_[row] = pole_[row] * last_[row] + (1.0 - pole_[row]) * aim[row];
    if (i >= first) future.col(i) = last_;
  }
}

void ReferenceTrajectory::predict(const SetpointSource& setpoint, std::uint32_t step,
                                  Eigen::Ref<Matrix> future, Eigen::Index first) const {
  if (preview_) {
    predictAhead(setpoint, step, future, first);
    return;
  }
  const Vector& aim = setpoint.present();
  for (Eigen::Index row = 0; row < present_.size(); ++row) {
    const double pole = pole_[row], added = (1.0 - pole) * aim[row];
    double last = present_[row];
    Eigen::Index i = 0;
    if (first > kFar) {  // a^n is there at once
      const double power = std::pow(pole, static_cast<double>(first));
      last = power * last + (1.0 - power) * aim[row];
      i = first;
    }
    for (; i < future.cols(); ++i) {
      last = pole * last + added;
      if (i >= first) future(row, i) = last;
    }
  }
}

void ReferenceTrajectory::follow(Vector& path, const Vector& aim) const {
  path = (pole_.array() * path.array() + (1.0 - pole_.array()) * aim.array()).matrix();
}

void ReferenceTrajectory::advance(const SetpointSource& setpoint, std::uint32_t step) {
  const Vector& aim = target(setpoint, step);
  follow(present_, aim);
  follow(asked_, aim);
}

}  // namespace fpc
