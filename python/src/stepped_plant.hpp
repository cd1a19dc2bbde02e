// Plants that Python steps: the equations of a registered one, and the plant of a loop with its
// records, actuators and sensors.
#pragma once

#include <memory>
#include <string>

#include "convert.hpp"
#include "plant/integrator.hpp"
#include "runtime/plant_session.hpp"
#include "used_alone.hpp"

namespace fpc::python {

/// Equations alone: inputs and disturbances act over a sample, all outputs are seen.
class SteppedPlant : public UsedAlone {
 public:
  /// @throws InputError naming an unknown plant or parameter, or a time that is none.
  SteppedPlant(const std::string& name, const PlantParameters& parameters, double sample_time_s);
  SteppedPlant(const SteppedPlant&) = delete;
  SteppedPlant& operator=(const SteppedPlant&) = delete;

  /// Moves over a sample; returns the outputs, n_y. @throws InputError for what is not finite or
  /// out of the plant's ranges, std::runtime_error if the plant could not be moved; then it is
  /// where it was.
  Array step(py::handle input, py::handle disturbance);
  Array reset(py::handle state);
  /// [unit of the state per time unit of the description]
  Array derivatives(py::handle state, py::handle input, py::handle disturbance) const;
  Array outputs() const;
  Array state() const { return toArray(x_); }
  double timeS() const { return static_cast<double>(samples_) * sample_time_s_; }
  double sampleTimeS() const { return sample_time_s_; }
  const PlantDescription& description() const { return plant_->description(); }

 private:
  void begin();
  std::string move(Eigen::Ref<Vector> x, VectorRef u, VectorRef d);

  std::unique_ptr<Plant> plant_;
  Names states_, inputs_, disturbances_;
  double sample_time_s_;
  Integrator integrator_;
  std::unique_ptr<PlantStepper> stepper_;
  Vector x_, before_, u_, d_;
  std::uint64_t samples_{};
};

/// What runLoop() has before its controller.
class LoopPlant : public UsedAlone {
 public:
  explicit LoopPlant(std::shared_ptr<const LoopFile> loop);

  Array reset();
  /// u(k), n_u; returns the outputs of sample k + 1. @throws InputError after the final sample.
  Array step(py::handle input);
  /// A person's: overrides these disturbances (or input/NAME, output/NAME) from the next sample on.
  void disturb(const py::dict& values);
  const Measurement& now() const { return session_.process().measurement(); }
  const PlantState& state() const { return simulation_->state(); }
  std::string trouble() const { return simulation_->trouble(); }
  double timeH() const { return simulation_->clock().hoursAt(now().header.step); }
  /// What the loop's schedule asks of the present sample, n_y.
  Array setpoint() const { return toArray(setpoint_.present()); }

 private:
  LoopPlant(std::shared_ptr<const LoopFile> loop, std::unique_ptr<SimulatedProcess> made);

  std::shared_ptr<const LoopFile> loop_;
  Names inputs_;
  Simulation* simulation_;
  PlantSession session_;
  SetpointSource setpoint_;
  std::uint64_t run_id_{1};
};

}  // namespace fpc::python
