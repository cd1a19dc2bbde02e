// Drives and instruments of the loop file in a model of the process alone.
#include <algorithm>
#include <utility>

#include "config/read.hpp"
#include "fmbpc/base/input_error.hpp"
#include "model/filtered_input.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr Index kLongest = 60;    // samples of a response
constexpr double kWhole = 0.998;  // what has come of a response that has ended

/// A response of unit gain; advance(from, to) is what is seen at a sample in which the signal goes
/// from `from` to `to`.
template <class Advance>
Vector responseOf(bool held, Advance advance) {
  Vector response(kLongest);
  double sum = 0.0;
  for (Index j = 0; j < kLongest; ++j) {
    const double from = held ? (j == 0 ? 1.0 : 0.0) : (j == 1 ? 1.0 : 0.0), to = j == 0 ? 1.0 : 0.0;
    sum += response[j] = advance(from, to);
    if (sum > kWhole) return response.head(j + 1) / sum;
  }
  throw InputError("instruments: expected drives and sensors that follow within " +
                   std::to_string(kLongest) + " samples");
}

Vector responseOf(const DriveParams* drive, double sample_time_s) {
  if (drive == nullptr || drive->t90_s == 0.0) return Vector::Ones(1);
  LagChain chain(drive->order, drive->t90_s / lagsToNinety(drive->order));
  return responseOf(true,
                    [&](double from, double to) { return chain.advance(from, to, sample_time_s); });
}

Vector responseOf(const SensorParams& about, double sample_time_s) {
  SensorParams exact;
  exact.lags = about.lags;
  exact.lag_s = about.lag_s;
  exact.delay_s = about.delay_s;
  Sensor sensor(exact, sample_time_s, 0, 0);
  return responseOf(false, [&](double from, double to) {
    sensor.advance(from, to, sample_time_s);
    return sensor.take();
  });
}

Vector convolved(const Vector& a, const Vector& b) {
  Vector both = Vector::Zero(a.size() + b.size() - 1);
  for (Index i = 0; i < a.size(); ++i) both.segment(i, b.size()) += a[i] * b;
  return both;
}

}  // namespace

TsModel withInstruments(TsModel model, const SimulationParams& plant) {
  const double seconds = plant.sample_time_s;
  for (std::size_t o = 0; o < model.submodels.size(); ++o) {
    OutputModel& submodel = model.submodels[o];
    const auto found = plant.instruments.sensors.find(model.outputs[o].name);
    const Vector shown = found == plant.instruments.sensors.end()
                             ? Vector(Vector::Ones(1))
                             : responseOf(found->second, seconds);
    const auto& drives = plant.actuator.drives;
    for (std::size_t i = 0; i < model.inputs.size(); ++i) {
      const Vector driven = responseOf(i < drives.size() ? &drives[i] : nullptr, seconds);
      filterRegressor(submodel, SignalKind::kInput, static_cast<int>(i), convolved(driven, shown));
    }
    for (std::size_t i = 0; i < model.disturbances.size(); ++i)
      filterRegressor(submodel, SignalKind::kDisturbance, static_cast<int>(i), shown);
  }
  return model;
}

}  // namespace fpc
