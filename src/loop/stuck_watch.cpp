#include "fmbpc/loop/stuck_watch.hpp"

#include <algorithm>
#include <cmath>

namespace fpc {

StuckWatch::StuckWatch(const StuckParams& params, const InputLimits& limits,
                       const std::vector<SignalInfo>& inputs)
    : params_(params), limits_(limits), away_(inputs.size(), 0) {
  for (const SignalInfo& input : inputs) names_.push_back(input.name);
  expected_ = Vector::Zero(limits.lower.size());
}

void StuckWatch::reset() {
  away_.assign(away_.size(), 0);
  words_.clear();
}

void StuckWatch::look(VectorRef commanded, VectorRef before, VectorRef applied) {
  words_.clear();
  if (params_.samples == 0) return;
  expected_ = commanded;
  limits_.clip(expected_, before);
  for (Eigen::Index i = 0; i < expected_.size(); ++i) {
    const double range = limits_.upper[i] - limits_.lower[i];
    const double tolerated = std::isfinite(range) ? params_.tolerance * range : 0.0;
    const auto k = static_cast<std::size_t>(i);
    const bool away = std::abs(expected_[i] - applied[i]) > tolerated;
    away_[k] = away ? std::min(away_[k] + 1, params_.samples) : 0;
    if (away_[k] < params_.samples || !words_.empty()) continue;
    words_ = "input " + names_[k] + " does not follow its command";
  }
}

}  // namespace fpc
