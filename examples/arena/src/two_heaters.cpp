// Two heaters side by side that lose heat to the air and to each other, by convection and
// radiation. Their thermometers are slow and late: sensors.T1, sensors.T2 of the loop file.
//
//   m cp dT1/dt = U A (Ta - T1) + eps s A (Ta^4 - T1^4) + x + alpha1 Q1
//   m cp dT2/dt = U A (Ta - T2) + eps s A (Ta^4 - T2^4) - x + alpha2 Q2
//   x = U As (T2 - T1) + eps s As (T2^4 - T1^4)
//
// Source: hedengren2019, the temperature control laboratory.
#include "arena_plant.hpp"

#include <cmath>

namespace {

using fpc::Vector;
using fpc::VectorRef;

constexpr double kZero = 273.15, kStefanBoltzmann = 5.67e-8;

fpc::PlantDescription describe() {
  fpc::PlantDescription p;
  p.name = "two_heaters";
  p.title = "Two heaters with radiation, slow thermometers (hedengren2019)";
  p.time_unit_s = 1.0;
  p.states = {{"T1", "degC", 47.12882550447416, -50.0, 200.0},
              {"T2", "degC", 42.81861391911858, -50.0, 200.0}};
  p.inputs = {{"Q1", "%", 40.0, 0.0, 100.0}, {"Q2", "%", 40.0, 0.0, 100.0}};
  p.disturbances = {{"Ta", "degC", 23.0, -20.0, 60.0}};
  p.hidden_disturbances = {"Ta"};
  p.outputs = {"T1", "T2"};
  p.parameters = {{"mass", "kg", 0.004, 1e-5, 1e3},
                  {"heat_capacity", "J/(kg K)", 500.0, 1.0, 1e5},
                  {"transfer", "W/(m2 K)", 10.0, 0.0, 1e4},  // U
                  {"area", "m2", 1e-3, 1e-7, 1e2},           // A
                  {"area_between", "m2", 2e-4, 0.0, 1e2},    // As
                  {"emissivity", "-", 0.9, 0.0, 1.0},        // eps
                  {"heater_1", "W/%", 0.01, 0.0, 1e3},       // alpha1
                  {"heater_2", "W/%", 0.0075, 0.0, 1e3}};    // alpha2
  return p;
}

class TwoHeaters final : public arena::ArenaPlant {
 public:
  explicit TwoHeaters(const fpc::PlantParameters& given) : ArenaPlant(describe(), given) {}
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override {
    const double between = flow(p_[4], x[0], x[1]), content = p_[0] * p_[1];
    dxdt[0] = (flow(p_[3], x[0], d[0]) + between + p_[6] * u[0]) / content;
    dxdt[1] = (flow(p_[3], x[1], d[0]) - between + p_[7] * u[1]) / content;
  }

 private:
  /// Heat [W] through an area from what is at `from` to what is at `to` [degC].
  double flow(double area, double to, double from) const {
    return area * (p_[2] * (from - to) + p_[5] * kStefanBoltzmann *
                                             (std::pow(from + kZero, 4) - std::pow(to + kZero, 4)));
  }
};

const bool kRegistered = arena::registered<TwoHeaters>("two_heaters");

}  // namespace
