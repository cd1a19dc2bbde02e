// Sections of a random loop file.
#pragma once

#include "fmbpc/base/signals.hpp"
#include "fmbpc/plant/plant.hpp"
#include "random/dice.hpp"
#include "random/random_loop.hpp"

namespace fpc {

/// What the sections agree on.
struct RandomFrame {
  PlantDescription plant;
  std::vector<Quantity> outputs;  ///< measured, in order
  std::string model;              ///< file below config/model; empty: none
  double sample_time_s{};
  int samples{};
  bool delayed{false};   ///< a sample line delays an output
  bool divisible{true};  ///< as PlantStepper::divisible()
  bool remembers{};      ///< as PlantStepper::remembers()
  std::string actuator;  ///< section that the controller needs; empty: any
  double hours(double samples_after_start) const {
    return samples_after_start * sample_time_s / 3600.0;
  }
};

/// A range that can be aimed at: near the nominal value, inside the physical one.
std::pair<double, double> workingRange(const Quantity& q);
std::string byName(const std::vector<std::string>& names, const std::vector<std::string>& values);

/// Of the first shipped loop with this plant; 0: there is none.
double shippedSampleTime(const std::string& plant);
bool hasGenerator(const std::string& type);
std::string randomController(const std::string& type, Dice& dice, RandomFrame& frame);
std::string randomActuator(Dice& dice, const RandomFrame& frame);
std::string randomSetpoint(Dice& dice, const RandomFrame& frame);
std::string randomDisturbance(Dice& dice, const RandomFrame& frame, RandomLoop& loop);
std::string randomNoise(Dice& dice, const RandomFrame& frame);
std::string randomObserver(Dice& dice, const RandomFrame& frame);  ///< a key of controller
std::string randomDrives(Dice& dice, const RandomFrame& frame);    ///< a key of actuator
// Each may be empty.
std::string randomModel(Dice& dice, const RandomFrame& frame);
std::string randomSensors(Dice& dice, const RandomFrame& frame);
std::string randomPlausibility(Dice& dice, const RandomFrame& frame);
std::string randomStandstill(Dice& dice, const RandomFrame& frame);
/// @param fallback a section `controller`.
std::string randomGuard(Dice& dice, const RandomFrame& frame, const std::string& fallback);
std::string randomClp(Dice& dice, const RandomFrame& frame);

}  // namespace fpc
