// A matrix of lags with dead times against answers known on paper.
#include "plant/transfer_matrix.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "fmbpc/base/input_error.hpp"
#include "plant/simulation.hpp"

namespace fpc {
namespace plant_transfer_matrix_test {

/// One element from u (and one from d) in minutes.
TransferMatrix single(double gain, double tau, double theta, double tau_2 = 0.0) {
  TransferMatrix m;
  m.name = "single";
  m.outputs = {{"y", "-", 0.0, -1e6, 1e6}};
  m.inputs = {{"u", "-", 0.0, -1e6, 1e6}};
  m.elements = {{"y", "u", gain, tau, theta, tau_2}};
  return m;
}

/// y at the end of each sample for the inputs given.
std::vector<double> answer(const TransferMatrix& matrix, const std::vector<double>& inputs,
                           double sample_time_min) {
  const TransferMatrixPlant plant(matrix);
  const auto stepper = plant.makeStepper(60.0 * sample_time_min);
  Vector x = Vector::Zero(static_cast<Eigen::Index>(plant.description().states.size()));
  Vector d(1);
  d << matrix.elements[0].gain;
  stepper->reset(Vector::Zero(1), d);
  std::vector<double> y;
  for (const double u : inputs) {
    stepper->advance(x, Vector::Constant(1, u), d);
    y.push_back(x[0]);
  }
  return y;
}

double firstOrderStep(double t, double tau) { return t <= 0.0 ? 0.0 : 1.0 - std::exp(-t / tau); }

TEST(TransferMatrix, FollowsTheStepResponseOnPaperForAnyDeadTime) {
  for (const double theta : {0.0, 0.3, 1.0, 2.5, 7.0, 7.123456}) {
    const auto y = answer(single(2.5, 4.0, theta), std::vector<double>(40, 1.0), 1.0);
    for (std::size_t k = 0; k < y.size(); ++k)
      EXPECT_NEAR(y[k], 2.5 * firstOrderStep(static_cast<double>(k + 1) - theta, 4.0), 1e-13)
          << "theta " << theta << ", sample " << k;
  }
}

// The slower lag alone is left when the other one is ten thousand times as fast.
TEST(TransferMatrix, StaysFiniteForLagsOfAnyRatio) {
  for (const auto& [tau, tau_2] : {std::pair{0.001, 10.0}, std::pair{10.0, 0.001}}) {
    const auto y = answer(single(2.0, tau, 0.0, tau_2), std::vector<double>(40, 1.0), 1.0);
    for (std::size_t k = 0; k < y.size(); ++k) {
      const double t = static_cast<double>(k + 1);
      const double paper = 2.0 * (1.0 - (10.0 * std::exp(-t / 10.0)) / (10.0 - 0.001));
      EXPECT_NEAR(y[k], paper, 1e-12) << tau << " " << k;
    }
  }
}

TEST(TransferMatrix, FollowsTheSecondOrderStepResponseAlsoWithEqualLags) {
  const double theta = 0.7;
  for (const double tau_2 : {1.0, 4.0, 4.0 + 1e-9, 9.0}) {
    const auto y = answer(single(1.0, 4.0, theta, tau_2), std::vector<double>(40, 1.0), 1.0);
    for (std::size_t k = 0; k < y.size(); ++k) {
      const double t = std::max(0.0, static_cast<double>(k + 1) - theta);
      const double paper =
          std::abs(tau_2 - 4.0) < 1e-6
              ? 1.0 - (1.0 + t / 4.0) * std::exp(-t / 4.0)
              : 1.0 - (4.0 * std::exp(-t / 4.0) - tau_2 * std::exp(-t / tau_2)) / (4.0 - tau_2);
      EXPECT_NEAR(y[k], paper, 2e-9) << "tau_2 " << tau_2 << ", sample " << k;
    }
  }
}

TEST(TransferMatrix, GivesTheSameOutputsWhenTheHoldIsSampledFiner) {
  constexpr unsigned kSeed = 11;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 generator(kSeed);
  std::normal_distribution<double> any;
  const TransferMatrix matrix = single(-3.0, 5.0, 2.37, 1.5);
  std::vector<double> coarse(60), fine;
  for (double& u : coarse) u = any(generator);
  constexpr std::size_t kParts = 7;
  for (const double u : coarse) fine.insert(fine.end(), kParts, u);
  const auto y = answer(matrix, coarse, 1.0), y_fine = answer(matrix, fine, 1.0 / kParts);
  for (std::size_t k = 0; k < y.size(); ++k)
    EXPECT_NEAR(y[k], y_fine[kParts * k + kParts - 1], 1e-12) << "sample " << k;
}

SimulationParams columnParams(std::uint32_t samples) {
  SimulationParams p;
  p.plant = "distillation_column";
  const auto plant = makePlant(p.plant);
  const auto nominal = [](const std::vector<Quantity>& quantities) {
    Vector v(static_cast<Eigen::Index>(quantities.size()));
    for (std::size_t i = 0; i < quantities.size(); ++i)
      v[static_cast<Eigen::Index>(i)] = quantities[i].nominal;
    return v;
  };
  p.initial_state = nominal(plant->description().states);
  p.disturbance_nominal = nominal(plant->description().disturbances);
  p.actuator.limits = {Vector::Constant(2, -2.0), Vector::Constant(2, 2.0),
                       Vector::Constant(2, std::numeric_limits<double>::infinity())};
  p.actuator.initial = p.actuator.fallback = Vector::Zero(2);
  p.sample_time_s = 60.0;
  p.samples = samples;
  return p;
}

TEST(TransferMatrix, WoodBerryAnswersInputsAndFeedAsOnPaper) {
  SimulationParams params = columnParams(40);
  params.disturbance_commands = {{0.0, {0, {"F"}, {0.2}, CommandMode::kOverride}}};
  Simulation column(params);
  const Vector u = (Vector(2) << 0.1, 0.05).finished();
  for (int k = 1; k <= 40; ++k) {
    const Measurement& m = column.advance(u);
    const double t = k;
    EXPECT_NEAR(m.outputs[0],
                96.25 + 0.1 * 12.8 * firstOrderStep(t - 1, 16.7) -
                    0.05 * 18.9 * firstOrderStep(t - 3, 21.0) +
                    0.2 * 3.8 * firstOrderStep(t - 8, 14.9),
                1e-11);
    EXPECT_NEAR(m.outputs[1],
                0.5 + 0.1 * 6.6 * firstOrderStep(t - 7, 10.9) -
                    0.05 * 19.4 * firstOrderStep(t - 3, 14.4) +
                    0.2 * 4.9 * firstOrderStep(t - 3, 13.2),
                1e-11);
  }
}

TEST(TransferMatrix, AGainThatJumpsWhileRunningMovesTheOutputWithItsLag) {
  SimulationParams params = columnParams(400);
  Simulation column(params);
  const Vector u = (Vector(2) << 0.1, 0.0).finished();
  for (int k = 0; k < 200; ++k) column.advance(u);
  const double before = column.measurement().outputs[0];
  EXPECT_NEAR(before, 96.25 + 1.28, 1e-4);
  EXPECT_EQ(column.command({0, {"gain/y_D/L"}, {15.36}, CommandMode::kOverride}), 201U);
  column.advance(u);  // the command acts from the next sample
  const double at = column.measurement().outputs[0];
  column.advance(u);
  EXPECT_NEAR(column.measurement().outputs[0] - at, 0.256 * firstOrderStep(1.0, 16.7), 1e-6);
  for (int k = 0; k < 190; ++k) column.advance(u);
  EXPECT_NEAR(column.measurement().outputs[0], 96.25 + 1.536, 1e-4);
}

TEST(TransferMatrix, IsTheSameRunAgainAfterAReset) {
  Simulation column(columnParams(30));
  const Vector u = (Vector(2) << 0.1, -0.1).finished();
  for (int k = 0; k < 20; ++k) column.advance(u);
  const Vector first = column.state().state;
  column.reset(2);
  for (int k = 0; k < 20; ++k) column.advance(u);
  EXPECT_EQ(first, column.state().state);
}

TEST(TransferMatrix, TellsNobodyItsGains) {
  const auto about = makePlant("distillation_column")->description();
  EXPECT_EQ(about.disturbances.size(), 7U);
  EXPECT_EQ(about.hidden_disturbances.size(), 6U);
}

// A unit may be small: Pa for a pressure, a gain of ten million.
TEST(TransferMatrix, TakesGainsOfAnySize) {
  const auto y = answer(single(2.5e7, 4.0, 0.0), std::vector<double>(400, 1.0), 1.0);
  EXPECT_NEAR(y.back(), 2.5e7, 1.0);
  const auto about = TransferMatrixPlant(single(2.5e7, 4.0, 0.0)).description();
  EXPECT_GT(about.disturbances.back().upper, 2.5e7) << about.disturbances.back().name;
}

TEST(TransferMatrix, RefusesWhatIsNoMatrix) {
  const auto refused = [](const std::function<void(TransferMatrix&)>& spoil) {
    TransferMatrix m = woodBerry();
    spoil(m);
    EXPECT_THROW(TransferMatrixPlant plant(m), InputError);
  };
  refused([](auto& m) { m.elements[0].time_constant = 0.0; });
  refused([](auto& m) { m.elements[0].dead_time = -1.0; });
  refused([](auto& m) { m.elements[0].gain = std::nan(""); });
  refused([](auto& m) { m.elements[0].from = "nobody"; });
  refused([](auto& m) { m.elements[1] = m.elements[0]; });
  refused([](auto& m) { m.elements.resize(3); });
  refused([](auto& m) { m.inputs[0].name = "F"; });
  refused([](auto& m) {
    m.outputs[1].name = m.elements[5].output = m.elements[4].output = m.elements[3].output =
        "y_D_V";
  });  // two states y_D_V
  TransferMatrix slow = single(1.0, 1.0, 1e9);
  EXPECT_THROW(TransferMatrixPlant(slow).makeStepper(60.0), InputError);
}

}  // namespace plant_transfer_matrix_test
}  // namespace fpc
