// Continuous stirred-tank reactor with an exothermic reaction A -> B, cooled by a single coolant
// stream: three steady states for most coolant flows, and a Hopf point near the working range.
//
//   dCA/dt = q/V (CA0 - CA) - k0 CA exp(-(E/R)/T)
//   dT/dt  = q/V (T0 - T) + k0 D CA exp(-(E/R)/T)                        D = -dH/(rho Cp)
//            + rho_c Cpc/(rho Cp V) q_j (1 - exp(-hA/(q_j rho_c Cpc))) (Tc0 - T)
//   q_j    = max(0, q_c + d_q_c)                                         flow through the jacket
//   k0 stands for k0 (1 + rate / 100).
//
// A local loop on the reactor's temperature, sampled with the loop, widens the stable range:
//   q_c(k) = u(k) + K [T(k) - T(k-1)],  T as it is now, without noise or delay.
//
// Source: blazic2007, eqs. 1, 2, 10 and table 1.
// There K = 3; here the plain reactor (K = 0) is the default.
#include <algorithm>
#include <cmath>

#include "fmbpc/plant/plant.hpp"

namespace fpc {
namespace {

PlantDescription describeCstr() {
  PlantDescription p;
  p.name = "cstr";
  p.title = "Stirred-tank reactor with coolant jacket, 2 states (blazic2007)";
  p.time_unit_s = 60.0;
  p.states = {{"CA", "mol/l", 0.1000001680476245, 0.0, 10.0},
              {"T", "K", 438.5443805030675, 200.0, 1000.0}};
  p.inputs = {{"q_c", "l/min", 103.4066, 0.0, 500.0}};
  p.disturbances = {{"d_q_c", "l/min", 0.0, -100.0, 100.0},
                    {"rate", "%", 0.0, -90.0, 900.0}};  // of k0, on top of it
  p.hidden_disturbances = {"rate"};
  p.outputs = {"CA"};
  p.parameters = {
      {"feed_flow", "l/min", 100.0, 0.0, 1e6},                 // q
      {"feed_concentration", "mol/l", 1.0, 0.0, 1e3},          // CA0
      {"feed_temperature", "K", 350.0, 200.0, 1000.0},         // T0
      {"coolant_temperature", "K", 350.0, 200.0, 1000.0},      // Tc0
      {"reactor_volume", "l", 100.0, 1e-3, 1e9},               // V
      {"heat_transfer", "cal/(min K)", 7e5, 0.0, 1e12},        // hA
      {"rate_constant", "1/min", 7.2e10, 0.0, 1e20},           // k0
      {"activation_temperature", "K", 1e4, 0.0, 1e6},          // E/R
      {"reaction_heat", "cal/mol", -2e5, -1e8, 1e8},           // dH
      {"density", "g/l", 1e3, 1e-3, 1e6},                      // rho
      {"coolant_density", "g/l", 1e3, 1e-3, 1e6},              // rho_c
      {"heat_capacity", "cal/(g K)", 1.0, 1e-3, 1e3},          // Cp
      {"coolant_heat_capacity", "cal/(g K)", 1.0, 1e-3, 1e3},  // Cpc
      {"compensator_gain", "l/(min K)", 0.0, -100.0, 100.0},   // K
  };
  p.frames = {{"plant", "map", 0.0, 0.0, 0.0},
              {"reactor", "plant", 0.0, 0.0, 1.0},
              {"coolant_valve", "plant", -2.0, 0.0, 1.0},
              {"thermometer", "reactor", 0.0, 0.0, 0.5},
              {"analyzer", "reactor", 9.0, 12.0, 0.0}};  // 15 m of sample line
  p.output_frames = {{"CA", "analyzer"}, {"T", "thermometer"}};
  return p;
}

class Cstr final : public Plant {
 public:
  explicit Cstr(const PlantParameters& parameters);
  const PlantDescription& description() const override { return description_; }
  void derivatives(VectorRef state, VectorRef u, VectorRef d,
                   Eigen::Ref<Vector> dxdt) const override;
  void localLoop(VectorRef state, VectorRef before, Eigen::Ref<Vector> u) const override {
    u[0] += K_ * (state[1] - before[1]);
  }

 private:
  PlantDescription description_;
  double q_, CA0_, T0_, Tc0_, V_, hA_, k0_, E_R_, dH_, rho_, rho_c_, Cp_, Cpc_, K_;
};

Cstr::Cstr(const PlantParameters& parameters) : description_(describeCstr()) {
  const Vector p = parameterValues(description_, parameters);
  Eigen::Index i = 0;
  for (double* value :
       {&q_, &CA0_, &T0_, &Tc0_, &V_, &hA_, &k0_, &E_R_, &dH_, &rho_, &rho_c_, &Cp_, &Cpc_, &K_})
    *value = p[i++];
}

void Cstr::derivatives(VectorRef state, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const {
  const double CA = state[0], T = state[1];
  const double q_j = std::max(0.0, u[0] + d[0]);
  const double reaction = k0_ * (1.0 + d[1] / 100.0) * CA * std::exp(-E_R_ / T);
  const double coolant = q_j * rho_c_ * Cpc_;  // [cal/(min K)]
  const double cooling = coolant > 0.0 ? coolant * (1.0 - std::exp(-hA_ / coolant)) : 0.0;
  dxdt[0] = q_ / V_ * (CA0_ - CA) - reaction;
  dxdt[1] = q_ / V_ * (T0_ - T) - dH_ / (rho_ * Cp_) * reaction +
            cooling / (rho_ * Cp_ * V_) * (Tc0_ - T);
}

const bool kCstrRegistered = registerPlant(
    "cstr", [](const PlantParameters& parameters) { return std::make_unique<Cstr>(parameters); });

}  // namespace
}  // namespace fpc
