// Van de Vusse's reactions A -> B -> C and 2 A -> D in a stirred tank with a cooled jacket. Over
// the feed the yield of B has a maximum: there the gain from the feed to B changes its sign.
//
//   dcA/dt = F (cA0 - cA) - k1 cA - k3 cA^2
//   dcB/dt = -F cB + k1 cA - k2 cB                            F: feed per volume [1/h]
//   dT/dt  = F (T0 - T) - (k1 cA H1 + k2 cB H2 + k3 cA^2 H3) / (rho Cp)
//            + kw A (TK - T) / (rho Cp V)
//   dTK/dt = (Q + kw A (T - TK)) / (mK CpK)                   Q: heat into the jacket [kJ/h]
//   ki     = ki0 exp(-Ei / (T + 273.15))
//
// Source: chen1995, whose main operating point is the nominal one: the yield's maximum.
#include "arena_plant.hpp"

#include <cmath>

namespace {

using fpc::Vector;
using fpc::VectorRef;

fpc::PlantDescription describe() {
  fpc::PlantDescription p;
  p.name = "van_de_vusse";
  p.title = "Van de Vusse's reactor: a yield with a maximum (chen1995)";
  p.time_unit_s = 3600.0;
  p.states = {{"cA", "mol/l", 2.140210530131945, 0.0, 10.0},
              {"cB", "mol/l", 1.0903043613295518, 0.0, 10.0},
              {"T", "degC", 114.1910844205971, 20.0, 250.0},
              {"TK", "degC", 112.90659291081488, 0.0, 250.0}};
  p.inputs = {{"F", "1/h", 14.19, 3.0, 35.0}, {"Q", "kJ/h", -1113.5, -9000.0, 0.0}};
  p.disturbances = {{"cA0", "mol/l", 5.1, 3.0, 7.0}, {"T0", "degC", 104.9, 60.0, 150.0}};
  p.hidden_disturbances = {"cA0", "T0"};
  p.outputs = {"cB", "T"};
  p.parameters = {{"rate_1", "1/h", 1.287e12, 0.0, 1e15},       // k10
                  {"rate_2", "1/h", 1.287e12, 0.0, 1e15},       // k20
                  {"rate_3", "l/(mol h)", 9.043e9, 0.0, 1e15},  // k30
                  {"temperature_12", "K", 9758.3, 1e3, 1e5},    // E1 = E2
                  {"temperature_3", "K", 8560.0, 1e3, 1e5},     // E3
                  {"heat_1", "kJ/mol", 4.2, -1e3, 1e3},         // H1
                  {"heat_2", "kJ/mol", -11.0, -1e3, 1e3},       // H2
                  {"heat_3", "kJ/mol", -41.85, -1e3, 1e3},      // H3
                  {"density", "kg/l", 0.9342, 0.1, 10.0},
                  {"heat_capacity", "kJ/(kg K)", 3.01, 0.1, 10.0},
                  {"transfer", "kJ/(h m2 K)", 4032.0, 1.0, 1e6},  // kw
                  {"jacket_area", "m2", 0.215, 1e-3, 1e3},
                  {"volume", "l", 10.0, 1e-3, 1e6},
                  {"coolant_mass", "kg", 5.0, 1e-3, 1e6},
                  {"coolant_heat_capacity", "kJ/(kg K)", 2.0, 0.1, 10.0}};
  return p;
}

class VanDeVusse final : public arena::ArenaPlant {
 public:
  explicit VanDeVusse(const fpc::PlantParameters& given) : ArenaPlant(describe(), given) {
    contents_ = p_[8] * p_[9];
    transfer_ = p_[10] * p_[11];
    coolant_ = p_[13] * p_[14];
  }
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override {
    const double kelvin = x[2] + 273.15;
    const double first = p_[0] * std::exp(-p_[3] / kelvin) * x[0];
    const double second = p_[1] * std::exp(-p_[3] / kelvin) * x[1];
    const double third = p_[2] * std::exp(-p_[4] / kelvin) * x[0] * x[0];
    dxdt[0] = u[0] * (d[0] - x[0]) - first - third;
    dxdt[1] = -u[0] * x[1] + first - second;
    dxdt[2] = u[0] * (d[1] - x[2]) - (first * p_[5] + second * p_[6] + third * p_[7]) / contents_ +
              transfer_ * (x[3] - x[2]) / (contents_ * p_[12]);
    dxdt[3] = (u[1] + transfer_ * (x[2] - x[3])) / coolant_;
  }

 private:
  double contents_, transfer_, coolant_;
};

const bool kRegistered = arena::registered<VanDeVusse>("van_de_vusse");

}  // namespace
