// An identified model as a plant: what it does, and that its noise is what the model leaves of it.
#include "plant/model_plant.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "fmbpc/base/input_error.hpp"
#include "plant/simulation.hpp"

namespace fpc {
namespace plant_model_plant_test {

/// y(k+1) = 1.5 y(k) - 0.56 y(k-1) + 0.06 u(k-3), two equal rules; poles 0.8 and 0.7, gain 1.
TsModel secondOrder() {
  TsModel m;
  m.name = "second";
  m.sample_time_s = 2.0;
  m.outputs = {{"y", "", -10.0, 10.0}};
  m.inputs = {{"u", "", -10.0, 10.0}};
  OutputModel s;
  s.antecedents = {{SignalKind::kOutput, 0, 0}};
  s.regressors = {
      {SignalKind::kOutput, 0, 0}, {SignalKind::kOutput, 0, 1}, {SignalKind::kInput, 0, 3}};
  Rule rule;
  rule.coefficients = Eigen::Vector3d(1.5, -0.56, 0.06);
  for (const double centre : {-5.0, 5.0}) {
    rule.antecedents = {{MembershipShape::kGaussian, {centre, 4.0}}};
    s.rules.push_back(rule);
  }
  m.submodels = {s};
  return m;
}

ModelErrors errors(double one_step, double free_run) {
  return {Vector::Constant(1, one_step), Vector::Constant(1, free_run)};
}

SimulationParams paramsOf(const TsModel& model, const ModelErrors& known, std::uint64_t seed) {
  SimulationParams p;
  p.factory = [=](const PlantParameters&) {
    return std::make_unique<ModelPlant>(model, known, std::vector<SignalInfo>{});
  };
  const auto plant = makePlant(p);
  const PlantDescription& about = plant->description();
  const auto one = [](double v) { return Vector(Vector::Constant(1, v)); };
  p.initial_state = one(about.states[0].nominal);
  p.actuator.limits = {one(-10.0), one(10.0), one(std::numeric_limits<double>::infinity())};
  p.actuator.initial = p.actuator.fallback = one(about.inputs[0].nominal);
  p.disturbance_nominal = one(0.0);
  p.noise_std = one(about.noise_std.at("y"));
  p.disturbance_noise_std = one(about.noise_std.at("load/y"));
  p.noise_seed = seed;
  p.sample_time_s = model.sample_time_s;
  return p;
}

/// Measured outputs under a random input that the caller gets too.
Vector run(const SimulationParams& params, int samples, Vector& inputs) {
  Simulation plant(params);
  std::mt19937_64 dice(3);
  Vector y(samples);
  inputs.resize(samples);
  for (int k = 0; k < samples; ++k) {
    if (k % 7 == 0)
      inputs[k] = 6.0 * uniform(dice) - 3.0;
    else
      inputs[k] = inputs[k - 1];
    y[k] = plant.measurement().outputs[0];
    plant.advance(Vector::Constant(1, inputs[k]));
  }
  return y;
}

/// One step ahead from measured values, or from the simulated ones.
double rmse(const Vector& y, const Vector& u, bool free) {
  Vector predicted = y;
  double squares = 0.0;
  for (Eigen::Index k = 3; k + 1 < y.size(); ++k) {
    const Vector& past = free ? predicted : y;
    const double next = 1.5 * past[k] - 0.56 * past[k - 1] + 0.06 * u[k - 3];
    if (free) predicted[k + 1] = next;
    squares += std::pow(y[k + 1] - next, 2);
  }
  return std::sqrt(squares / static_cast<double>(y.size() - 4));
}

TEST(ModelPlant, MovesAsItsModelSays) {
  Vector u;
  const Vector y = run(paramsOf(secondOrder(), {}, 1), 200, u);
  EXPECT_LT(rmse(y, u, false), 1e-14);
  EXPECT_GT(y.cwiseAbs().maxCoeff(), 0.5);
}

TEST(ModelPlant, StartsAtRestWhereverItsOutputStarts) {
  SimulationParams p = paramsOf(secondOrder(), {}, 1);
  p.initial_state[0] = 2.0;
  p.actuator.initial[0] = 2.0;  // gain 1
  Simulation plant(p);
  for (int k = 0; k < 10; ++k)
    EXPECT_NEAR(plant.advance(Vector::Constant(1, 2.0)).outputs[0], 2.0, 1e-12);
}

/// What is identified again from a long run has the errors that were stated, whichever of the two
/// kinds of noise they are made of.
TEST(ModelPlant, ItsNoiseIsWhatTheModelLeavesUnexplained) {
  for (const auto& [one_step, free_run] : {std::pair{0.1, 0.3}, {0.1, 0.1}, {0.1, 0.06}}) {
    Vector u;
    const Vector y = run(paramsOf(secondOrder(), errors(one_step, free_run), 5), 60000, u);
    EXPECT_NEAR(rmse(y, u, false), one_step, 0.02 * one_step) << free_run;
    EXPECT_NEAR(rmse(y, u, true), free_run, 0.04 * free_run) << free_run;
  }
}

/// Below sqrt(1 / (1 + a1^2 + a2^2)) of the one-step error no noise makes the free run that good.
TEST(ModelPlant, WhereNoNoiseMakesBothTheOneStepErrorIsMet) {
  Vector u;
  const Vector y = run(paramsOf(secondOrder(), errors(0.1, 0.01), 5), 60000, u);
  EXPECT_NEAR(rmse(y, u, false), 0.1, 0.002);
}

TEST(ModelPlant, TheSameSeedGivesTheSameBits) {
  Vector u;
  const Vector a = run(paramsOf(secondOrder(), errors(0.1, 0.3), 5), 50, u),
               b = run(paramsOf(secondOrder(), errors(0.1, 0.3), 5), 50, u),
               c = run(paramsOf(secondOrder(), errors(0.1, 0.3), 6), 50, u);
  EXPECT_EQ(a, b);
  EXPECT_NE(a, c);
}

TEST(ModelPlant, BeyondItsDataItSaysNothing) {
  TsModel runaway = secondOrder();
  for (Rule& rule : runaway.submodels[0].rules) rule.coefficients[0] = 2.0;
  SimulationParams p = paramsOf(runaway, {}, 1);
  p.initial_state[0] = 1.0;
  Simulation plant(p);
  for (int k = 0; k < 200 && plant.trouble().empty(); ++k) plant.advance(Vector::Zero(1));
  EXPECT_NE(plant.trouble().find("y leaves"), std::string::npos) << plant.trouble();
  EXPECT_LE(std::abs(plant.measurement().outputs[0]), 30.0);
}

TEST(ModelPlant, AnotherSampleTimeIsRefused) {
  SimulationParams p = paramsOf(secondOrder(), {}, 1);
  p.sample_time_s = 3.0;
  EXPECT_THROW(Simulation{p}, InputError);
}

TEST(ModelPlant, ItsNominalPointIsASteadyState) {
  TsModel shifted = secondOrder();
  shifted.inputs[0].lower = 2.0;
  shifted.inputs[0].upper = 4.0;
  const ModelPlant plant(shifted, {}, {});
  EXPECT_NEAR(plant.description().states[0].nominal, 3.0, 1e-9);
  EXPECT_NEAR((*restOf(shifted, Vector::Constant(1, -1.0), Vector(0)))[0], -1.0, 1e-9);
}

}  // namespace plant_model_plant_test
}  // namespace fpc
