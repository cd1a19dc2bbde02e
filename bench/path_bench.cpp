// What a sample costs, each beside what it cannot do without, in pairs: a run in process beside its
// plant alone, a step of the published law beside its bare arithmetic, the plant beside a
// fixed-step Runge-Kutta method of equal error, two threads beside one.
#include <cmath>
#include <random>
#include <string>

#include "fmbpc/base/option.hpp"
#include "fmbpc/base/parallel.hpp"
#include "fmbpc/fuzzy/clustering.hpp"
#include "fmbpc/loop/factory.hpp"
#include "fmbpc/loop/run.hpp"
#include "fmbpc/plant/integrator.hpp"
#include "pairs.hpp"

namespace fpc::bench {
namespace {

/// The inputs applied in a run, u(k) in column k.
Matrix inputsOf(const LoopFile& loop) {
  const RunRecord record = runLoop(loop);
  const auto count = static_cast<Eigen::Index>(record.samples.size()) - 1;
  Matrix inputs(record.samples[1].measurement.input_applied.size(), count);
  for (Eigen::Index k = 0; k < count; ++k)
    inputs.col(k) = record.samples[static_cast<std::size_t>(k) + 1].measurement.input_applied;
  return inputs;
}

/// The loop closed in process beside its plant alone, moved by the same inputs.
void inProcess(const std::string& name, const std::string& aim) {
  const LoopFile loop = readLoop(name);
  const Matrix inputs = inputsOf(loop);
  Simulation plant = makeSimulation(loop);
  std::uint64_t run = 1;
  printPairs(
      "166 h in process, " + name, "the plant alone", aim, [&] { runLoop(loop); },
      [&] {
        plant.reset(++run);
        for (Eigen::Index k = 0; k < inputs.cols(); ++k) plant.advance(inputs.col(k));
      });
}

/// One step of the law of a loop beside the exponentials, sums and powers that it needs.
struct BareLaw {
  static constexpr int kRules = 11, kAntecedents = 4, kStates = 3, kPowers = 8;
  Matrix centers = Matrix::Random(kAntecedents, kRules);
  Matrix widths = Matrix::Constant(kAntecedents, kRules, 0.7);
  Matrix consequents = Matrix::Random(kAntecedents + 1, kRules);
  Matrix A[2] = {0.3 * Matrix::Random(kStates, kStates), 0.3 * Matrix::Random(kStates, kStates)};
  Vector z = Vector::Random(kAntecedents), weight = Vector::Zero(kRules);
  Vector blended = Vector::Zero(kAntecedents + 1);
  Eigen::Matrix3d power, sum, next;
  double total{};

  void step() {
    z(0) = -z(0);
    weight = ((centers.colwise() - z).array() / widths.array())
                 .square()
                 .colwise()
                 .sum()
                 .transpose()
                 .unaryExpr([](double v) { return std::exp(-0.5 * v); });
    weight /= weight.sum();
    blended.noalias() = consequents * weight;
    for (const Matrix& a : A) {
      power = a;
      sum.setIdentity();
      for (int i = 0; i < kPowers; ++i) {
        next.noalias() = sum + power * sum;
        sum = next;
        next.noalias() = power * power;
        power = next;
      }
      total += sum(0, 0) + blended(0);
    }
  }
};

void lawStep(const std::string& name) {
  const LoopFile loop = readLoop(name);
  ControllerSession session = makeControllerSession(loop);
  if (loop.has_model) session.setModel(loop.model);
  Measurement measurement = makeSimulation(loop).measurement();
  const Vector rest = measurement.outputs;
  BareLaw bare;
  printPairs(
      "step of the published law, " + name, "its exponentials, sums and powers", "0.33",
      [&] {
        for (int i = 0; i < 1000; ++i) {
          session.receive(measurement);
          ++measurement.header.step;
          measurement.outputs[0] = rest[0] * (measurement.header.step % 2 == 0 ? 1.0 : 1.02);
          measurement.input_applied = session.answer().base.input;
        }
      },
      [&] {
        for (int i = 0; i < 1000; ++i) bare.step();
      });
}

/// Classical Runge-Kutta of order four with a fixed number of steps.
struct RungeKutta {
  const Plant& plant;
  Vector k1, k2, k3, k4;

