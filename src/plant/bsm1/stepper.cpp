#include "plant/bsm1/stepper.hpp"

#include <algorithm>
#include <cmath>

#include "base/random.hpp"

namespace fpc::bsm1 {
namespace {

constexpr double kDayMinute = 1.0 / 1440.0;
constexpr double kFastStep = 1e-4;  // [d]; oxygen of the anoxic tanks has rates of 2e4 1/d
constexpr int kFastPerSettler = 4;
constexpr double kLayersPerStep =
    1.0;  // that sludge may pass in a step of the settler; 0.3 usually

/// y = x + h dx, element by element.
void move(const TankTable& x, double h, const TankTable& dx, TankTable& y) {
  for (int c = 0; c < kComponents; ++c)
    for (int t = 0; t < kWidth; ++t) y[c][t] = x[c][t] + h * dx[c][t];
}
void move(const LoopStates& x, double h, const LoopStates& dx, LoopStates& y) {
  for (int i = 0; i < kLoopStates; ++i) y[i] = x[i] + h * dx[i];
}
void move(const Layers& x, double h, const Layers& dx, Layers& y) {
  for (int i = 0; i < kLayers; ++i) y[i] = x[i] + h * dx[i];
}
void move(const SettlerState& x, double h, const SettlerState& dx, SettlerState& y) {
  move(x.solids, h, dx.solids, y.solids);
  for (std::size_t s = 0; s < kSolubles.size(); ++s)
    move(x.solubles[s], h, dx.solubles[s], y.solubles[s]);
}

/// Steps of the settler over `days`: more than one for thin layers or fast sludge.
int settlerSteps(const SettlerParams& p, const SettlerFlows& flows, double days) {
  const double speed = std::min(p.v_max, p.v_0) + flows.feed / p.area;
  return std::max(1, static_cast<int>(std::ceil(days * speed / p.layer_height / kLayersPerStep)));
}

}  // namespace

WorksStepper::WorksStepper(const WorksParams& works, const LocalLoopParams* loops,
                           std::uint64_t noise_seed)
    : works_(works), loops_(loops), seed_(noise_seed) {
  reset();
}

void WorksStepper::reset() {
  engine_.seed(seed_);
  noise_.fill(0.0);
}

void WorksStepper::fastRates(const WorksState& x, const Drive& drive, TankTable& dz,
                             LoopStates& dc) const {
  Inflow in = drive.in;
  if (loops_) localLoops(*loops_, drive.setpoints, noise_, drive.capacity, x.z, x.loops, in, dc);
  reactors(works_, in, x.z, x.settler, dz);
}

void WorksStepper::fastStep(WorksState& x, const Drive& drive, double h) {
  WorksState y = x;
  TankTable dz, sum_z{};
  LoopStates dc{}, sum_c{};
  constexpr double kWeight[] = {1.0, 2.0, 2.0, 1.0}, kNext[] = {0.5, 0.5, 1.0, 0.0};
  for (int stage = 0; stage < 4; ++stage) {
    fastRates(y, drive, dz, dc);
    move(sum_z, kWeight[stage], dz, sum_z);
    if (loops_) move(sum_c, kWeight[stage], dc, sum_c);
    if (stage == 3) break;
    move(x.z, kNext[stage] * h, dz, y.z);
    if (loops_) move(x.loops, kNext[stage] * h, dc, y.loops);
  }
  move(x.z, h / 6.0, sum_z, x.z);
  if (loops_) move(x.loops, h / 6.0, sum_c, x.loops);
}

void WorksStepper::settlerStep(WorksState& x, const SettlerFlows& flows, double h) const {
  const double feed = solids(works_, x.z, kTanks - 1);
  const auto feed_solubles = feedSolubles(x.z);
  SettlerState y = x.settler, dy, sum{};
  constexpr double kWeight[] = {1.0, 2.0, 2.0, 1.0}, kNext[] = {0.5, 0.5, 1.0, 0.0};
  for (int stage = 0; stage < 4; ++stage) {
    settle(works_.settler, flows, y, feed, feed_solubles, dy);
    move(sum, kWeight[stage], dy, sum);
    move(x.settler, kNext[stage] * h, dy, y);
  }
  move(x.settler, h / 6.0, sum, x.settler);
}

// Half of the tanks' steps before and half after the settler's: the splitting is of second order.
void WorksStepper::block(WorksState& x, const Drive& drive, double days) {
  const double h = days / kFastPerSettler;
  for (int i = 0; i < kFastPerSettler / 2; ++i) fastStep(x, drive, h);
  const SettlerFlows flows = settlerFlows(drive.in);
  const int steps = settlerSteps(works_.settler, flows, days);
  for (int i = 0; i < steps; ++i) settlerStep(x, flows, days / steps);
  for (int i = 0; i < kFastPerSettler / 2; ++i) fastStep(x, drive, h);
}

void WorksStepper::advance(WorksState& x, const Drive& drive, double days) {
  const bool noisy = loops_ && loops_->noise > 0.0;
  const double chunk = noisy ? std::min(days, kDayMinute) : days;
  const int chunks = std::max(1, static_cast<int>(std::lround(days / chunk)));
  const double length = days / chunks;
  const int blocks =
      std::max(1, static_cast<int>(std::ceil(length / (kFastPerSettler * kFastStep))));
  for (int i = 0; i < chunks; ++i) {
    if (noisy)
      for (double& n : noise_) n = standardNormal(engine_);
    for (int b = 0; b < blocks; ++b) block(x, drive, length / blocks);
  }
}

}  // namespace fpc::bsm1
