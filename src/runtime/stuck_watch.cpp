#include "runtime/stuck_watch.hpp"

#include <algorithm>
#include <cmath>

namespace fpc {

StuckWatch::StuckWatch(const StuckParams& params, const InputLimits& limits,
                       const std::vector<SignalInfo>& inputs)
    : params_(params), limits_(limits), away_(inputs.size(), 0) {
  for (const SignalInfo& input : inputs) names_.push_back(input.name);
  expected_ = Vector::Zero(limits.lower.size());
  followed_ = Vector::Constant(limits.lower.size(), std::nan(""));
}

void StuckWatch::reset() {
  away_.assign(away_.size(), 0);
  followed_.setConstant(std::nan(""));
  words_.clear();
}

void StuckWatch::look(VectorRef commanded, VectorRef before, VectorRef position) {
  words_.clear();
  if (params_.samples == 0) return;
  expected_ = commanded;
  limits_.clip(expected_, before);
  for (Eigen::Index i = 0; i < expected_.size(); ++i) {
    const double range = limits_.upper[i] - limits_.lower[i];
    const double tolerated = std::isfinite(range) ? params_.tolerance * range : 0.0;
    const auto k = static_cast<std::size_t>(i);
    const bool follows = std::abs(expected_[i] - position[i]) <= tolerated;
    if (follows) followed_[i] = expected_[i];
    away_[k] = follows ? 0 : std::min(away_[k] + 1, params_.samples);
    if (away_[k] < params_.samples || !words_.empty()) continue;
    input_ = names_[k];
    words_ = "input " + input_ +
             (std::isnan(position[i]) ? " is not read back" : " does not follow its command");
  }
}

void StuckWatch::hold(Eigen::Ref<Vector> action, VectorRef told) const {
  for (Eigen::Index i = 0; i < action.size(); ++i) {
    const int away = away_[static_cast<std::size_t>(i)];
    if (away == 0) continue;
    const bool back = away >= params_.samples && std::isfinite(followed_[i]);
    const double move = limits_.move[i];
    action[i] = std::clamp(back ? followed_[i] : told[i], action[i] - move, action[i] + move);
  }
}

bool StuckWatch::all() const {
  return params_.samples > 0 && std::all_of(away_.begin(), away_.end(),
                                            [this](int away) { return away >= params_.samples; });
}

}  // namespace fpc
