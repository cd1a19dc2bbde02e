// Acid, buffer and base meet in a tank; the base is moved to hold the pH of what leaves. Its gain
// changes twentyfold along the titration curve, which the unmeasured buffer bends.
//
//   A dh/dt = q1 + q2 + q3 - Cv (h + z)^n
//   A h dWa/dt = q1 (Wa1 - Wa) + q2 (Wa2 - Wa) + q3 (Wa3 - Wa),   Wb likewise
//   0 = Wa + 10^(pH - 14) - 10^-pH + Wb (1 + 2 10^(pH - pK2)) / (1 + 10^(pK1 - pH) + 10^(pH - pK2))
//
// Source: henson1994. Wa and Wb [mmol/l] are reaction invariants: charge and carbonate.
#include "arena_plant.hpp"

#include <algorithm>
#include <cmath>

namespace {

using fpc::Vector;
using fpc::VectorRef;

// Acid, buffer, base [mmol/l].
constexpr double kCharge[3] = {3.0, -30.0, -3.05};
constexpr double kCarbonate[3] = {0.0, 30.0, 0.05};
constexpr double kFlow[3] = {16.6, 0.55, 15.6};  // at rest [ml/s]
constexpr double kOffset = 11.5, kExponent = 0.607, kValve = 4.59;

double mixed(const double (&content)[3]) {
  double sum = 0.0, flow = 0.0;
  for (int i = 0; i < 3; ++i) {
    sum += kFlow[i] * content[i];
    flow += kFlow[i];
  }
  return sum / flow;
}

/// The root of an increasing function of pH, by bisection.
double solvePh(double wa, double wb, double pk1, double pk2) {
  const auto balance = [&](double ph) {
    const double up = std::pow(10.0, ph - pk2);
    return 1e-3 * wa + std::pow(10.0, ph - 14.0) - std::pow(10.0, -ph) +
           1e-3 * wb * (1.0 + 2.0 * up) / (1.0 + std::pow(10.0, pk1 - ph) + up);
  };
  double lower = 0.0, upper = 14.0;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (lower + upper);
    (balance(middle) > 0.0 ? upper : lower) = middle;
  }
  return 0.5 * (lower + upper);
}

fpc::PlantDescription describe() {
  const double flow = kFlow[0] + kFlow[1] + kFlow[2];
  fpc::PlantDescription p;
  p.name = "ph_neutralisation";
  p.title = "Neutralisation of an acid, pH of the outflow (henson1994)";
  p.time_unit_s = 1.0;
  p.states = {{"h", "cm", std::pow(flow / kValve, 1.0 / kExponent) - kOffset, 1.0, 40.0},
              {"Wa", "mmol/l", mixed(kCharge), -30.0, 30.0},
              {"Wb", "mmol/l", mixed(kCarbonate), 0.0, 30.0}};
  p.inputs = {{"q3", "ml/s", kFlow[2], 0.0, 30.0}};
  p.disturbances = {{"q1", "ml/s", kFlow[0], 5.0, 30.0}, {"q2", "ml/s", kFlow[1], 0.0, 5.0}};
  p.hidden_disturbances = {"q1", "q2"};
  p.algebraic = {{"pH", "-", solvePh(mixed(kCharge), mixed(kCarbonate), 6.35, 10.25), 0.0, 14.0}};
  p.outputs = {"pH"};
  p.parameters = {{"area", "cm2", 207.0, 1.0, 1e5},
                  {"valve", "ml/(s cm^0.607)", kValve, 0.1, 1e3},
                  {"acid", "mmol/l", kCharge[0], 0.1, 30.0},
                  {"buffer", "mmol/l", -kCharge[1], 0.0, 300.0},  // of sodium bicarbonate
                  {"base", "mmol/l", -kCharge[2], 0.1, 30.0},
                  {"base_carbonate", "mmol/l", kCarbonate[2], 0.0, 30.0},
                  {"pk_1", "-", 6.35, 1.0, 13.0},
                  {"pk_2", "-", 10.25, 1.0, 13.0}};
  return p;
}

class PhNeutralisation final : public arena::ArenaPlant {
 public:
  explicit PhNeutralisation(const fpc::PlantParameters& given) : ArenaPlant(describe(), given) {}
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override {
    const double level = std::max(x[0], 1e-3), held = p_[0] * level;
    dxdt[0] = (d[0] + d[1] + u[0] - p_[1] * std::pow(level + kOffset, kExponent)) / p_[0];
    dxdt[1] = (d[0] * (p_[2] - x[1]) + d[1] * (-p_[3] - x[1]) + u[0] * (-p_[4] - x[1])) / held;
    dxdt[2] = (-d[0] * x[2] + d[1] * (p_[3] - x[2]) + u[0] * (p_[5] - x[2])) / held;
  }
  void algebraic(VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> y) const override {
    y[0] = solvePh(x[1], std::max(x[2], 0.0), p_[6], p_[7]);
  }
};

const bool kRegistered = arena::registered<PhNeutralisation>("ph_neutralisation");

}  // namespace
