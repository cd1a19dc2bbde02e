// Activated sludge model no. 1 in the five tanks of BSM1: rates of conversion. Private to the room.
//
// Source: henze1987; values at 15 C: alex2008,
// Benchmark Simulation Model no. 1. Symbols as there.
#pragma once

#include <array>

namespace fpc::bsm1 {

/// Components of a tank and of the influent, in the order of the benchmark's files. [g COD/m3]; S_O
/// [g O2/m3]; S_NO, S_NH, S_ND, X_ND [g N/m3]; S_ALK [mol/m3].
enum Component {
  kSI,
  kSS,
  kXI,
  kXS,
  kXBH,
  kXBA,
  kXP,
  kSO,
  kSNO,
  kSNH,
  kSND,
  kXND,
  kSALK,
  kComponents  // NOLINT
};
constexpr std::array<Component, 7> kSolubles{kSI, kSS, kSO, kSNO, kSNH, kSND, kSALK};
constexpr std::array<Component, 6> kParticulates{kXI, kXS, kXBH, kXBA, kXP, kXND};
constexpr std::array<const char*, kComponents> kComponentNames{
    "S_I", "S_S",  "X_I",  "X_S",  "X_BH", "X_BA", "X_P",
    "S_O", "S_NO", "S_NH", "S_ND", "X_ND", "S_ALK"};

constexpr int kTanks = 5;
constexpr int kWidth = 6;  // an even number of places, so that two tanks share a register
constexpr int kProcesses = 8;

/// One value per component and tank, a component's tanks side by side; the last place is unused.
using TankTable = std::array<std::array<double, kWidth>, kComponents>;

/// Kinetic and stoichiometric parameters. Times in days.
struct Asm1 {
  double mu_H{4.0}, K_S{10.0}, K_OH{0.2}, K_NO{0.5}, b_H{0.3};
  double mu_A{0.5}, K_NH{1.0}, K_OA{0.4}, b_A{0.05};
  double eta_g{0.8}, k_a{0.05}, k_h{3.0}, K_X{0.1}, eta_h{0.8};
  double Y_H{0.67}, Y_A{0.24}, f_P{0.08}, i_XB{0.08}, i_XP{0.06};
};

/// Rates of the eight processes [g/(m3 d)], concentrations below 0 counted as 0.
std::array<std::array<double, kWidth>, kProcesses> processRates(const Asm1& p, const TankTable& z);
/// What a unit of each process makes of each component: the Petersen matrix.
std::array<std::array<double, kComponents>, kProcesses> stoichiometry(const Asm1& p);
/// Rates of the components [g/(m3 d)] in all tanks.
void conversion(const Asm1& p, const TankTable& z, TankTable& rate);

}  // namespace fpc::bsm1
