// The works of BSM1 as differential equations: tanks, settler and the flows between them. Private
// to the room.
//
// Source: copp2002; alex2008. Layout, state order:
// docs/bsm1.md.
#pragma once

#include "plant/bsm1/asm1.hpp"
#include "plant/bsm1/settler.hpp"

namespace fpc::bsm1 {

constexpr int kReactorStates = kTanks * kComponents;
constexpr int kStates = kReactorStates + kLayers * (1 + static_cast<int>(kSolubles.size()));
constexpr double kCarbonSource = 400000.0;  ///< [g COD/m3] of the dosed carbon
constexpr int kFirstAerated = 2;
using Components = std::array<double, kComponents>;

struct WorksParams {
  Asm1 asm1;
  SettlerParams settler;
  std::array<double, kTanks> volume{1000.0, 1000.0, 1333.0, 1333.0, 1333.0};  ///< [m3]
  double oxygen_saturation{8.0};                                              ///< [g/m3]
  double solids_per_cod{0.75};                                                ///< [g SS/g COD]
};

/// What acts on the works at one moment.
struct Inflow {
  Components influent{};              ///< [g/m3]
  double Q_in{};                      ///< [m3/d]
  double Q_intr{}, Q_r{}, Q_w{};      ///< [m3/d]
  std::array<double, kTanks> KLa{};   ///< [1/d]
  std::array<double, kTanks> dose{};  ///< carbon [m3/d]
};

/// Flows through the settler; what is wasted and returned never exceeds what comes.
SettlerFlows settlerFlows(const Inflow& in);
/// Suspended solids of one tank's composition [g SS/m3].
double solids(const WorksParams& p, const TankTable& z, int tank);
/// d/dt of the tanks [g/(m3 d)] with the settler as it is.
void reactors(const WorksParams& p, const Inflow& in, const TankTable& z,
              const SettlerState& settler, TankTable& dzdt);

/// Between the state vector (tank by tank, solids of the layers, each soluble's layers) and tables.
void unpack(const double* x, TankTable& z, SettlerState& settler);
void pack(const TankTable& z, const SettlerState& settler, double* x);
/// Solubles of the last tank, the feed of the settler.
std::array<double, kSolubles.size()> feedSolubles(const TankTable& z);

}  // namespace fpc::bsm1