  explicit RungeKutta(const Plant& p) : plant(p) {
    const auto n = static_cast<Eigen::Index>(p.description().states.size());
    for (Vector* k : {&k1, &k2, &k3, &k4}) k->setZero(n);
  }
  void advance(Vector& x, const Vector& u, const Vector& d, double time, int steps) {
    const double h = time / steps;
    for (int i = 0; i < steps; ++i) {
      plant.derivatives(x, u, d, k1);
      plant.derivatives(x + 0.5 * h * k1, u, d, k2);
      plant.derivatives(x + 0.5 * h * k2, u, d, k3);
      plant.derivatives(x + h * k3, u, d, k4);
      x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
  }
};

double relativeError(const Vector& x, const Vector& exact) {
  return ((x - exact).array() / (1.0 + exact.array().abs())).abs().maxCoeff();
}

/// One sample of the activated sludge plant from rest with the input stepped.
void plantSample(IntegrationMethod own) {
  LoopFile loop = readLoop("asp_case1");
  loop.simulation.integrator.method = own;
  const auto plant = makePlant(loop.simulation);
  Integrator integrator(*plant, loop.simulation.integrator);
  const Vector start = loop.simulation.initial_state, d = loop.simulation.disturbance_nominal;
  const Vector u = 1.1 * loop.simulation.actuator.initial;
  const double seconds = loop.simulation.sample_time_s;
  Vector truth = start, ours = start, theirs = start;
  RungeKutta method(*plant);
  const double time = seconds / plant->description().time_unit_s;
  method.advance(truth, u, d, time, 2000);  // to rounding
  integrator.advance(ours, u, d, seconds);
  int steps = 1;
  for (; steps < 10000; ++steps) {
    theirs = start;
    method.advance(theirs, u, d, time, steps);
    if (relativeError(theirs, truth) <= relativeError(ours, truth)) break;
  }
  printPairs(
      "plant sample, activated sludge, " + wordOf(own),
      "Runge-Kutta 4, " + std::to_string(steps) + " steps", "0.5",
      [&] {
        for (int i = 0; i < 1000; ++i) {
          ours = start;
          integrator.advance(ours, u, d, seconds);
        }
      },
      [&] {
        for (int i = 0; i < 1000; ++i) {
          theirs = start;
          method.advance(theirs, u, d, time, steps);
        }
      });
}

/// As the shipped loop has it, and by the method that starts anew at no cost.
void plantSamples() {
  plantSample(IntegrationMethod::kAdams);
  if (hasRungeKutta()) plantSample(IntegrationMethod::kRungeKutta);
}

/// Gustafson-Kessel on 100,000 samples of 10 numbers into 8 clusters.
class Clustering {
 public:
  Clustering() : points_(10, 100000) {
    std::mt19937_64 generator(1);
    std::normal_distribution<double> normal;
    for (double& value : flat(points_)) value = normal(generator);
    params_.clusters = 8;
    params_.max_iterations = kIterations;
    params_.tolerance = 1e-14;
  }
  void run(int threads) {
    params_.threads = threads;
    findClusters(points_, params_);
  }
  static constexpr int kIterations = 10;

 private:
  Matrix points_;
  ClusteringParams params_;
};

void clusteringThreads() {
  Clustering clustering;
  printPairs(
      "Gustafson-Kessel, 100,000 x 10 x 8, two threads", "one thread", "1.7",
      [&] { clustering.run(2); }, [&] { clustering.run(1); });
}

/// For scripts/bench, which has numpy beside it: seconds of one iteration.
void clusteringIteration() {
  Clustering clustering;
  const double seconds = Effort::fromEnvironment().seconds;
  std::printf("%.6g\n",
              1e-6 * microseconds([&] { clustering.run(0); }, seconds) / Clustering::kIterations);
}

void runsInParallel() {
  const LoopFile loop = readLoop("asp_case1");
  const auto run = [&](int threads) {
    parallelFor(8, threads, [&](std::size_t) { runLoop(loop); });
  };
  printPairs(
      "eight runs of a tuning, two threads", "one thread", "1.8", [&] { run(2); }, [&] { run(1); });
}

}  // namespace
}  // namespace fpc::bench

int main(int count, char** arguments) {
  using namespace fpc::bench;
  if (count > 1 && std::string(arguments[1]) == "clustering") {
    clusteringIteration();
    return 0;
  }
  inProcess("asp_case1", "0.8");
  inProcess("asp_case1_clp", "0.4");
  lawStep("asp_case1");
  plantSamples();
  clusteringThreads();
  runsInParallel();
  return 0;
}
