#include "runtime/recent_samples.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/signals.hpp"
#include "fmbpc/model/local_model.hpp"

namespace fpc {

RecentSamples::RecentSamples(const PlantInfo& plant) {
  Measurement empty;
  empty.outputs = Vector::Zero(countOf(plant.outputs));
  empty.input_applied = Vector::Zero(countOf(plant.inputs));
  empty.disturbances = Vector::Zero(countOf(plant.disturbances));
  samples_.assign(kKept, empty);
}

void RecentSamples::add(const Measurement& now) {
  Measurement& place = samples_[static_cast<std::size_t>(next_)];
  place.outputs = now.outputs;
  place.input_applied = now.input_applied;
  place.disturbances = now.disturbances;
  next_ = (next_ + 1) % kKept;
  count_ = std::min(count_ + 1, kKept);
}

const Measurement& RecentSamples::at(int k) const {
  return samples_[static_cast<std::size_t>((next_ - count_ + kKept + k) % kKept)];
}

Vector RecentSamples::errorsOf(const TsModel& model) const {
  if (!enough()) return {};
  const int judged = count_ / 2;
  LocalModel local(model);
  Vector state(local.stateSize()), next = state, squares = Vector::Zero(countOf(model.outputs));
  local.restState(at(0).outputs, at(0).input_applied, at(0).disturbances, state);
  for (int k = 1; k < count_; ++k) {
    const Measurement& now = at(k);
    const Vector& before = at(k - 1).disturbances;
    local.advance(state, now.input_applied, before, next);
    if (k >= count_ - judged) squares += (now.outputs - local.affine().C * next).cwiseAbs2();
    local.shiftState(now.outputs, now.input_applied, before, state);
  }
  return (squares / static_cast<double>(judged)).cwiseSqrt();
}

}  // namespace fpc
