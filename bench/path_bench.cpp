// What a sample costs, each beside what it cannot do without, in pairs: a run in process beside its
// plant alone, a step of the published law beside its bare arithmetic, the plant beside a
// fixed-step Runge-Kutta method of equal error, two threads beside one.
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "arithmetic_peak.hpp"
#include "base/parallel.hpp"
#include "fmbpc/base/option.hpp"
#include "identification/cluster_kernels.hpp"
#include "identification/cluster_pass.hpp"
#include "identification/clustering.hpp"
#include "pairs.hpp"
#include "plant/integrator.hpp"
#include "runtime/factory.hpp"
#include "runtime/run.hpp"

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

/// The rules of one output: a blend of consequents by products of memberships.
struct BareRules {
  Matrix centers, widths, consequents, member;
  Vector z, weight, blended;

  BareRules(Eigen::Index rules, Eigen::Index antecedents)
      : centers(Matrix::Random(antecedents, rules)),
        widths(Matrix::Constant(antecedents, rules, 0.7)),
        consequents(Matrix::Random(antecedents + 1, rules)),
        z(Vector::Random(antecedents)) {}
  void blend() {
    z(0) = -z(0);
    member = (-0.5 * ((centers.colwise() - z).array() / widths.array()).square()).exp();
    weight = member.colwise().prod().transpose();
    weight /= weight.sum();
    blended.noalias() = consequents * weight;
  }
};

/// The exponentials, sums and powers that a step of the law with FM_1 needs: 6 rules of 6
/// antecedents, 5 of 3, three states, A^H and I + A + ... + A^(H-1) by doubling.
struct BareLaw {
  explicit BareLaw(int H) : horizon(H) {}
  int horizon;
  BareRules substrate{6, 6}, biomass{5, 3};
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero(), power, sum, next;
  double total{};

  void step() {
    substrate.blend();
    biomass.blend();
    A.row(0) = 0.1 * substrate.blended.head<3>();
    A.row(1) = 0.1 * biomass.blended.head<3>();
    power = A;
    sum.setIdentity();
    for (int n = 1; 2 * n <= horizon; n *= 2) {
      next.noalias() = power * sum;
      sum += next;
      next.noalias() = power * power;
      power = next;
    }
    total += sum(0, 0) + power(1, 1) + substrate.blended(3) + biomass.blended(3);
  }
};

/// One step of the law of a loop beside the arithmetic that it needs, H samples ahead.
void lawStep(const std::string& name, int horizon) {
  const LoopFile loop = readLoop(name, {{"controller.coincidence_steps", std::to_string(horizon)}});
  ControllerSession session = makeControllerSession(loop);
  if (loop.has_model) session.setModel(loop.model);
  Measurement measurement = makeSimulation(loop).measurement();
  const Vector rest = measurement.outputs;
  BareLaw bare(horizon);
  printPairs(
      "1000 steps of the published law, " + name + ", H " + std::to_string(horizon),
      "its exponentials, sums and powers", "0.33",
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
      "1000 plant samples, activated sludge, " + wordOf(own),
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
  plantSample(IntegrationMethod::kRungeKutta);
}

/// Gustafson-Kessel on 100,000 samples of 10 numbers into 8 clusters, or as many as are asked for.
class Clustering {
 public:
  explicit Clustering(Eigen::Index samples = 100000, Eigen::Index numbers = 10, int clusters = 8)
      : points_(numbers, samples) {
    std::mt19937_64 generator(1);
    std::normal_distribution<double> normal;
    for (double& value : flat(points_)) value = normal(generator);
    params_.clusters = clusters;
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

/// Sums of 10 x 10 scatters over samples in the cache beside the core's peak. A sample needs 110
/// operations for the lower triangle and 44 for scaling, mean and sums; two make a multiply-add.
void covariancePass() {
  constexpr std::size_t kSize = 10, kRows = 12, kTimes = 1000;
  constexpr double kNeeded = 0.5 * (110 + 44) * clusters::kBlock * kTimes;
  clusters::Buffer points(kRows * clusters::kBlock, 0.1), center(kRows, 0.05),
      root(clusters::kBlock, 0.5), squared(clusters::kBlock, 1.0), scaled(kRows * clusters::kBlock),
      offset(kRows * clusters::kLanes), sums(2 * clusters::kLanes),
      scatter(kRows * kRows * clusters::kLanes);
  const int bits = widestBits();
  const clusters::Kernels& kernels = clusters::kernels();
  volatile double kept = 0.0;  // so that nothing is left out
  printPairs(
      "covariance pass of Gustafson-Kessel, 64,000 x 10, one cluster",
      "as much arithmetic at the peak of a core, " + std::to_string(bits) + " bits", "0.3",
      [&] {
        for (std::size_t i = 0; i < kTimes; ++i) {
          kernels.scaleBlock(points.data(), center.data(), root.data(), squared.data(), kSize,
                             scaled.data(), offset.data(), sums.data());
          kernels.addScatter(scaled.data(), kSize, scatter.data());
        }
      },
      [&] { kept = multiplyAdds(kNeeded, bits); });
}

/// For scripts/bench, which has numpy and Octave beside it: seconds of one iteration.
void clusteringIteration(Clustering clustering) {
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
    if (count == 5)
      clusteringIteration(Clustering(std::stol(arguments[2]), std::stol(arguments[3]),
                                     static_cast<int>(std::stol(arguments[4]))));
    else
      clusteringIteration(Clustering());
    return 0;
  }
  inProcess("asp_case1", "0.8");
  inProcess("asp_case1_clp", "0.4");
  for (const int horizon : {6, 180}) lawStep("asp_case1", horizon);
  plantSamples();
  covariancePass();
  clusteringThreads();
  runsInParallel();
  return 0;
}
