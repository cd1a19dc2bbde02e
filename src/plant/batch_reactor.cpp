// Batch reactor of a pharmaceutical plant: a stirred core (T) heated and cooled through a water
// jacket (Tw). A pump keeps the flow through the jacket constant; a mixing valve sets which share
// kM of it is fresh water, two on/off valves whether that is cold (kC) or hot (kH).
//
//   m c dT/dt = lambda_S (Tw - T)
//   m_w c_w dTw/dt = phi c_w kM k (Tin - Tw) + lambda_S (T - Tw) + ambient (T_0 - Tw)
//   k = min(1, kC + kH),  Tin = (kC T_C + kH T_H) / (kC + kH)
//
// Source: karer2007, section 5. The paper prints no physical
// parameters: those below were chosen so that the plant agrees with the models identified there
// (eqs. 35, 40, 41), so that their agreement with it proves little.
#include <algorithm>

#include "fmbpc/plant/plant.hpp"

namespace fpc {
namespace {

PlantDescription describeBatchReactor() {
  PlantDescription p;
  p.name = "batch_reactor";
  p.title = "Batch reactor with a water jacket and discrete valves (karer2007, section 5)";
  p.states = {{"T", "degC", 41.1191, 0.0, 100.0}, {"Tw", "degC", 41.1191, 0.0, 100.0}};
  p.inputs = {{"kM", "-", 0.02, 0.0, 1.0}, {"kC", "-", 0.0, 0.0, 1.0}, {"kH", "-", 1.0, 0.0, 1.0}};
  p.disturbances = {{"T_C", "degC", 12.0, 0.0, 100.0},
                    {"T_H", "degC", 75.0, 0.0, 100.0},
                    {"T_0", "degC", 20.0, -40.0, 60.0}};
  p.outputs = {"T", "Tw"};
  p.parameters = {
      {"core_heat_capacity", "J/K", 5.21028744e6, 1e3, 1e9},  // m c
      {"jacket_mass", "kg", 100.0, 0.1, 1e5},                 // m_w
      {"water_heat_capacity", "J/(kg K)", 4200.0, 1e3, 1e4},  // c_w
      {"jacket_to_core", "W/K", 1722.0, 0.0, 1e6},            // lambda S
      {"jacket_to_ambient", "W/K", 504.0, 0.0, 1e6},
      {"water_flow", "kg/s", 3.74, 0.0, 1e3},  // phi
  };
  p.frames = {
      {"reactor", "map", 0.0, 0.0, 0.0},           {"core", "reactor", 0.0, 0.0, 1.0},
      {"jacket", "reactor", 0.8, 0.0, 1.0},        {"valves", "reactor", 2.0, 0.5, 0.5},
      {"core_thermometer", "core", 0.1, 0.0, 0.4}, {"jacket_thermometer", "jacket", 0.1, 0.0, 0.6}};
  p.output_frames = {{"T", "core_thermometer"}, {"Tw", "jacket_thermometer"}};
  return p;
}

class BatchReactor final : public Plant {
 public:
  explicit BatchReactor(const PlantParameters& parameters) : description_(describeBatchReactor()) {
    const Vector p = parameterValues(description_, parameters);
    const double jacket = p[1] * p[2];  // [J/K]
    core_rate_ = p[3] / p[0];
    jacket_rate_ = p[3] / jacket;
    ambient_rate_ = p[4] / jacket;
    flow_rate_ = p[5] / p[1];
  }
  const PlantDescription& description() const override { return description_; }
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override {
    const double T = x[0], Tw = x[1];
    const double kM = u[0], kC = u[1], kH = u[2];
    // k (Tin - Tw), also where both valves are closed
    const double fresh = (kC * (d[0] - Tw) + kH * (d[1] - Tw)) / std::max(1.0, kC + kH);
    dxdt[0] = core_rate_ * (Tw - T);
    dxdt[1] = flow_rate_ * kM * fresh + jacket_rate_ * (T - Tw) + ambient_rate_ * (d[2] - Tw);
  }

 private:
  PlantDescription description_;
  double core_rate_, jacket_rate_, ambient_rate_, flow_rate_;  // [1/s]
};

const bool kBatchReactorRegistered = registerPlant(
    "batch_reactor",
    [](const PlantParameters& parameters) { return std::make_unique<BatchReactor>(parameters); });

}  // namespace
}  // namespace fpc
