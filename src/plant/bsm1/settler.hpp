// Secondary settler of BSM1: ten layers in one dimension, nothing reacts. Private to the room.
//
// Source: takacs1991, settling velocity; copp2002, layers and fluxes.
#pragma once

#include <array>

#include "plant/bsm1/asm1.hpp"

namespace fpc::bsm1 {

constexpr int kLayers = 10;
constexpr int kFeedLayer = 4;  ///< counted from 0 at the top
using Layers = std::array<double, kLayers>;

struct SettlerParams {
  double area{1500.0}, layer_height{0.4};       ///< [m2], [m]
  double v_max{250.0}, v_0{474.0};              ///< [m/d]
  double r_hindered{0.000576}, r_low{0.00286};  ///< [m3/g]
  double not_settling{0.00228};                 ///< share of the feed
  double threshold{3000.0};                     ///< [g/m3], flux above the feed
};

/// Flows through the settler [m3/d].
struct SettlerFlows {
  double feed{}, effluent{}, underflow{};
};

/// Sludge and solubles in the layers, the top first. [g/m3]
struct SettlerState {
  Layers solids{};
  std::array<Layers, kSolubles.size()> solubles{};
};

/// Settling velocity [m/d] of sludge of `solids` [g/m3] with a feed of `feed_solids`.
double settlingVelocity(const SettlerParams& p, double solids, double feed_solids);
/// d/dt of the layers [g/(m3 d)] for a feed of these solids and solubles.
void settle(const SettlerParams& p, const SettlerFlows& flows, const SettlerState& x,
            double feed_solids, const std::array<double, kSolubles.size()>& feed_solubles,
            SettlerState& dxdt);

}  // namespace fpc::bsm1
