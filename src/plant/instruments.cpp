#include "plant/instruments.hpp"

#include <algorithm>
#include <cmath>

#include "base/no_value.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using Sensors = std::vector<std::optional<Sensor>>;

void requireKnown(const InstrumentParams& params, const std::vector<std::string>& outputs,
                  const std::vector<std::string>& disturbances) {
  std::vector<std::string> known = outputs;
  known.insert(known.end(), disturbances.begin(), disturbances.end());
  for (const auto& sensor : params.sensors)
    require(std::find(known.begin(), known.end(), sensor.first) != known.end(),
            "sensors." + sensor.first, "one of " + join(known));
}

Sensors sensorsOf(const InstrumentParams& params, const std::vector<std::string>& names,
                  double step_s, std::uint64_t first_stream) {
  Sensors sensors(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto found = params.sensors.find(names[i]);
    if (found == params.sensors.end()) continue;
    try {
      sensors[i].emplace(found->second, step_s, params.seed, first_stream + i);
    } catch (const InputError& e) {
      throw InputError("sensors." + names[i] + "." + e.what());
    }
  }
  return sensors;
}

void takeAway(Sensors& sensors, Eigen::Ref<Vector> readings) {
  for (std::size_t i = 0; i < sensors.size(); ++i)
    if (sensors[i] && sensors[i]->loses())
      readings[static_cast<Eigen::Index>(i)] = noValue(NoValue::kMissing);
}

void rest(Sensors& sensors, VectorRef values) {
  for (std::size_t i = 0; i < sensors.size(); ++i)
    if (sensors[i]) sensors[i]->reset(values[static_cast<Eigen::Index>(i)]);
}

}  // namespace

Instruments::Instruments(const InstrumentParams& params, const std::vector<DriveParams>& drives,
                         const std::vector<std::string>& outputs,
                         const std::vector<std::string>& disturbances, double sample_time_s)
    : step_s_(sample_time_s) {
  require(std::isfinite(params.step_s) && params.step_s > 0.0, "sensors.step_s", "a time > 0");
  requireKnown(params, outputs, disturbances);
  for (const DriveParams& drive : drives) {
    require(std::isfinite(drive.t90_s) && drive.t90_s >= 0.0, "actuator.lag: t90_s", "a time >= 0");
    require(std::isfinite(drive.backlash) && drive.backlash >= 0.0, "actuator.lag: backlash",
            "a number >= 0");
    require(std::isfinite(drive.stiction) && drive.stiction >= 0.0, "actuator.lag: stiction",
            "a number >= 0");
    play_.push_back(0.5 * drive.backlash);
    stick_.push_back(drive.stiction);
    drives_.emplace_back();
    if (drive.t90_s > 0.0)
      drives_.back().emplace(drive.order, drive.t90_s / lagsToNinety(drive.order));
  }
  const bool driven = std::any_of(drives_.begin(), drives_.end(), [](const auto& d) { return d; });
  if (driven || !params.sensors.empty()) {
    const double steps = std::max(1.0, std::ceil(sample_time_s / params.step_s - 1e-9));
    require(steps <= 1e6, "sensors.step_s", "at most 1e6 steps in a sample");
    steps_ = static_cast<int>(steps);
    step_s_ = sample_time_s / steps_;
  }
  outputs_ = sensorsOf(params, outputs, step_s_, 0);
  disturbances_ = sensorsOf(params, disturbances, step_s_, 1000);
}

void Instruments::reset(VectorRef y, VectorRef d, VectorRef u) {
  rest(outputs_, y);
  rest(disturbances_, d);
  for (std::size_t i = 0; i < drives_.size(); ++i)
    if (drives_[i]) drives_[i]->reset(u[static_cast<Eigen::Index>(i)]);
  y_ = y;
  stem_ = gear_ = position_ = u;
}

const Vector& Instruments::drive(VectorRef command) {
  position_ = command;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    double& u = position_[static_cast<Eigen::Index>(i)];
    double& stem = stem_[static_cast<Eigen::Index>(i)];
    double& gear = gear_[static_cast<Eigen::Index>(i)];
    if (std::abs(u - stem) > stick_[i]) stem = u;
    u = stem;
    u = gear = std::clamp(gear, u - play_[i], u + play_[i]);
    if (drives_[i]) u = drives_[i]->advance(u, u, step_s_);
  }
  return position_;
}

void Instruments::advance(VectorRef y, VectorRef d) {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (outputs_[i]) outputs_[i]->advance(y_[k], y[k], step_s_);
  }
  for (std::size_t i = 0; i < disturbances_.size(); ++i) {
    const double value = d[static_cast<Eigen::Index>(i)];
    if (disturbances_[i]) disturbances_[i]->advance(value, value, step_s_);
  }
  y_ = y;
}

void Instruments::read(Eigen::Ref<Vector> y, Eigen::Ref<Vector> d) {
  for (std::size_t i = 0; i < outputs_.size(); ++i)
    if (outputs_[i]) y[static_cast<Eigen::Index>(i)] = outputs_[i]->take();
  for (std::size_t i = 0; i < disturbances_.size(); ++i)
    if (disturbances_[i]) d[static_cast<Eigen::Index>(i)] = disturbances_[i]->take();
}

void Instruments::lose(Eigen::Ref<Vector> y, Eigen::Ref<Vector> d) {
  takeAway(outputs_, y);
  takeAway(disturbances_, d);
}

}  // namespace fpc
