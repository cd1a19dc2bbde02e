// The test of a plant keeps the operator's limits under loads that nobody measures.
#include "runtime/commissioning/plant_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>
#include <vector>

#include "base/random.hpp"

namespace fpc {
namespace plant_test_test {

using Eigen::Index;

struct Lag {  // time in samples; an integrator has no time
  double gain{1.0}, time{5.0};
  Index dead{};
  bool integrating{false};
};

/// y = sum of lags + load + noise.
struct Plant {
  std::vector<std::vector<Lag>> lags;                 // [output][input]
  std::function<double(Index k, Index output)> load;  // of the output
  std::function<double(double y)> control;            // of input 0 from output 0; empty: open loop
  double noise{0.01}, first_input{0.0};
  Index rows{3000};
};

struct Outcome {
  TestEnd end{TestEnd::kNone};
  Index left{};       // samples in which an output was beyond its limits
  Index moved_far{};  // samples with moves while the last output was beyond half its room
  std::uint64_t turned{};
  Matrix gains;
};

constexpr double kLimit = 1.0;

Outcome tested(const Plant& plant, std::uint64_t seed) {
  const auto n_y = static_cast<Index>(plant.lags.size());
  const auto n_u = static_cast<Index>(plant.lags.front().size());
  PlantInfo info;
  info.sample_time_s = 1.0;
  for (Index i = 0; i < n_y; ++i)
    info.outputs.push_back({"y" + std::to_string(i), "", -100.0, 100.0});
  for (Index j = 0; j < n_u; ++j) info.inputs.push_back({"u" + std::to_string(j), "", -10.0, 10.0});
  PlantTestParams p;
  p.limits = {Vector::Constant(n_u, -10.0), Vector::Constant(n_u, 10.0),
              Vector::Constant(n_u, 20.0)};
  p.upper = Vector::Constant(n_y, kLimit);
  p.lower = -p.upper;
  p.hold = Vector::Zero(n_y);
  p.noise = Vector::Constant(n_y, plant.noise);
  p.deviation.resize(n_y);
  p.start_input = Vector::Zero(n_u);
  p.closed = static_cast<bool>(plant.control);
  p.most_rows = plant.rows;
  p.seed = seed;

  auto engine = seededEngine(seed, {7});
  std::normal_distribution<double> normal(0.0, plant.noise);
  std::vector<Vector> sent;
  std::vector<std::vector<double>> x(plant.lags.size(),
                                     std::vector<double>(static_cast<std::size_t>(n_u), 0.0));
  Vector y(n_y);
  Measurement now;
  const auto measure = [&](Index k) {
    for (Index i = 0; i < n_y; ++i) {
      y[i] = plant.load(k, i);
      for (Index j = 0; j < n_u; ++j) {
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
        const Lag& lag = plant.lags[a][b];
        const Index at = k - 1 - lag.dead;
        const double u = at >= 0 ? sent[static_cast<std::size_t>(at)][j] : 0.0;
        if (lag.integrating)
          x[a][b] += lag.gain * u;
        else
          x[a][b] += (1.0 - std::exp(-1.0 / lag.time)) * (lag.gain * u - x[a][b]);
        y[i] += x[a][b];
      }
    }
    now.header.step = static_cast<std::uint32_t>(k);
    now.outputs = y.unaryExpr([&](double value) { return value + normal(engine); });
    now.disturbances.resize(0);
    now.input_applied = sent.empty() ? Vector::Zero(n_u) : sent.back();
  };
  const auto present = [&] {
    Vector u = Vector::Zero(n_u);
    if (plant.control) u[0] = plant.control(now.outputs[0]);
    return u;
  };
  PlantRecord watched(info);
  Index k = 0;
  for (; k < 60; ++k) {
    measure(k);
    Vector u = present();
    if (k == 0) u[0] += plant.first_input;
    watched.add(now, u);
    sent.push_back(u);
  }
  Outcome outcome;
  for (Index i = 0; i < n_y; ++i)
    p.deviation[i] = std::sqrt(
        (watched.outputs().col(i).array() - watched.outputs().col(i).mean()).square().mean());
  PlantTest test(p, watched);
  for (; test.end() == TestEnd::kNone; ++k) {
    measure(k);
    outcome.left += (y.cwiseAbs().array() > kLimit).any();
    const Vector asked = present(), u = test.choose(now, asked);
    outcome.moved_far +=
        std::abs(now.outputs[n_y - 1]) > 0.5 * kLimit && (u - asked).cwiseAbs().maxCoeff() > 1e-9;
    test.add(now, u);
    sent.push_back(u);
  }
  outcome.end = test.end();
  outcome.turned = test.turned();
  outcome.gains = Matrix::Zero(n_y, n_u);
  for (std::size_t i = 0; i < test.fits().size(); ++i)
    for (Index j = 0; j < n_u; ++j)
      outcome.gains(static_cast<Index>(i), j) =
          test.fits()[i].elements[static_cast<std::size_t>(j)].element.gain;
  return outcome;
}

/// Loads that wander about 0, of a spread and a time in samples.
std::function<double(Index, Index)> wandering(std::mt19937_64& engine, Index n_y, Index rows,
                                              double most = 0.7) {
  std::vector<std::vector<double>> loads(static_cast<std::size_t>(n_y));
  for (auto& load : loads) {
    const double time = 20.0 * std::pow(10.0, uniform(engine)),
                 spread = 0.02 + 0.2 * uniform(engine), stay = std::exp(-1.0 / time);
    std::normal_distribution<double> normal(0.0, spread * std::sqrt(1.0 - stay * stay));
    double now = 0.0;
    for (Index k = 0; k < rows; ++k)
      load.push_back(std::clamp(now = stay * now + normal(engine), -most, most));
  }
  return [loads](Index k, Index output) {
    return loads[static_cast<std::size_t>(output)][static_cast<std::size_t>(k)];
  };
}

/// One or two inputs, dead times of up to three times the lag; an input's range moves an output by
/// 4 to 20 times the room that limits leave.
Plant drawn(std::uint64_t seed, Index rows) {
  auto engine = seededEngine(seed, {99});
  Plant plant;
  const int n = uniform(engine) < 0.6 ? 1 : 2;
  plant.lags.resize(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      Lag lag;
      lag.time = 3.0 * std::pow(10.0, uniform(engine));
      lag.dead = uniform(engine) < 0.3 ? 0 : static_cast<Index>(3.0 * lag.time * uniform(engine));
      lag.gain = (uniform(engine) < 0.5 ? -0.2 : 0.2) * std::pow(5.0, uniform(engine));
      if (i != j) lag.gain *= 0.6 * uniform(engine);
      plant.lags[static_cast<std::size_t>(i)].push_back(lag);
    }
  plant.load = wandering(engine, n, rows + 100);
  plant.noise = 0.005 * std::pow(10.0, uniform(engine));
  plant.rows = rows;
  return plant;
}

/// Of plants without an integrator, under loads that may take 0.7 of the room by themselves.
TEST(PlantTest, KeepsTheLimitsWhateverThePlant) {
  const bool many = std::getenv("FMBPC_LONG_TESTS") != nullptr;
  int ended = 0, left = 0;
  const std::uint64_t last = many ? 120 : 12;
  for (std::uint64_t seed = 1; seed <= last; ++seed) {
    const Outcome outcome = tested(drawn(seed, many ? 2500 : 800), seed);
    left += outcome.left > 0;
    EXPECT_NE(outcome.end, TestEnd::kNeedsLoop) << seed;
    ended += outcome.end == TestEnd::kEnough;
  }
  EXPECT_LE(left, many ? 4 : 0);
  EXPECT_GE(ended, many ? 60 : 4);
}

TEST(PlantTest, AnIntegratorIsBalancedWhereItsInputIsOnTheWhole) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    auto engine = seededEngine(seed, {99});
    Plant plant;
    plant.lags = {{{0.02, 0.0, 2, true}}};
    plant.load = wandering(engine, 1, 1100, 0.2);
    plant.control = [](double y) { return -3.0 * y; };
    plant.first_input = 8.0;  // in the first sample that was watched
    plant.rows = 1000;
    const Outcome outcome = tested(plant, seed);
    EXPECT_EQ(outcome.left, 0) << seed;
    EXPECT_GT(outcome.gains(0, 0), 0.01) << seed;
    EXPECT_LT(outcome.turned, 30) << seed;
  }
}

TEST(PlantTest, RestsWhileAnOutputWithoutAModelIsFarAway) {
  Plant plant;
  plant.lags = {{{1.0, 5.0, 1}}, {{0.0, 5.0, 1}}};
  plant.load = [](Index k, Index output) { return output == 1 && k % 500 > 400 ? 0.8 : 0.0; };
  plant.rows = 1000;
  int moved = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Outcome outcome = tested(plant, seed);
    moved += outcome.moved_far > 0;
    EXPECT_NEAR(outcome.gains(0, 0), 1.0, 0.1) << seed;
  }
  EXPECT_LE(moved, 1);  // an element of noise, by chance
}

}  // namespace plant_test_test
}  // namespace fpc
