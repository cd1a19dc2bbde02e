#include "plant/bsm1/works.hpp"

#include <algorithm>

namespace fpc::bsm1 {
namespace {

constexpr int kLast = kTanks - 1;

/// What returns from the settler's underflow [g/m3]: solubles of its last layer; each particulate
/// in proportion to the last tank's present composition.
Components underflow(const WorksParams& p, const TankTable& z, const SettlerState& settler) {
  Components u;
  for (std::size_t s = 0; s < kSolubles.size(); ++s)
    u[kSolubles[s]] = settler.solubles[s][kLayers - 1];
  const double feed = std::max(solids(p, z, kLast), 1e-9);
  const double ratio = settler.solids[kLayers - 1] / feed;
  for (const Component c : kParticulates) u[c] = z[c][kLast] * ratio;
  return u;
}

}  // namespace

SettlerFlows settlerFlows(const Inflow& in) {
  SettlerFlows flows;
  flows.feed = in.Q_in + in.Q_r;
  flows.underflow = std::min(in.Q_r + in.Q_w, flows.feed);
  flows.effluent = flows.feed - flows.underflow;
  return flows;
}

double solids(const WorksParams& p, const TankTable& z, int t) {
  return p.solids_per_cod * (z[kXI][t] + z[kXS][t] + z[kXBH][t] + z[kXBA][t] + z[kXP][t]);
}

std::array<double, kSolubles.size()> feedSolubles(const TankTable& z) {
  std::array<double, kSolubles.size()> feed;
  for (std::size_t s = 0; s < kSolubles.size(); ++s) feed[s] = z[kSolubles[s]][kLast];
  return feed;
}

void reactors(const WorksParams& p, const Inflow& in, const TankTable& z,
              const SettlerState& settler, TankTable& dzdt) {
  conversion(p.asm1, z, dzdt);
  const Components returned = underflow(p, z, settler);
  const double Q = in.Q_in + in.Q_r + in.Q_intr;
  const double from_influent = in.Q_in / Q, from_settler = in.Q_r / Q, from_last = in.Q_intr / Q;
  std::array<double, kWidth> dilution{};  // [1/d], 0 in the unused place
  for (int t = 0; t < kTanks; ++t) dilution[t] = Q / p.volume[t];
  for (int c = 0; c < kComponents; ++c) {
    std::array<double, kWidth> inlet;
    inlet[0] =
        from_influent * in.influent[c] + from_settler * returned[c] + from_last * z[c][kLast];
    for (int t = 1; t < kWidth; ++t) inlet[t] = z[c][t - 1];
    for (int t = 0; t < kWidth; ++t) dzdt[c][t] += dilution[t] * (inlet[t] - z[c][t]);
    dzdt[c][kTanks] = 0.0;
  }
  for (int t = 0; t < kTanks; ++t) {
    dzdt[kSO][t] += in.KLa[t] * (p.oxygen_saturation - z[kSO][t]);
    dzdt[kSS][t] += in.dose[t] * kCarbonSource / p.volume[t];
  }
}

void unpack(const double* x, TankTable& z, SettlerState& settler) {
  for (int c = 0; c < kComponents; ++c) {
    for (int t = 0; t < kTanks; ++t) z[c][t] = x[t * kComponents + c];
    z[c][kTanks] = 0.0;
  }
  const double* layers = x + kReactorStates;
  std::copy_n(layers, kLayers, settler.solids.begin());
  for (auto& soluble : settler.solubles) std::copy_n(layers += kLayers, kLayers, soluble.begin());
}

void pack(const TankTable& z, const SettlerState& settler, double* x) {
  for (int c = 0; c < kComponents; ++c)
    for (int t = 0; t < kTanks; ++t) x[t * kComponents + c] = z[c][t];
  double* layers = x + kReactorStates;
  std::copy_n(settler.solids.begin(), kLayers, layers);
  for (const auto& soluble : settler.solubles)
    std::copy_n(soluble.begin(), kLayers, layers += kLayers);
}

}  // namespace fpc::bsm1
