// Stirred-tank reactor with an exothermic reaction A -> B whose feed flow and coolant flow are both
// moved, so that concentration and temperature can be led apart.
//
//   dCa/dt = q/V (CAf - Ca) - k0 Ca exp(-(E/R)/T)
//   dT/dt  = q/V (Tf - T) + k1 Ca exp(-(E/R)/T) + k2 qc (1 - exp(-k3/qc)) (Tcf - T)
//   k1 = -dH k0 / (rho Cp),  k2 = rho_c Cpc / (rho Cp V),  k3 = hA / (rho_c Cpc)
//
// Source: taieb2017, eq. 26 and table 4, where the sign of dH
// would make the reaction cool: it is negative here. CVODE in place of their Euler step of 0.01
// min. With qc = 103.4066 and q = 100 it rests where the single-input reactor of cstr.cpp does.
#include <cmath>

#include "fmbpc/plant/plant.hpp"

namespace fpc {
namespace {

PlantDescription describeMimoCstr() {
  PlantDescription p;
  p.name = "mimo_cstr";
  p.title = "Stirred-tank reactor, feed and coolant flow both moved (taieb2017)";
  p.time_unit_s = 60.0;
  p.states = {{"Ca", "mol/l", 0.1000001680476245, 0.0, 10.0},
              {"T", "K", 438.5443805030675, 200.0, 1000.0}};
  p.inputs = {{"q", "l/min", 100.0, 0.0, 5000.0}, {"qc", "l/min", 103.4066, 0.0, 5000.0}};
  p.disturbances = {{"CAf", "mol/l", 1.0, 0.0, 10.0},
                    {"Tf", "K", 350.0, 200.0, 1000.0},
                    {"Tcf", "K", 350.0, 200.0, 1000.0}};
  p.hidden_disturbances = {"CAf", "Tf", "Tcf"};
  p.outputs = {"Ca", "T"};
  p.parameters = {
      {"reactor_volume", "l", 100.0, 1e-3, 1e9},               // V
      {"heat_transfer", "cal/(min K)", 7e5, 0.0, 1e12},        // hA
      {"rate_constant", "1/min", 7.2e10, 0.0, 1e20},           // k0
      {"activation_temperature", "K", 1e4, 0.0, 1e6},          // E/R
      {"reaction_heat", "cal/mol", -2e5, -1e8, 1e8},           // dH, negative: it heats
      {"density", "g/l", 1e3, 1e-3, 1e6},                      // rho
      {"coolant_density", "g/l", 1e3, 1e-3, 1e6},              // rho_c
      {"heat_capacity", "cal/(g K)", 1.0, 1e-3, 1e3},          // Cp
      {"coolant_heat_capacity", "cal/(g K)", 1.0, 1e-3, 1e3},  // Cpc
  };
  p.frames = {{"plant", "map", 0.0, 0.0, 0.0},           {"reactor", "plant", 0.0, 0.0, 1.0},
              {"feed_valve", "plant", -2.0, 0.5, 1.5},   {"coolant_valve", "plant", -2.0, 0.0, 1.0},
              {"thermometer", "reactor", 0.0, 0.0, 0.5}, {"analyzer", "reactor", 0.5, 0.0, 0.0}};
  p.output_frames = {{"Ca", "analyzer"}, {"T", "thermometer"}};
  return p;
}

class MimoCstr final : public Plant {
 public:
  explicit MimoCstr(const PlantParameters& parameters) : description_(describeMimoCstr()) {
    const Vector p = parameterValues(description_, parameters);
    const double contents = p[5] * p[7], coolant = p[6] * p[8];  // rho Cp [cal/(l K)]
    V_ = p[0];
    k0_ = p[2];
    E_R_ = p[3];
    k1_ = -p[4] * k0_ / contents;
    k2_ = coolant / (contents * V_);
    k3_ = p[1] / coolant;
  }
  const PlantDescription& description() const override { return description_; }
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override {
    const double Ca = x[0], T = x[1], q = u[0], qc = u[1];
    const double reaction = Ca * std::exp(-E_R_ / T);
    const double cooling = qc > 0.0 ? -k2_ * qc * std::expm1(-k3_ / qc) : 0.0;  // [1/min]
    dxdt[0] = q / V_ * (d[0] - Ca) - k0_ * reaction;
    dxdt[1] = q / V_ * (d[1] - T) + k1_ * reaction + cooling * (d[2] - T);
  }

 private:
  PlantDescription description_;
  double V_, k0_, E_R_, k1_, k2_, k3_;
};

const bool kMimoCstrRegistered = registerPlant("mimo_cstr", [](const PlantParameters& parameters) {
  return std::make_unique<MimoCstr>(parameters);
});

}  // namespace
}  // namespace fpc
