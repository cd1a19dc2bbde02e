// Time of one QP solve on the problems of a predictive controller with 42 inputs: bounds only, plus
// 41 move rows, plus 84 soft output rows with two slacks. Cold; warm with another H each time; warm
// with the same H (factor reused). The counter `active` is the number of active constraints,
// `iterations` that of working sets tried.
#include <algorithm>
#include <array>
#include <vector>

#include <benchmark/benchmark.h>

#include "optim/qp_problems.hpp"

namespace {

using fpc::QpProblem;
using fpc::QpResult;
using fpc::QpSolver;
using fpc::testing::ControllerQp;

constexpr int kTimes =
    20;  // problems spread over the drift; few active limits at some, many at others

/// Solves pairs of neighbours: the second has the active set of the first but, unless `same`,
/// another H.
void run(benchmark::State& state, bool warm, bool same) {
  const auto kind = static_cast<ControllerQp::Kind>(state.range(0));
  std::array<std::array<QpProblem, 2>, kTimes> problems;
  std::vector<QpSolver> solvers;
  for (int i = 0; i < kTimes; ++i) {
    ControllerQp controller(kind);
    for (int k = 0; k < 2; ++k) {
      controller.update(0.37 * i + (same ? 0.0 : 1e-6 * k));
      problems[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] = controller.problem;
    }
    solvers.emplace_back(controller.problem.g.size(), controller.problem.a_lower.size());
    solvers.back().solve(controller.problem);
  }
  double active = 0.0, iterations = 0.0, residual = 0.0;
  std::size_t k = 0, i = 0;
  for (auto _ : state) {
    const QpResult& r = solvers[i].solve(problems[i][k], warm);
    active += r.active;
    iterations += r.iterations;
    residual = std::max(residual, r.kkt_residual);
    if (!r.usable()) state.SkipWithError("not solved");
    if (++i == kTimes) {
      i = 0;
      k = 1 - k;
    }
  }
  state.counters["active"] = benchmark::Counter(active, benchmark::Counter::kAvgIterations);
  state.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
  state.counters["worst_residual"] = residual;
  state.SetLabel(state.range(0) == 0 ? "bounds" : state.range(0) == 1 ? "moves" : "outputs");
}

void qpCold(benchmark::State& state) { run(state, false, false); }
void qpWarm(benchmark::State& state) { run(state, true, false); }
void qpWarmSameHessian(benchmark::State& state) { run(state, true, true); }

BENCHMARK(qpCold)->DenseRange(0, 2)->Unit(benchmark::kMicrosecond);
BENCHMARK(qpWarm)->DenseRange(0, 2)->Unit(benchmark::kMicrosecond);
BENCHMARK(qpWarmSameHessian)->DenseRange(0, 2)->Unit(benchmark::kMicrosecond);

}  // namespace
