// What an instrument makes of the quantity it measures: lags, a dead time, samples of its own,
// noise, a range, and the fault of standing still.
//
// Source of the classes: rieger2003,
// alex2008.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "plant/lag_chain.hpp"

namespace fpc {

struct SensorParams {
  int lags{0};             ///< equal lags in a row; 0: shows at once
  double lag_s{0.0};       ///< time constant of each
  double delay_s{0.0};     ///< dead time behind the lags
  double interval_s{0.0};  ///< takes a sample so often and shows it until the next; 0: always
  double noise_std{0.0};   ///< of what it shows
  double resolution{0.0};  ///< shows multiples of it only; 0: every number
  double lower{-std::numeric_limits<double>::infinity()};
  double upper{std::numeric_limits<double>::infinity()};
  double lost{0.0};     ///< probability that a sample of the exchange has no reading
  bool average{false};  ///< the exchange sees the mean of what it showed since the last sample
  double stuck_from_h{std::numeric_limits<double>::infinity()};  ///< shows its last value ...
  double stuck_to_h{std::numeric_limits<double>::infinity()};    ///< ... until then
  void validate() const;  ///< @throws InputError naming the field
};

enum class SensorClass { kA, kB0, kB1, kC0, kC1, kD };
/// A class's lags, interval and dead time.
SensorParams sensorOfClass(SensorClass kind, double lower, double upper);

/// One instrument. Time passes in steps; all its noise comes from its own engine.
class Sensor {
 public:
  /// @param step_s the longest step that will be asked for. @throws InputError as validate().
  Sensor(const SensorParams& params, double step_s, std::uint64_t seed, std::uint64_t stream);
  /// Has rested at this value.
  void reset(double value);
  /// The quantity goes in a straight line from `from` to `to` in `seconds`.
  void advance(double from, double to, double seconds);
  /// What the exchange sees now: noise and range included. Ends the averaging interval.
  double take();
  bool loses();  ///< whether the reading of this sample is lost; call once a sample

 private:
  void show();
  double delayed(double value, double seconds);

  SensorParams params_;
  std::uint64_t seed_, stream_;
  std::optional<LagChain> chain_;
  std::mt19937_64 engine_, lost_;
  std::vector<double> line_;  // past values for the dead time, one per step
  std::size_t next_{};
  double step_s_, time_s_{}, due_s_{}, shown_{}, reading_{}, sum_{};
  std::size_t count_{};
};

}  // namespace fpc
