// All instruments of a plant: a drive behind each input that follows its command late, a sensor
// before each measured signal that has one.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fmbpc/base/types.hpp"
#include "plant/sensor.hpp"

namespace fpc {

struct InstrumentParams {
  std::map<std::string, SensorParams> sensors;  ///< by measured output or disturbance
  double step_s{60.0};  ///< instruments are moved so often between samples of the exchange
  std::uint64_t seed{1};
};

/// A drive of equal lags behind a stem that sticks and a gear with play. T90 0: follows at once.
struct DriveParams {
  int order{2};
  double t90_s{0.0};
  double backlash{0.0};  ///< width of the play: so far a command turns before the drive follows
  double stiction{0.0};  ///< the drive stands until the command is farther off, then slips to it
};

class Instruments {
 public:
  Instruments() = default;
  /// `outputs`, `disturbances`: the measured ones; `drives` empty or one per input.
  /// @throws InputError naming the field.
  Instruments(const InstrumentParams& params, const std::vector<DriveParams>& drives,
              const std::vector<std::string>& outputs, const std::vector<std::string>& disturbances,
              double sample_time_s);
  /// Steps of a sample: 1 if there is nothing to move in between.
  int steps() const { return steps_; }
  double stepSeconds() const { return step_s_; }
  /// All have rested at these: measured outputs and disturbances, inputs.
  void reset(VectorRef y, VectorRef d, VectorRef u);
  /// Mean position of the drives over the next step under this command.
  const Vector& drive(VectorRef command);
  /// The measured signals after a step; disturbances were held over it.
  void advance(VectorRef y, VectorRef d);
  /// What the sensors show in place of the true values, where there are sensors. Call once a
  /// sample.
  void read(Eigen::Ref<Vector> y, Eigen::Ref<Vector> d);
  /// Takes away the readings that are lost at this sample. Call once a sample.
  void lose(Eigen::Ref<Vector> y, Eigen::Ref<Vector> d);
  bool hasSensor(Eigen::Index output) const {
    return !outputs_.empty() && outputs_[static_cast<std::size_t>(output)].has_value();
  }

 private:
  std::vector<std::optional<Sensor>> outputs_, disturbances_;
  std::vector<std::optional<LagChain>> drives_;
  std::vector<double> play_;           // to either side, one per drive
  std::vector<double> stick_;          // one per drive
  Vector y_, stem_, gear_, position_;  // stem_: what sticks; gear_: behind the play
  int steps_{1};
  double step_s_{};
};

}  // namespace fpc
