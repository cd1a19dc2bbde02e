#include "supervision/forced_response.hpp"

#include <limits>

#include "fmbpc/base/signals.hpp"

namespace fpc {

ForcedResponse::ForcedResponse(const TsModel& model)
    : local_(model),
      moved_(Vector::Zero(local_.stateSize())),
      held_(moved_),
      next_(moved_),
      input_(Vector::Zero(static_cast<Eigen::Index>(model.inputs.size()))),
      disturbances_(Vector::Zero(static_cast<Eigen::Index>(model.disturbances.size()))) {}

void ForcedResponse::begin(const Measurement& now) {
  apart_ = false;
  known_ = allFinite(now);
  if (!known_) return;
  local_.restState(now.outputs, now.input_applied, now.disturbances, moved_);
  held_ = moved_;
  input_ = now.input_applied;
  disturbances_ = now.disturbances;
}

void ForcedResponse::move(const Measurement& now) {
  if (known_ && !apart_ && now.input_applied == input_) return begin(now);
  known_ = known_ && allFinite(now);
  if (!known_) return;
  apart_ = true;
  local_.advance(moved_, now.input_applied, disturbances_, next_);
  moved_.swap(next_);
  local_.advance(held_, input_, disturbances_, next_);
  held_.swap(next_);
  disturbances_ = now.disturbances;
}

double ForcedResponse::of(Eigen::Index output) const {
  const Eigen::Index row = local_.outputState(output);
  return known_ ? moved_[row] - held_[row] : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace fpc
