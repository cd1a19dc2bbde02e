// One step of the closed-loop paradigm on a plant of the activated sludge's size: 42 free inputs, 3
// states. The base law runs into its limits all the time, so that every step solves a QP.
#include "control/clp/closed_loop_paradigm.hpp"

#include <string>

#include <benchmark/benchmark.h>

namespace {

using fpc::Matrix;
using fpc::Vector;

constexpr int kSteps = 42;

enum Limits { kBounds, kMoves, kSoftOutputs, kInactive };

fpc::PredictiveAction sludgeLike() {
  fpc::PredictiveAction now;
  now.A = (Matrix(3, 3) << 0.76, -0.004, -0.002, 0.0, 0.97, 0.02, 0.0, 0.0, 0.0).finished();
  now.B = (Matrix(3, 1) << -0.003, 0.03, 1.0).finished();
  now.C = Matrix::Identity(2, 3);
  now.state = (Vector(3) << 57.0, 1960.0, 560.0).finished();
  now.offset_state = (Vector(3) << 24.0, 32.0, 0.0).finished();
  now.offset_output = Vector::Zero(2);
  now.K = (Matrix(1, 3) << 0.0, 4.0, 0.1).finished();
  now.feedforward = Matrix::Constant(1, kSteps, 8700.0);
  now.reference = (Vector(2) << 55.0, 2000.0).finished().replicate(1, kSteps);
  now.setpoint = now.reference.col(0);
  now.input_previous = Vector::Constant(1, 560.0);
  return now;
}

fpc::ClosedLoopParadigm makeParadigm(int limits) {
  fpc::ClpParams params;
  params.perturbation_steps = kSteps;
  const double upper = limits == kInactive ? 1e5 : 700.0,
               lower = limits == kInactive ? -1e5 : 500.0;
  const double move = limits == kMoves || limits == kSoftOutputs ? 25.0 : fpc::kInfinity;
  if (limits == kSoftOutputs) {
    params.output_upper = (Vector(2) << fpc::kInfinity, 1995.0).finished();
  }
  return {params,
          {Vector::Constant(1, lower), Vector::Constant(1, upper), Vector::Constant(1, move)},
          3,
          2,
          1};
}

// A closed loop whose law aims high and low in turn, 15 samples each.
void clpStep(benchmark::State& state) {
  fpc::ClosedLoopParadigm clp = makeParadigm(static_cast<int>(state.range(0)));
  const bool warm = state.range(1) != 0;
  fpc::PredictiveAction now = sludgeLike();
  fpc::ControlAction action;
  fpc::SolverReport report;
  double iterations = 0.0, active = 0.0, unsolved = 0.0;
  long k = 0;
  for (auto _ : state) {
    now.feedforward.setConstant(k++ / 15 % 2 == 0 ? 8800.0 : 8350.0);
    now.input_base_unclipped = now.feedforward.col(0);
    now.input_base_unclipped -= now.K.lazyProduct(now.state);
    if (!warm) clp.reset();
    clp.step(now, action, report);
    Vector next = now.A * now.state + now.B * action.input + now.offset_state;
    now.state.swap(next);
    now.input_previous = action.input;
    iterations += report.iterations;
    active += report.active_rows;
    unsolved += report.status != fpc::SolveStatus::kSolved;
  }
  state.counters["iterations"] = iterations / static_cast<double>(k);
  state.counters["active"] = active / static_cast<double>(k);
  state.counters["unsolved"] = unsolved;
  static const char* const names[] = {"bounds", "bounds+moves", "bounds+moves+soft", "inactive"};
  state.SetLabel(std::string(names[state.range(0)]) + (warm ? ", warm" : ", cold"));
}

BENCHMARK(clpStep)->ArgsProduct({{kBounds, kMoves, kSoftOutputs}, {0, 1}})->Args({kInactive, 1});

}  // namespace
