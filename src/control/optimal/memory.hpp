// Everything the fuzzy optimal law keeps between samples. Private to the room.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "control/optimal/bank.hpp"

namespace fpc {

inline Eigen::Index signalCount(const std::vector<SignalInfo>& signals) {
  return static_cast<Eigen::Index>(signals.size());
}

struct FuzzyOptimalLaw::Memory {
  Memory(FuzzyOptimalParams p, InputLimits l, PlantInfo i)
      : params(std::move(p)),
        limits(std::move(l)),
        plant(std::move(i)),
        reference(params.reference_pole, params.preview),
        disturbances(params.disturbance_feedforward
                         ? Vector(Vector::Zero(signalCount(plant.disturbances)))
                         : params.disturbance_nominal),
        past_disturbances(disturbances),
        bias(Vector::Zero(signalCount(plant.inputs))),
        proposal(bias),
        wanted(bias),
        last_input(limits.lower) {
    for (const auto& output : plant.outputs) signals.emplace_back(output.name + "_error", 0.0);
    for (const auto& input : plant.inputs) signals.emplace_back(input.name + "_unclipped", 0.0);
  }

  FuzzyOptimalParams params;  ///< with the latest tuning
  InputLimits limits;
  PlantInfo plant;
  ReferenceTrajectory reference;
  Vector disturbances, past_disturbances;  ///< d(k), d(k-1) as the model takes them
  Vector bias;                             ///< of a bumpless transfer, dying out
  Vector proposal;                         ///< u(k), unclipped
  Vector wanted;                           ///< the proposal of a law that is handing over
  Vector last_input;                       ///< the last finite input, applied or sent
  std::optional<TsModel> model;            ///< matched, for a new tuning
  std::unique_ptr<Bank> bank;
  std::unique_ptr<Bank> successor;  ///< of a new model or tuning: takes over in the next step
  std::unique_ptr<Bank> retired;    ///< the one before: freed when the next one comes
  std::vector<std::pair<std::string, double>> signals;
  bool start_pending{true};      ///< the state is to be taken from the next measurement
  bool transfer_pending{false};  ///< the next u must equal the applied input
  bool running{false};           ///< an action has been computed since the reset
};

}  // namespace fpc
