#include "plant/actuator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

void requireInside(const Vector& value, const InputLimits& limits, const std::string& field) {
  require(value.size() == limits.lower.size(), field,
          std::to_string(limits.lower.size()) + " numbers");
  const bool inside = (value.array() >= limits.lower.array()).all() &&
                      (value.array() <= limits.upper.array()).all();
  require(inside, field, "numbers between input_lower and input_upper");
}

}  // namespace

void ActuatorParams::validate(Eigen::Index n_u) const {
  limits.validate(n_u);
  requireInside(initial, limits, "actuator.initial");
  requireInside(fallback, limits, "actuator.fallback");
  require(hold_samples >= -1, "actuator.hold_samples", "an integer >= -1");
}

Actuator::Actuator(ActuatorParams params) : params_(std::move(params)) {
  params_.validate(params_.limits.lower.size());
  reset();
}

void Actuator::reset() {
  applied_ = params_.initial;
  commanded_ = params_.initial;
  previous_ = params_.initial;
  missed_ = 0;
  clips_ = 0;
}

void Actuator::moveTo(VectorRef target) {
  previous_ = applied_;
  applied_ = target;
  params_.limits.clip(applied_, previous_);
}

void Actuator::apply(VectorRef commanded) {
  if (commanded.size() != applied_.size() || !commanded.allFinite()) return miss();
  moveTo(commanded);
  commanded_ = applied_;
  missed_ = 0;
  const auto range = (params_.limits.upper - params_.limits.lower).array();
  const auto beyond = (commanded - applied_).array().abs();
  clips_ = static_cast<std::uint32_t>((beyond > 1e-9 * range).count());
}

void Actuator::miss() {
  if (missed_ < std::numeric_limits<int>::max()) ++missed_;
  clips_ = 0;
  const bool hold = params_.hold_samples < 0 || missed_ <= params_.hold_samples;
  moveTo(hold ? commanded_ : params_.fallback);
}

void Actuator::disturb(Eigen::Index i, double position) {
  if (std::isnan(position)) return;
  applied_[i] = std::clamp(position, params_.limits.lower[i], params_.limits.upper[i]);
}

}  // namespace fpc
