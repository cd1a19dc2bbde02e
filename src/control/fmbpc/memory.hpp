// Everything the fuzzy predictive law keeps between samples. Private to the room.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "control/fmbpc/internal_model.hpp"
#include "fmbpc/control/fmbpc/disturbance_forecast.hpp"
#include "fmbpc/control/fmbpc/law.hpp"

namespace fpc {

inline Eigen::Index countOf(const std::vector<SignalInfo>& signals) {
  return static_cast<Eigen::Index>(signals.size());
}

struct FmbpcLaw::Memory {
  Memory(FmbpcParams p, InputLimits l, PlantInfo i)
      : params(std::move(p)),
        limits(std::move(l)),
        plant(std::move(i)),
        published(params.law == "published"),
        iterated(params.law == "iterated"),
        realigned(params.realisation == "realigned"),
        reference(params.reference_pole, params.preview),
        aim(params.coincidence_steps - 1 + params.reference_lead_steps),
        future(Matrix::Zero(countOf(plant.outputs), params.referenceSteps())),
        forecast(countOf(plant.disturbances), params.horizon_steps, params.forecast_period_steps,
                 params.forecast_pole, params.forecast_memory_steps),
        disturbances(params.disturbance_feedforward
                         ? Vector(Vector::Zero(countOf(plant.disturbances)))
                         : params.disturbance_nominal),
        bias(Vector::Zero(countOf(plant.inputs))),
        proposal(bias),
        wanted(bias),
        last_input(limits.lower) {
    for (const auto& output : plant.outputs) {
      signals.emplace_back(output.name + "_model", 0.0);
      signals.emplace_back(output.name + "_correction", 0.0);
      if (params.delay_steps > 0) signals.emplace_back(output.name + "_undelayed", 0.0);
    }
    for (const auto& input : plant.inputs) signals.emplace_back(input.name + "_unclipped", 0.0);
  }

  FmbpcParams params;
  InputLimits limits;
  PlantInfo plant;
  bool published, iterated, realigned;
  ReferenceTrajectory reference;
  Eigen::Index aim;  ///< column of `future` that u(k) aims at
  Matrix future;     ///< col(i) = y_r(k+1+i)
  DisturbanceForecast forecast;
  Vector disturbances;  ///< d(k) as the model takes it
  Vector bias;          ///< of a bumpless transfer, dying out
  Vector proposal;      ///< u(k), unclipped
  Vector wanted;        ///< the proposal of a model that is handing over
  Vector last_input;    ///< the last finite input, applied or sent
  std::unique_ptr<Belief> belief;
  std::unique_ptr<Belief> successor;  ///< of a new model: takes over in the next step
  std::unique_ptr<Belief> retired;    ///< of the model before: freed when the next one comes
  std::vector<std::pair<std::string, double>> signals;
  bool start_pending{true};      ///< the state is to be taken from the next measurement
  bool transfer_pending{false};  ///< the next u must equal the applied input
  bool running{false};           ///< an action has been computed since the reset
};

}  // namespace fpc
