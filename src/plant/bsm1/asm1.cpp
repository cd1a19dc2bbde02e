#include "plant/bsm1/asm1.hpp"

#include <algorithm>

namespace fpc::bsm1 {
namespace {

using Row = std::array<double, kWidth>;
constexpr double kTiny = 1e-30;  // keeps the empty place and empty tanks finite

Row clipped(const Row& row) {
  Row r;
  for (int t = 0; t < kWidth; ++t) r[t] = std::max(row[t], 0.0);
  return r;
}

/// a / (K + a), a >= 0.
Row monod(const Row& a, double K) {
  Row r;
  for (int t = 0; t < kWidth; ++t) r[t] = a[t] / (K + a[t]);
  return r;
}

}  // namespace

std::array<Row, kProcesses> processRates(const Asm1& p, const TankTable& z) {
  const Row S_S = clipped(z[kSS]), X_S = clipped(z[kXS]), X_BH = clipped(z[kXBH]);
  const Row X_BA = clipped(z[kXBA]), S_O = clipped(z[kSO]), S_NO = clipped(z[kSNO]);
  const Row S_NH = clipped(z[kSNH]), S_ND = clipped(z[kSND]), X_ND = clipped(z[kXND]);
  const Row substrate = monod(S_S, p.K_S), aerobic = monod(S_O, p.K_OH);
  const Row nitrate = monod(S_NO, p.K_NO), nitrifying = monod(S_O, p.K_OA);
  const Row ammonium = monod(S_NH, p.K_NH);
  std::array<Row, kProcesses> rho;
  for (int t = 0; t < kWidth; ++t) {
    const double anoxic = (1.0 - aerobic[t]) * nitrate[t];
    const double growth = p.mu_H * substrate[t] * X_BH[t];
    // k_h q/(K_X + q) X_BH with q = X_S/X_BH is h X_S; the same share of X_ND goes along.
    const double h =
        p.k_h * X_BH[t] / (p.K_X * X_BH[t] + X_S[t] + kTiny) * (aerobic[t] + p.eta_h * anoxic);
    rho[0][t] = growth * aerobic[t];
    rho[1][t] = growth * anoxic * p.eta_g;
    rho[2][t] = p.mu_A * ammonium[t] * nitrifying[t] * X_BA[t];
    rho[3][t] = p.b_H * X_BH[t];
    rho[4][t] = p.b_A * X_BA[t];
    rho[5][t] = p.k_a * S_ND[t] * X_BH[t];
    rho[6][t] = h * X_S[t];
    rho[7][t] = h * X_ND[t];
  }
  return rho;
}

std::array<std::array<double, kComponents>, kProcesses> stoichiometry(const Asm1& p) {
  std::array<std::array<double, kComponents>, kProcesses> nu{};
  const double denitrified = (1.0 - p.Y_H) / (2.86 * p.Y_H);
  nu[0][kSS] = nu[1][kSS] = -1.0 / p.Y_H;
  nu[0][kXBH] = nu[1][kXBH] = 1.0;
  nu[0][kSNH] = nu[1][kSNH] = -p.i_XB;
  nu[0][kSO] = -(1.0 - p.Y_H) / p.Y_H;
  nu[0][kSALK] = -p.i_XB / 14.0;
  nu[1][kSNO] = -denitrified;
  nu[1][kSALK] = denitrified / 14.0 - p.i_XB / 14.0;
  nu[2][kXBA] = 1.0;
  nu[2][kSO] = -(4.57 - p.Y_A) / p.Y_A;
  nu[2][kSNO] = 1.0 / p.Y_A;
  nu[2][kSNH] = -p.i_XB - 1.0 / p.Y_A;
  nu[2][kSALK] = -p.i_XB / 14.0 - 1.0 / (7.0 * p.Y_A);
  nu[3][kXBH] = nu[4][kXBA] = -1.0;
  for (const int decay : {3, 4}) {
    nu[decay][kXS] = 1.0 - p.f_P;
    nu[decay][kXP] = p.f_P;
    nu[decay][kXND] = p.i_XB - p.f_P * p.i_XP;
  }
  nu[5][kSND] = -1.0;
  nu[5][kSNH] = 1.0;
  nu[5][kSALK] = 1.0 / 14.0;
  nu[6][kXS] = -1.0;
  nu[6][kSS] = 1.0;
  nu[7][kXND] = -1.0;
  nu[7][kSND] = 1.0;
  return nu;
}

// The sums over the non-zero entries of stoichiometry(), written out: this is nearly all the work.
void conversion(const Asm1& p, const TankTable& z, TankTable& r) {
  const auto rho = processRates(p, z);
  const double ox_H = (1.0 - p.Y_H) / p.Y_H, ox_A = (4.57 - p.Y_A) / p.Y_A;
  const double denitrified = ox_H / 2.86, decay_N = p.i_XB - p.f_P * p.i_XP;
  const double per_Y_H = 1.0 / p.Y_H, per_Y_A = 1.0 / p.Y_A, per_14 = 1.0 / 14.0;
  for (int t = 0; t < kWidth; ++t) {
    const double growth = rho[0][t] + rho[1][t], nitrified = rho[2][t];
    const double decay = rho[3][t] + rho[4][t];
    r[kSI][t] = r[kXI][t] = 0.0;
    r[kSS][t] = rho[6][t] - per_Y_H * growth;
    r[kXS][t] = (1.0 - p.f_P) * decay - rho[6][t];
    r[kXBH][t] = growth - rho[3][t];
    r[kXBA][t] = nitrified - rho[4][t];
    r[kXP][t] = p.f_P * decay;
    r[kSO][t] = -ox_H * rho[0][t] - ox_A * nitrified;
    r[kSNO][t] = per_Y_A * nitrified - denitrified * rho[1][t];
    r[kSNH][t] = rho[5][t] - p.i_XB * growth - (p.i_XB + per_Y_A) * nitrified;
    r[kSND][t] = rho[7][t] - rho[5][t];
    r[kXND][t] = decay_N * decay - rho[7][t];
    r[kSALK][t] = per_14 * (rho[5][t] - p.i_XB * (growth + nitrified) + denitrified * rho[1][t] -
                            2.0 * per_Y_A * nitrified);
  }
}

}  // namespace fpc::bsm1
