// What a sample costs: one step of a predictive law, one plant sample, a whole run in process.
#include <benchmark/benchmark.h>

#include "runtime/factory.hpp"
#include "runtime/run.hpp"

namespace {

/// Answers the same measurement of asp_case1 again and again under new step numbers.
void controllerStep(benchmark::State& state, const char* name) {
  const fpc::LoopFile loop = fpc::readLoop(name);
  fpc::ControllerSession session = fpc::makeControllerSession(loop);
  if (loop.has_model) session.setModel(loop.model);
  fpc::Measurement measurement = fpc::makeSimulation(loop).measurement();
  for (auto _ : state) {
    benchmark::DoNotOptimize(session.receive(measurement));
    ++measurement.header.step;
  }
}

void fmbpcStep(benchmark::State& state) { controllerStep(state, "asp_case1"); }
void fmbpcStepWithPrediction(benchmark::State& state) { controllerStep(state, "asp_case1_clp"); }
void fuzzyOptimalStep(benchmark::State& state) { controllerStep(state, "mimo_cstr_steps"); }
void fuzzyOptimalStepWithPrediction(benchmark::State& state) {
  controllerStep(state, "mimo_cstr_steps_clp");
}
void piStep(benchmark::State& state) { controllerStep(state, "asp_case1_pi_x"); }
BENCHMARK(fmbpcStep);
BENCHMARK(fmbpcStepWithPrediction);
BENCHMARK(fuzzyOptimalStep);
BENCHMARK(fuzzyOptimalStepWithPrediction);
BENCHMARK(piStep);

void plantSample(benchmark::State& state) {
  const fpc::LoopFile loop = fpc::readLoop("asp_case1");
  fpc::Simulation simulation = fpc::makeSimulation(loop);
  const fpc::Vector input = fpc::Vector::Constant(1, 570.0);
  std::uint64_t run = 1;
  for (auto _ : state) {
    if (simulation.advance(input).final) simulation.reset(++run);
  }
}
BENCHMARK(plantSample);

void wholeRun(benchmark::State& state, const char* name) {
  const fpc::LoopFile loop = fpc::readLoop(name);
  for (auto _ : state) benchmark::DoNotOptimize(fpc::runLoop(loop));
  state.counters["samples/s"] = benchmark::Counter(830.0 * static_cast<double>(state.iterations()),
                                                   benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(wholeRun, asp_case1, "asp_case1")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(wholeRun, asp_case1_clp, "asp_case1_clp")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(wholeRun, asp_case1_pi_x, "asp_case1_pi_x")->Unit(benchmark::kMillisecond);

}  // namespace
