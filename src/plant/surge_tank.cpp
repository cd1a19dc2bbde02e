// Surge tank: a pump behind a valve with a lag fills it, its level H drives the outflow, which
// stops where the level falls below that of the outlet channel.
//
//   dQ/dt   = -k0 Q + k1 max(I, 0)                          flow of the pump, which cannot reverse
//   A dH/dt = Q + q_f - Q_s,   Q_s = 0.6 a sqrt(2 g max(H - Hs, 0))
//
// The source defines the tank by the Euler step of these equations, Te = 0.1 s. By that a current
// moves the level only after two samples (b1 = 0), which no continuous tank does; so the Euler step
// is what moves this plant unless difference_step is 0, which hands the equations to CVODE.
//
// Source: taieb2017, eqs. 21, 22, table 2; eq. 22 with the
// area A that it lacks. The rest at 0.15 m needs Q = 9.765e-5 m3/s, not the Q0 of table 2.
#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/plant/plant.hpp"

namespace fpc {
namespace {

constexpr double kGravity = 9.81;  // [m/s2]

PlantDescription describeSurgeTank() {
  PlantDescription p;
  p.name = "surge_tank";
  p.title = "Surge tank filled by a pump, level and pump flow (taieb2017)";
  p.states = {{"H", "m", 0.15, 0.0, 10.0}, {"Q", "m3/s", 9.764896312813569e-5, 0.0, 1.0}};
  p.inputs = {{"I", "A", 9.764896312813569e-4, 0.0, 1.0}};
  p.disturbances = {{"q_f", "m3/s", 0.0, -1e-3, 1e-3}};
  p.hidden_disturbances = {"q_f"};
  p.outputs = {"H"};
  p.parameters = {
      {"tank_area", "m2", 0.04, 1e-6, 1e6},       // A
      {"outlet_area", "m2", 1e-4, 0.0, 1e3},      // a
      {"outlet_level", "m", 0.015, 0.0, 1e3},     // Hs
      {"discharge", "-", 0.6, 0.0, 1.0},          //
      {"pump_rate", "1/s", 1.0, 0.0, 1e3},        // k0
      {"pump_gain", "m3/(s2 A)", 0.1, 0.0, 1e3},  // k1
      {"difference_step", "s", 0.1, 0.0, 1e3},    // Te; 0: continuous
  };
  p.frames = {{"plant", "map", 0.0, 0.0, 0.0},
              {"tank", "plant", 0.0, 0.0, 0.0},
              {"pump", "plant", -1.0, 0.0, 0.0},
              {"level_gauge", "tank", 0.1, 0.0, 0.0},
              {"flow_meter", "pump", 0.3, 0.0, 0.0}};
  p.output_frames = {{"H", "level_gauge"}, {"Q", "flow_meter"}};
  return p;
}

class SurgeTank final : public Plant {
 public:
  explicit SurgeTank(const PlantParameters& parameters);
  const PlantDescription& description() const override { return description_; }
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override;
  std::unique_ptr<PlantStepper> makeStepper(double sample_time_s) const override;

 private:
  PlantDescription description_;
  double A_, a_, Hs_, discharge_, k0_, k1_, step_;
};

SurgeTank::SurgeTank(const PlantParameters& parameters) : description_(describeSurgeTank()) {
  const Vector p = parameterValues(description_, parameters);
  Eigen::Index i = 0;
  for (double* value : {&A_, &a_, &Hs_, &discharge_, &k0_, &k1_, &step_}) *value = p[i++];
  require(step_ * k0_ <= 1.0, "plant.parameters.difference_step",
          "at most 1 / pump_rate: a longer Euler step would reverse the pump");
}

void SurgeTank::derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const {
  const double outflow = discharge_ * a_ * std::sqrt(2.0 * kGravity * std::max(x[0] - Hs_, 0.0));
  dxdt[0] = (x[1] + d[0] - outflow) / A_;
  dxdt[1] = -k0_ * x[1] + k1_ * std::max(u[0], 0.0);
}

/// The difference equation of the source: Euler steps, both equations from the old state.
class EulerStepper final : public PlantStepper {
 public:
  EulerStepper(const SurgeTank& tank, double step_s, int steps)
      : tank_(tank), step_(step_s), steps_(steps) {}
  void reset(VectorRef, VectorRef) override {}
  bool remembers() const override { return false; }
  bool divisible() const override { return false; }
  void advance(Eigen::Ref<Vector> x, VectorRef u, VectorRef d) override {
    for (int i = 0; i < steps_; ++i) {
      tank_.derivatives(x, u, d, rate_);
      x = (x + step_ * rate_).cwiseMax(0.0);  // the level does not fall below the floor
    }
  }

 private:
  const SurgeTank& tank_;
  Vector rate_ = Vector::Zero(2);
  double step_;
  int steps_;
};

std::unique_ptr<PlantStepper> SurgeTank::makeStepper(double sample_time_s) const {
  if (step_ <= 0.0) return nullptr;
  const double steps = std::round(sample_time_s / step_);
  require(steps >= 1.0 && steps <= 1e6 && std::abs(steps * step_ - sample_time_s) < 1e-9 * steps,
          "plant.parameters.difference_step", "a whole part of the sample time, or 0");
  return std::make_unique<EulerStepper>(*this, step_, static_cast<int>(steps));
}

const bool kSurgeTankRegistered = registerPlant(
    "surge_tank",
    [](const PlantParameters& parameters) { return std::make_unique<SurgeTank>(parameters); });

}  // namespace
}  // namespace fpc
