// Identification: clustering per sample, cluster and iteration, consequents, and how both grow with
// the data.
#include <benchmark/benchmark.h>

#include <random>

#include "identification/clustering.hpp"
#include "identification/consequents.hpp"
#include "identification/partition.hpp"

namespace fpc {
namespace {

constexpr Eigen::Index kRegressors = 10;
constexpr int kIterations = 10;

Regression randomRows(Eigen::Index rows) {
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  Regression data;
  data.regressors.resize(rows, kRegressors);
  for (double& value : flat(data.regressors)) value = normal(generator);
  data.antecedents = data.regressors;
  data.target = data.regressors.rowwise().sum() + data.regressors.col(0).cwiseAbs2();
  return data;
}

Clusters clustersOf(const Regression& data, bool adaptive, int number) {
  ClusteringParams params;
  params.adaptive = adaptive;
  params.clusters = number;
  params.fuzziness = 1.5;
  params.max_iterations = kIterations;
  params.tolerance = 1e-12;  // all iterations, for the sake of time
  return findClusters(data.antecedents.transpose(), params);
}

void clustering(benchmark::State& state, bool adaptive) {
  const Regression data = randomRows(state.range(0));
  const auto number = static_cast<int>(state.range(1));
  for (auto _ : state) benchmark::DoNotOptimize(clustersOf(data, adaptive, number));
  const double work = static_cast<double>(state.range(0)) * number * kIterations;
  state.counters["per_sample_cluster_iteration"] = benchmark::Counter(
      work, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void BM_GustafsonKessel(benchmark::State& state) { clustering(state, true); }
void BM_FuzzyCMeans(benchmark::State& state) { clustering(state, false); }

void BM_Consequents(benchmark::State& state) {
  const Regression data = randomRows(state.range(0));
  const Clusters clusters = clustersOf(data, false, static_cast<int>(state.range(1)));
  std::vector<Regressor> variables;
  for (int lag = 0; lag < kRegressors; ++lag) variables.push_back({SignalKind::kOutput, 0, lag});
  RuleFit fit;
  const OutputModel linear = fitLinear(data, variables, fit);
  ConsequentParams params;
  params.method = static_cast<ConsequentMethod>(state.range(2));
  for (auto _ : state) {
    OutputModel model;
    model.antecedents = model.regressors = variables;
    model.rules = projectClusters(data.antecedents, clusters, {}, kRegressors);
    benchmark::DoNotOptimize(fitConsequents(data, linear, params, model));
  }
}

BENCHMARK(BM_GustafsonKessel)
    ->ArgsProduct({{10000, 30000, 100000}, {2, 8}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(BM_FuzzyCMeans)->ArgsProduct({{10000, 100000}, {8}})->Unit(benchmark::kMillisecond);
BENCHMARK(BM_Consequents)
    ->ArgsProduct({{10000, 100000}, {8}, {0, 1, 2}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace fpc
