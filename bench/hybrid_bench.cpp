// Time of one decision of the batch reactor's hybrid law over random states (those of the property
// test): median and 99 % quantile in us, and mean nodes visited, for horizons of 4, 6 and 8 blocks
// with 7 inputs, by both bounds. BM_Growth counts nodes against horizon and number of inputs.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>
#include <vector>

#include "control/hybrid/fixture.hpp"
#include "fmbpc/base/option.hpp"

namespace {

struct Case {
  Eigen::Vector2d outputs;
  fpc::Vector input;
  double reference;
};

std::vector<Case> cases(int n) {
  std::mt19937_64 generator(20070);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Case> all;
  for (int i = 0; i < n; ++i) {
    Case c;
    c.outputs = {15.0 + 51.0 * unit(generator), 13.0 + 60.0 * unit(generator)};
    c.input = fpc::test::batchReactorInputs().col(static_cast<Eigen::Index>(generator() % 7));
    const double recipe[] = {62.0, 26.0, 35.0};
    c.reference = i % 2 == 0 ? c.outputs[0] - 2.0 + 4.0 * unit(generator) : recipe[generator() % 3];
    all.push_back(c);
  }
  return all;
}

fpc::BranchBound boundOf(std::int64_t index) {
  return index == 0 ? fpc::BranchBound::kCost : fpc::BranchBound::kReach;
}

/// n input vectors: those of the paper, or more positions of the mixing valve between them.
fpc::Matrix inputs(int n) {
  fpc::Matrix P(3, n);
  P.col(0) << 1.0, 1.0, 0.0;
  for (int i = 1; i < n; ++i)
    P.col(i) << (n == 2 ? 1.0 : std::pow(static_cast<double>(i - 1) / (n - 2), 3.0)), 0.0, 1.0;
  return n == 7 ? fpc::test::batchReactorInputs() : P;
}

/// Decides each case once per iteration; every single time counts.
void run(benchmark::State& state, fpc::HybridMpcParams params, int n_cases) {
  const int n_inputs = static_cast<int>(params.choices.cols()), levels = params.horizon_blocks;
  const auto mpc = fpc::test::batchReactorMpc(std::move(params));
  const auto all = cases(n_cases);
  std::vector<double> times;
  double nodes = 0.0;
  for (auto _ : state) {
    for (const Case& c : all) {
      const fpc::Matrix reference = Eigen::Vector2d(c.reference, 0.0).replicate(1, 15 * levels);
      const auto start = std::chrono::steady_clock::now();
      nodes +=
          static_cast<double>(mpc->decide(c.outputs, c.input, fpc::Vector(0), reference).nodes);
      times.push_back(
          std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
              .count());
    }
  }
  std::sort(times.begin(), times.end());
  state.counters["median_us"] = times[times.size() / 2];
  state.counters["p99_us"] = times[times.size() * 99 / 100];
  state.counters["nodes"] = nodes / static_cast<double>(times.size());
  state.counters["full_tree"] = fpc::TreeSearch::fullTree(n_inputs, levels);
}

void BM_Decision(benchmark::State& state) {
  const int levels = static_cast<int>(state.range(0));
  state.SetLabel(fpc::wordOf(boundOf(state.range(1))));
  run(state, fpc::test::batchReactorParams(45, boundOf(state.range(1)), levels),
      levels == 4   ? 1000
      : levels == 6 ? 200
                    : 20);
}
BENCHMARK(BM_Decision)
    ->ArgsProduct({{4, 6, 8}, {0, 1}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

void BM_Growth(benchmark::State& state) {
  const int levels = static_cast<int>(state.range(0)), n = static_cast<int>(state.range(1));
  auto params = fpc::test::batchReactorParams(45, boundOf(state.range(2)), levels);
  params.choices = inputs(n);
  state.SetLabel(fpc::wordOf(boundOf(state.range(2))));
  run(state, std::move(params), 40);
}
BENCHMARK(BM_Growth)
    ->ArgsProduct({{1, 2, 3, 4, 5, 6}, {7}, {0, 1}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(BM_Growth)
    ->ArgsProduct({{4}, {2, 3, 5, 9, 12}, {0, 1}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
