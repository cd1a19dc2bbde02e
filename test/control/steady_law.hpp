// A law that runs at a process that is its own model, for counting what it allocates.
#pragma once

#include "allocation_counter.hpp"

#include <cmath>
#include <utility>

#include "control/fmbpc/law_fixture.hpp"

namespace fpc::test {

template <typename Law, typename Params>
struct SteadyLaw {
  SteadyLaw(Params params, const TsModel& model)
      : info(infoOf(model)),
        plant(model, zeros(info.outputs), zeros(info.inputs), zeros(info.disturbances)),
        setpoint(setpointOf(info, zeros(info.outputs).array() + 1.0)),
        law(std::move(params), wideLimits(zeros(info.inputs).size(), 5.0), info) {
    law.setModel(model);
    start(law, plant, setpoint, 2);
    setpoint.advance(2);
    now = plant.measure(2);
    law.step(now, setpoint, output);  // sizes the output
  }
  static Vector zeros(const std::vector<SignalInfo>& signals) {
    return Vector::Zero(static_cast<Eigen::Index>(signals.size()));
  }

  /// Allocations of the next n steps.
  std::size_t allocations(int n) {
    testing::AllocationCounter counter;
    for (int i = 0; i < n; ++i) {
      ++now.header.step;
      now.outputs[0] = std::sin(0.1 * i);
      law.step(now, setpoint, output);
    }
    return counter.count();
  }

  PlantInfo info;
  ModelPlant plant;
  SetpointSource setpoint;
  Law law;
  Measurement now;
  ControllerOutput output;
};

}  // namespace fpc::test
