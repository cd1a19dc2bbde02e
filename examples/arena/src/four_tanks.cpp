// Four tanks, two pumps, two valves that split each pump's flow between a lower tank and the upper
// tank of the other side. With most of the flow below (gamma1 + gamma2 > 1) the zeros are in the
// left half plane, with most of it above one is in the right half plane.
//
//   A1 dh1/dt = -a1 sqrt(2 g h1) + a3 sqrt(2 g h3) + gamma1 k1 v1 + f1
//   A2 dh2/dt = -a2 sqrt(2 g h2) + a4 sqrt(2 g h4) + gamma2 k2 v2 + f2
//   A3 dh3/dt = -a3 sqrt(2 g h3) + (1 - gamma2) k2 v2
//   A4 dh4/dt = -a4 sqrt(2 g h4) + (1 - gamma1) k1 v1         levels in cm, flows in cm3/s
//
// Source: johansson2000, section II; the loads f1 and f2 are an addition.
#include "arena_plant.hpp"

#include <algorithm>
#include <cmath>

namespace {

using fpc::Vector;
using fpc::VectorRef;

constexpr double kTwoGravity = 2.0 * 981.0;  // [cm/s2]

fpc::PlantDescription describe() {
  fpc::PlantDescription p;
  p.name = "four_tanks";
  p.title = "Four tanks with an adjustable zero (johansson2000)";
  p.time_unit_s = 1.0;
  p.states = {{"h1", "cm", 12.2629675195507, 0.0, 30.0},
              {"h2", "cm", 12.783158403008972, 0.0, 30.0},
              {"h3", "cm", 1.6339411322567796, 0.0, 30.0},
              {"h4", "cm", 1.409044702533737, 0.0, 30.0}};
  p.inputs = {{"v1", "V", 3.0, 0.0, 10.0}, {"v2", "V", 3.0, 0.0, 10.0}};
  p.disturbances = {{"f1", "cm3/s", 0.0, -10.0, 10.0}, {"f2", "cm3/s", 0.0, -10.0, 10.0}};
  p.hidden_disturbances = {"f1", "f2"};
  p.outputs = {"h1", "h2"};
  p.parameters = {{"area_13", "cm2", 28.0, 1.0, 1e4},     // A1, A3
                  {"area_24", "cm2", 32.0, 1.0, 1e4},     // A2, A4
                  {"outlet_1", "cm2", 0.071, 1e-3, 1e2},  // a1 ... a4
                  {"outlet_2", "cm2", 0.057, 1e-3, 1e2},  //
                  {"outlet_3", "cm2", 0.071, 1e-3, 1e2},  //
                  {"outlet_4", "cm2", 0.057, 1e-3, 1e2},  //
                  {"pump_1", "cm3/(V s)", 3.33, 0.0, 1e3}, {"pump_2", "cm3/(V s)", 3.35, 0.0, 1e3},
                  {"split_1", "-", 0.70, 0.0, 1.0},  // gamma1
                  {"split_2", "-", 0.60, 0.0, 1.0}};
  return p;
}

class FourTanks final : public arena::ArenaPlant {
 public:
  explicit FourTanks(const fpc::PlantParameters& given) : ArenaPlant(describe(), given) {}
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override {
    double out[4];
    for (Eigen::Index i = 0; i < 4; ++i)
      out[i] = p_[2 + i] * std::sqrt(kTwoGravity * std::max(x[i], 0.0));
    const double q1 = p_[6] * u[0], q2 = p_[7] * u[1];
    dxdt[0] = (out[2] - out[0] + p_[8] * q1 + d[0]) / p_[0];
    dxdt[1] = (out[3] - out[1] + p_[9] * q2 + d[1]) / p_[1];
    dxdt[2] = ((1.0 - p_[9]) * q2 - out[2]) / p_[0];
    dxdt[3] = ((1.0 - p_[8]) * q1 - out[3]) / p_[1];
  }
};

const bool kRegistered = arena::registered<FourTanks>("four_tanks");

}  // namespace
