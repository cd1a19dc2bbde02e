#include "plant/bsm1/local_loops.hpp"

#include <algorithm>

namespace fpc::bsm1 {
namespace {

constexpr double kMinute = 1.0 / 1440.0;
// Rates of one lag of a chain [1/d].
constexpr double kOxygenLag = 3.89 / kMinute;               // class A: T90 1 min, two lags
constexpr double kNitrateLag = 11.7724 / (10.0 * kMinute);  // class B0: T90 10 min, eight lags
constexpr double kBlowerLag = 3.89 / (4.0 * kMinute);       // T90 4 min, two lags
constexpr double kPumpLag = 1e4;  // only makes the pump's position a state; no lag that counts

/// Equal lags in a row, `rate` the inverse of one time constant [1/d].
void chain(const double* x, int count, double input, double rate, double* dxdt) {
  dxdt[0] = rate * (input - x[0]);
  for (int i = 1; i < count; ++i) dxdt[i] = rate * (x[i - 1] - x[i]);
}

/// One loop's command within its bounds.
double command(const LocalPi& pi, double setpoint, double shown, double upper, double integral,
               double& integral_rate) {
  const double e = setpoint - std::clamp(shown, 0.0, pi.range);
  const double u = pi.K * e + integral + pi.u0;
  const double within = std::clamp(u, 0.0, upper);
  integral_rate = pi.K / pi.Ti * e + (within - u) / pi.Tt;
  return within;
}

/// The nitrate setpoint in force.
double nitrateSetpoint(const NitrateSlope& outlet, double asked, double shown) {
  if (outlet.slope == 0.0) return asked;
  return std::clamp(asked + outlet.slope * (shown - outlet.about), outlet.lower, outlet.upper);
}

}  // namespace

void localLoops(const LocalLoopParams& p, const LoopSetpoints& setpoints, const LoopNoise& noise,
                double capacity, const TankTable& z, const LoopStates& c, Inflow& in,
                LoopStates& dcdt) {
  for (int i = 0; i < kAerated; ++i) {
    const LocalPi& pi = p.oxygen[i];
    const int sensor = i * kOxygenStates, drive = sensor + kOxygenLags, integral = blower(i) + 1;
    const double S_O = z[kSO][kFirstAerated + i];
    const double shown = (p.lags ? c[oxygenShown(i)] : S_O) + p.noise * pi.range * noise[i];
    const double u =
        command(pi, setpoints.S_O[i], shown, capacity * pi.upper, c[integral], dcdt[integral]);
    chain(&c[sensor], kOxygenLags, S_O, p.lags ? kOxygenLag : kPumpLag, &dcdt[sensor]);
    chain(&c[drive], kBlowerLags, u, p.lags ? kBlowerLag : kPumpLag, &dcdt[drive]);
    in.KLa[kFirstAerated + i] = p.lags ? c[blower(i)] : u;
  }
  const double S_NO = z[kSNO][1];
  const double noisy = p.noise * p.nitrate.range;
  const double shown = (p.lags ? c[kPump - 1] : S_NO) + noisy * noise[kAerated];
  const double S_NO5 = z[kSNO][kTanks - 1];
  const double outlet = (p.lags ? c[kLoopStates - 1] : S_NO5) + noisy * noise[kAerated + 1];
  in.Q_intr = command(p.nitrate, nitrateSetpoint(p.outlet, setpoints.S_NO, outlet), shown,
                      p.nitrate.upper, c[kPump + 1], dcdt[kPump + 1]);
  chain(&c[kOutletFirst], kNitrateLags, S_NO5, p.lags ? kNitrateLag : kPumpLag,
        &dcdt[kOutletFirst]);
  chain(&c[kNitrateFirst], kNitrateLags, S_NO, p.lags ? kNitrateLag : kPumpLag,
        &dcdt[kNitrateFirst]);
  dcdt[kPump] = kPumpLag * (in.Q_intr - c[kPump]);
}

LoopStates restingLoops(const LocalLoopParams& p, const LoopSetpoints& setpoints,
                        const std::array<double, kAerated>& KLa, double Q_intr,
                        const TankTable& z) {
  // With u = sat(u) + Tt K/Ti e the integral stands still, at a bound as well as inside.
  const auto integral = [](const LocalPi& pi, double position, double e) {
    return position + pi.Tt * pi.K / pi.Ti * e - pi.K * e - pi.u0;
  };
  LoopStates c{};
  for (int i = 0; i < kAerated; ++i) {
    const int sensor = i * kOxygenStates;
    const double S_O = z[kSO][kFirstAerated + i];
    std::fill_n(&c[sensor], kOxygenLags, S_O);
    std::fill_n(&c[sensor + kOxygenLags], kBlowerLags, KLa[i]);
    c[blower(i) + 1] = integral(p.oxygen[i], KLa[i], setpoints.S_O[i] - S_O);
  }
  std::fill_n(&c[kNitrateFirst], kNitrateLags, z[kSNO][1]);
  std::fill_n(&c[kOutletFirst], kNitrateLags, z[kSNO][kTanks - 1]);
  c[kPump] = Q_intr;
  c[kPump + 1] = integral(p.nitrate, Q_intr, setpoints.S_NO - z[kSNO][1]);
  return c;
}

}  // namespace fpc::bsm1
