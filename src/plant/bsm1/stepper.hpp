// Fixed-step motion of BSM1: Runge-Kutta of fourth order, tanks and local loops at 1e-4 d, the
// slower settler every four of these steps. Private to the room.
#pragma once

#include <random>

#include "plant/bsm1/local_loops.hpp"

namespace fpc::bsm1 {

/// What holds over one call.
struct Drive {
  Inflow in;
  LoopSetpoints setpoints;
  double capacity{1.0};
};

class WorksStepper {
 public:
  /// Keeps references. `loops` nullptr: KLa and Q_intr are what Drive says.
  WorksStepper(const WorksParams& works, const LocalLoopParams* loops, std::uint64_t noise_seed);
  void reset();
  /// Moves x over `days`. Noise of the loops' analysers is renewed at the start of each minute.
  void advance(WorksState& x, const Drive& drive, double days);

 private:
  void block(WorksState& x, const Drive& drive, double days);
  void fastStep(WorksState& x, const Drive& drive, double h);
  void fastRates(const WorksState& x, const Drive& drive, TankTable& dz, LoopStates& dc) const;
  void settlerStep(WorksState& x, const SettlerFlows& flows, double h) const;

  const WorksParams& works_;
  const LocalLoopParams* loops_;
  std::uint64_t seed_;
  std::mt19937_64 engine_;
  LoopNoise noise_{};
};

}  // namespace fpc::bsm1
