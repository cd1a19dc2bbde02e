// An optimizer session beside the base law of the fixture of the closed-loop paradigm.
#pragma once

#include "control/clp/fixture.hpp"
#include "runtime/session.hpp"

namespace fpc::optimizer_test {

constexpr int kSteps = 8;  // n_c

inline PlantInfo plant() {
  PlantInfo info;
  info.outputs.resize(2);
  info.inputs.resize(1);
  return info;
}

inline ClpParams params() {
  ClpParams p;
  p.perturbation_steps = kSteps;
  return p;
}

inline StepHeader header(std::uint32_t step, std::uint64_t run_id = 1) {
  const std::uint64_t after_start = std::uint64_t{step} * 720000000000U;  // a forged step may wrap
  return {1234500000000 + static_cast<std::int64_t>(after_start), run_id, step};
}

// The base law of the fixture asks for 804; `demand` more moves it towards the bound of 1600.
inline PredictiveAction prediction(const StepHeader& h, double demand = 0.0, int n_c = kSteps) {
  PredictiveAction p = clp_test::sludgeLike(n_c).now;
  p.header = h;
  p.feedforward.array() += demand;
  p.input_base_unclipped.array() += demand;
  return p;
}

inline ControlAction base(const StepHeader& h, double input = 804.0,
                          ActionSource source = ActionSource::kBase) {
  return {h, Vector::Constant(1, input), source};
}

inline OptimizerSession make() { return {params(), clp_test::sludgeLike(kSteps).limits, plant()}; }

}  // namespace fpc::optimizer_test
