// What a sample costs under the fuzzy optimal law and its baselines: the law, nonlinear MPC, a
// swarm.
#include <benchmark/benchmark.h>

#include <string>

#include "runtime/factory.hpp"

namespace {

/// A measured output that swings by 2 % of itself, so that no sample is like the one before; the
/// input sent comes back as the one applied.
void step(benchmark::State& state, const std::string& name) {
  const fpc::LoopFile loop = fpc::readLoop(name);
  fpc::ControllerSession session = fpc::makeControllerSession(loop);
  if (loop.has_model) session.setModel(loop.model);
  fpc::Measurement measurement = fpc::makeSimulation(loop).measurement();
  const fpc::Vector rest = measurement.outputs;
  for (auto _ : state) {
    session.receive(measurement);
    ++measurement.header.step;
    measurement.outputs[0] = rest[0] * (measurement.header.step % 2 == 0 ? 1.0 : 1.02);
    measurement.input_applied = session.answer().base.input;
  }
}

BENCHMARK_CAPTURE(step, reactor_law, "mimo_cstr_steps")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, reactor_nmpc, "mimo_cstr_steps_nmpc")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, reactor_swarm, "mimo_cstr_steps_swarm")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, tank_law, "surge_tank_steps")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, tank_nmpc, "surge_tank_steps_nmpc")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, tank_swarm, "surge_tank_steps_swarm")->Unit(benchmark::kMicrosecond);

}  // namespace
