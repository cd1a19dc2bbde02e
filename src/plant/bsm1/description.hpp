// Names, units, ranges and usual values of BSM1 in its three forms. Private to the room.
#pragma once

#include "fmbpc/plant/plant.hpp"
#include "plant/bsm1/local_loops.hpp"

namespace fpc::bsm1 {

/// What the exchange's inputs are: the valves themselves, setpoints of the local loops, or one
/// degree of aeration that sets the oxygen setpoints.
enum class Front { kValves, kSetpoints, kAir };

/// Oxygen setpoint of an aerated tank: offset + slope * air, kept within its limits [g/m3].
struct AirLine {
  double offset{}, slope{}, lower{}, upper{};
};

/// How the nitrate setpoint leans on the oxygen setpoint of tank 4: less recirculation, which mixes
/// the tanks, while much air is asked for. Setpoint + slope (DO4 - about) [g/m3].
struct NitrateLean {
  double slope{0.0}, about{2.6};
};

/// All that a loop file may change.
struct Parameters {
  WorksParams works;
  LocalLoopParams loops;
  std::array<AirLine, kAerated> air{AirLine{0.18, 1.87, 0.05, 2.24}, AirLine{2.5, 2.04, 0.65, 5.34},
                                    AirLine{0.42, 1.15, 0.05, 4.3}};
  NitrateLean nitrate_lean;
  double lags{1.0};
  double noise_seed{1.0};
};

PlantDescription describe(Front front);
/// @throws InputError on an unknown name or a value out of range.
Parameters readParameters(Front front, const PlantDescription& description,
                          const PlantParameters& given);
/// The state at rest under constant influent and the nominal inputs.
WorksState nominalState(Front front, const LocalLoopParams& loops);

}  // namespace fpc::bsm1
