#include "plant/bsm1/settler.hpp"

#include <algorithm>
#include <cmath>

namespace fpc::bsm1 {
namespace {

/// What the flows carry through the layers: up above the feed, down below it. [1/d] after scaling.
void carry(const SettlerParams& p, const SettlerFlows& flows, const Layers& x, double feed,
           Layers& dxdt) {
  const double up = flows.effluent / (p.area * p.layer_height);
  const double down = flows.underflow / (p.area * p.layer_height);
  for (int i = 0; i < kFeedLayer; ++i) dxdt[i] = up * (x[i + 1] - x[i]);
  dxdt[kFeedLayer] = flows.feed / (p.area * p.layer_height) * feed - (up + down) * x[kFeedLayer];
  for (int i = kFeedLayer + 1; i < kLayers; ++i) dxdt[i] = down * (x[i - 1] - x[i]);
}

/// Gravity flux out of each layer into the one below [g/(m2 d)].
std::array<double, kLayers - 1> gravityFlux(const SettlerParams& p, const Layers& x,
                                            double feed_solids) {
  Layers own;
  for (int i = 0; i < kLayers; ++i) own[i] = settlingVelocity(p, x[i], feed_solids) * x[i];
  std::array<double, kLayers - 1> flux;
  for (int i = 0; i < kLayers - 1; ++i) {
    const bool free = i < kFeedLayer && x[i + 1] <= p.threshold;
    flux[i] = free ? own[i] : std::min(own[i], own[i + 1]);
  }
  return flux;
}

}  // namespace

double settlingVelocity(const SettlerParams& p, double solids, double feed_solids) {
  const double excess = solids - p.not_settling * feed_solids;
  const double v = p.v_0 * (std::exp(-p.r_hindered * excess) - std::exp(-p.r_low * excess));
  return std::clamp(v, 0.0, p.v_max);
}

void settle(const SettlerParams& p, const SettlerFlows& flows, const SettlerState& x,
            double feed_solids, const std::array<double, kSolubles.size()>& feed_solubles,
            SettlerState& dxdt) {
  carry(p, flows, x.solids, feed_solids, dxdt.solids);
  const auto flux = gravityFlux(p, x.solids, feed_solids);
  for (int i = 0; i < kLayers - 1; ++i) {
    dxdt.solids[i] -= flux[i] / p.layer_height;
    dxdt.solids[i + 1] += flux[i] / p.layer_height;
  }
  for (std::size_t s = 0; s < kSolubles.size(); ++s)
    carry(p, flows, x.solubles[s], feed_solubles[s], dxdt.solubles[s]);
}

}  // namespace fpc::bsm1
