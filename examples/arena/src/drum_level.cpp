// Level of a steam drum: feed water integrates, and first shrinks the bubbles, so the level begins
// the wrong way; steam that is drawn swells them.
//
//   dm/dt  = K (q - w)
//   dzq/dt = (q - q0 - zq) / tau,   dzw/dt = (w - w0 - zw) / tau
//   level  = m - K (tau + beta) (zq - zw)
//
// From feed water q to the level that is K (1 - beta s) / (s (tau s + 1)); its dead time is that of
// the gauge (sensors.level.delay_s). Source: luyben2003, the boiler drum; that steam does the
// opposite of feed water is an addition. Level and flows are deviations, in % of their ranges.
#include "arena_plant.hpp"

namespace {

using fpc::Vector;
using fpc::VectorRef;

fpc::PlantDescription describe() {
  fpc::PlantDescription p;
  p.name = "drum_level";
  p.title = "Level of a steam drum: integrator with inverse response (luyben2003)";
  p.time_unit_s = 60.0;
  p.states = {{"mass", "%", 0.0, -1e3, 1e3},
              {"shrink", "%", 0.0, -1e3, 1e3},
              {"swell", "%", 0.0, -1e3, 1e3}};
  p.inputs = {{"feed", "%", 50.0, 0.0, 100.0}};
  p.disturbances = {{"steam", "%", 50.0, 0.0, 100.0}};
  p.hidden_disturbances = {"steam"};
  p.algebraic = {{"level", "%", 0.0, -100.0, 100.0}};
  p.outputs = {"level"};
  p.parameters = {{"gain", "1/min", 0.547, 1e-3, 1e3},   // K
                  {"lag", "min", 1.06, 1e-3, 1e3},       // tau
                  {"inverse", "min", 0.418, 0.0, 1e3}};  // beta
  return p;
}

class DrumLevel final : public arena::ArenaPlant {
 public:
  explicit DrumLevel(const fpc::PlantParameters& given) : ArenaPlant(describe(), given) {}
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override {
    dxdt[0] = p_[0] * (u[0] - d[0]);
    dxdt[1] = (u[0] - description_.inputs[0].nominal - x[1]) / p_[1];
    dxdt[2] = (d[0] - description_.disturbances[0].nominal - x[2]) / p_[1];
  }
  void algebraic(VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> y) const override {
    y[0] = x[0] - p_[0] * (p_[1] + p_[2]) * (x[1] - x[2]);
  }
};

const bool kRegistered = arena::registered<DrumLevel>("drum_level");

}  // namespace
