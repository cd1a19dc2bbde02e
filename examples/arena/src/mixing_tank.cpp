// Hot and cold water meet in a tank of constant volume; what overflows runs as a plug through a
// pipe to the thermometer. The time in the pipe is its volume over the flow, so the dead time
// follows both flows.
//
//   V dT/dt = h (Th - T) + c (Tc - T)
//   Tm(t) = T(t - D(t)),   the integral of h + c over [t - D, t] is the volume of the pipe
//
// Source: zenger2009 (ideal mixer and plug flow in series). Flows are held over a sample: T is then
// an exponential in it, and the plant is moved exactly.
#include "arena_plant.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

namespace {

using fpc::Vector;
using fpc::VectorRef;

fpc::PlantDescription describe() {
  fpc::PlantDescription p;
  p.name = "mixing_tank";
  p.title = "Mixing tank, the dead time of its thermometer follows the flow (zenger2009)";
  p.time_unit_s = 1.0;
  p.states = {{"T", "degC", 35.0, 0.0, 100.0}, {"Tm", "degC", 35.0, 0.0, 100.0}};
  p.inputs = {{"h", "l/s", 0.5, 0.05, 2.0}};
  p.disturbances = {{"c", "l/s", 0.5, 0.1, 2.0},
                    {"Th", "degC", 60.0, 30.0, 95.0},
                    {"Tc", "degC", 10.0, 0.0, 30.0}};
  p.hidden_disturbances = {"Th", "Tc"};
  p.outputs = {"Tm"};
  p.parameters = {{"tank_volume", "l", 40.0, 0.1, 1e5}, {"pipe_volume", "l", 40.0, 0.0, 1e5}};
  return p;
}

/// Temperature in the tank under flows that are held.
struct Piece {
  double volume{};        // that has left the tank before it [l]
  double flow{};          // [l/s]
  double start{}, end{};  // temperature at its beginning, and where it would settle [degC]
  double rate{};          // [1/s]
  double at(double left) const {
    return end + (start - end) * std::exp(-rate * std::max(left - volume, 0.0) / flow);
  }
};

class Stepper final : public fpc::PlantStepper {
 public:
  Stepper(double tank, double pipe, double sample_time_s)
      : tank_(tank), pipe_(pipe), sample_time_s_(sample_time_s) {}
  void reset(VectorRef, VectorRef) override {
    pieces_.clear();
    left_ = 0.0;
  }
  void advance(Eigen::Ref<Vector> x, VectorRef u, VectorRef d) override {
    const double hot = std::max(u[0], 1e-6), cold = std::max(d[0], 1e-6), flow = hot + cold;
    if (pieces_.empty()) pieces_.push_back({-pipe_, flow, x[0], x[0], 0.0});  // it has rested
    pieces_.push_back({left_, flow, x[0], (hot * d[1] + cold * d[2]) / flow, flow / tank_});
    left_ += flow * sample_time_s_;
    x[0] = pieces_.back().at(left_);
    const double shown = left_ - pipe_;
    while (pieces_.size() > 1 && pieces_[1].volume <= shown) pieces_.pop_front();
    x[1] = pieces_.front().at(shown);
  }

 private:
  double tank_, pipe_, sample_time_s_;
  std::deque<Piece> pieces_;
  double left_{};  // volume that has left the tank since reset [l]
};

class MixingTank final : public arena::ArenaPlant {
 public:
  explicit MixingTank(const fpc::PlantParameters& given) : ArenaPlant(describe(), given) {}
  /// The pipe as a lag of its mean stay: the same steady states.
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override {
    dxdt[0] = (u[0] * (d[1] - x[0]) + d[0] * (d[2] - x[0])) / p_[0];
    dxdt[1] = (u[0] + d[0]) * (x[0] - x[1]) / std::max(p_[1], 1e-3);
  }
  std::unique_ptr<fpc::PlantStepper> makeStepper(double sample_time_s) const override {
    return std::make_unique<Stepper>(p_[0], p_[1], sample_time_s);
  }
};

const bool kRegistered = arena::registered<MixingTank>("mixing_tank");

}  // namespace
