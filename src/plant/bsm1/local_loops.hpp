// The benchmark's default control in continuous time, as part of the plant's differential
// equations: three oxygen loops on the blowers, one nitrate loop on the internal recirculation,
// with their analysers and the blowers' lags. Private to the room.
//
//   u = K e + I + u0,   dI/dt = K/Ti e + (sat(u) - u)/Tt,   e = setpoint - shown
//
// The nitrate setpoint may follow the nitrate of the last tank: setpoint + slope (S_NO5 - 12).
//
// Source: alex2008: class A sensor (oxygen), class B0 (nitrate), tables of the default
// controllers.
#pragma once

#include <array>

#include "plant/bsm1/works.hpp"

namespace fpc::bsm1 {

struct LocalPi {
  double K{}, Ti{}, Tt{}, u0{};  ///< Ti, Tt [d]
  double upper{};                ///< of the manipulated variable; the lower bound is 0
  double range{};                ///< of the analyser, from 0
};

constexpr int kAerated = 3;
constexpr int kOxygenLags = 2, kNitrateLags = 8, kBlowerLags = 2;
/// States of one oxygen loop: analyser, blower, integral. Of the nitrate loop: analyser, pump,
/// integral.
constexpr int kOxygenStates = kOxygenLags + kBlowerLags + 1;
constexpr int kNitrateStates = kNitrateLags + 2;
constexpr int kLoopStates = kAerated * kOxygenStates + kNitrateStates + kNitrateLags;
using LoopStates = std::array<double, kLoopStates>;

/// All that moves: tanks and settler, and the local loops if there are any.
struct WorksState {
  TankTable z{};
  SettlerState settler{};
  LoopStates loops{};
};

/// Setpoints [g/m3] of S_O in tanks 3, 4, 5 and of S_NO in tank 2.
struct LoopSetpoints {
  std::array<double, kAerated> S_O{};
  double S_NO{};
};

/// How the nitrate setpoint leans on the nitrate at the outlet, within limits [g/m3].
struct NitrateSlope {
  double slope{0.0}, about{12.0}, lower{0.05}, upper{12.0};
};

struct LocalLoopParams {
  std::array<LocalPi, kAerated> oxygen{LocalPi{25.0, 0.002, 0.001, 144.0, 240.0, 10.0},
                                       LocalPi{25.0, 0.002, 0.001, 144.0, 240.0, 10.0},
                                       LocalPi{25.0, 0.002, 0.001, 144.0, 240.0, 10.0}};
  LocalPi nitrate{10000.0, 0.025, 0.015, 18500.0, 92230.0, 20.0};
  NitrateSlope outlet;
  bool lags{true};    ///< false: ideal analysers and blowers
  double noise{0.0};  ///< standard deviation of the analysers' noise, share of their range
};

/// Noise on what the five analysers show, standard normal numbers, held between renewals.
using LoopNoise = std::array<double, kAerated + 2>;

/// Positions of the states of oxygen loop i and of the nitrate loop.
constexpr int oxygenShown(int i) { return i * kOxygenStates + kOxygenLags - 1; }
constexpr int blower(int i) { return i * kOxygenStates + kOxygenLags + kBlowerLags - 1; }
constexpr int kNitrateFirst = kAerated * kOxygenStates;
constexpr int kPump = kNitrateFirst + kNitrateLags;
constexpr int kOutletFirst = kPump + 2;  // the outlet's nitrate analyser

/// d/dt of the loops' states, and the actuators' present positions written into `in`.
/// @param capacity share of the blowers' upper bounds that is at hand.
void localLoops(const LocalLoopParams& p, const LoopSetpoints& setpoints, const LoopNoise& noise,
                double capacity, const TankTable& z, const LoopStates& c, Inflow& in,
                LoopStates& dcdt);
/// Loops that rest at these tanks, setpoints and positions of blowers and pump.
LoopStates restingLoops(const LocalLoopParams& p, const LoopSetpoints& setpoints,
                        const std::array<double, kAerated>& KLa, double Q_intr, const TankTable& z);

}  // namespace fpc::bsm1
