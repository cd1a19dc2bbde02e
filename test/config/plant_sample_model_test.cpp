// The plant's equations as a controller's model: the same samples as the simulated plant.
#include "config/plant_sample_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "runtime/factory.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace config_plant_sample_model_test {

/// Largest distance of the outputs over a run under inputs that swing, relative to the start.
double worstError(const LoopFile& loop, std::uint32_t samples, int integration_steps) {
  Simulation plant(loop.simulation);
  const auto model = makePlantSampleModel(loop.simulation, integration_steps);
  Measurement now = plant.measurement();
  Vector state(model->stateSize());
  model->rest(now.outputs, now.input_applied, now.disturbances, state);
  double worst = 0.0;
  for (std::uint32_t k = 0; k < samples; ++k) {
    const Vector input =
        loop.simulation.actuator.initial * (1.0 + 0.1 * std::sin(0.3 * static_cast<double>(k)));
    EXPECT_TRUE(model->step(input, now.disturbances, state));
    now = plant.advance(input);
    for (Eigen::Index i = 0; i < now.outputs.size(); ++i)
      worst = std::max(worst, std::abs(state[model->outputState(i)] / now.outputs[i] - 1.0));
  }
  return worst;
}

TEST(PlantSampleModel, ADifferenceEquationIsTakenAsItIs) {
  EXPECT_LE(worstError(readLoop("surge_tank_up"), 200, 1), 1e-12);
}

// The simulator's own error must not be mistaken for the model's: at its usual tolerance it is
// 2e-7.
TEST(PlantSampleModel, FourStepsOfRungeAndKuttaAreTheReactor) {
  const Overrides precise{{"plant.integrator.relative_tolerance", "1e-13"},
                          {"plant.integrator.absolute_tolerance", "1e-13"}};
  EXPECT_LE(worstError(readLoop("mimo_cstr_tracking", precise), 40, 4), 1e-9);
}

TEST(PlantSampleModel, TheLocalLoopInsideThePlantIsPartOfIt) {
  LoopFile loop = readLoop("cstr_excite");
  ASSERT_EQ(loop.simulation.parameters.at("compensator_gain"), 3.0);
  loop.simulation.outputs = {"CA", "T"};
  loop.simulation.output_delay_s = {0.0, 0.0};
  loop.simulation.noise_std = Vector::Zero(2);
  EXPECT_LE(worstError(loop, 100, 8), 1e-6);
}

TEST(PlantSampleModel, KnowsHowLateTheOutputsAreMeasured) {
  LoopFile loop = readLoop("cstr_tracking");
  EXPECT_EQ(makePlantSampleModel(loop.simulation, 4)->delaySteps(), 5);
  EXPECT_EQ(makePlantSampleModel(readLoop("surge_tank_up").simulation, 1)->delaySteps(), 0);
  loop.simulation.output_delay_s = {33.0};  // 5.5 samples
  EXPECT_THROW(makePlantSampleModel(loop.simulation, 4), InputError);
}

// What the law with the true equations makes of late measurements: the load is half gone.
TEST(PlantSampleModel, LateMeasurementsCorrectTheStateOfTheirOwnTime) {
  const auto squares = [](const char* name) {
    double sum = 0.0;
    for (const auto& sample : runLoop(readLoop(name)).samples) {
      const double error = sample.measurement.outputs[0] - 0.1;
      sum += error * error;
    }
    return sum;
  };
  EXPECT_LE(squares("cstr_disturbance_nmpc"), 0.5 * squares("cstr_disturbance"));
}

TEST(PlantSampleModel, StatesThatAreNotMeasuredRestUnderTheInputInForce) {
  const LoopFile loop = readLoop("surge_tank_up");
  const auto model = makePlantSampleModel(loop.simulation, 1);
  Vector state(model->stateSize());
  const double current = 2e-3;
  model->rest(Vector::Constant(1, 0.2), Vector::Constant(1, current), Vector(0), state);
  EXPECT_EQ(state[0], 0.2);
  EXPECT_NEAR(state[1], 0.1 * current, 1e-12);  // k1 I / k0
}

// With the concentration held the reactor's temperature runs away by itself: 7 1/min at 0.1 mol/l.
TEST(PlantSampleModel, AStateThatWouldRunAwayIsFoundAtRest) {
  const LoopFile loop = readLoop("cstr_tracking");
  const auto model = makePlantSampleModel(loop.simulation, 4);
  const Vector input = Vector::Constant(1, 103.4066);
  Vector state(model->stateSize());
  for (const double shown : {0.099, 0.1001, 0.101}) {
    model->rest(Vector::Constant(1, shown), input, Vector(0), state);
    EXPECT_EQ(state[0], shown);
    EXPECT_NEAR(state[1], 438.5444, 0.5);
    const double temperature = state[1];
    ASSERT_TRUE(model->step(input, Vector(0), state));
    EXPECT_NEAR(state[1], temperature, 1e-9) << shown;
  }
}

/// Sum of (y_r - y)^2 with noise of half a percent of the setpoints' span.
double costUnderNoise(const std::string& name, const std::string& std, const std::string& seed) {
  const RunRecord record = runLoop(readLoop(name, {{"noise.std.CA", std}, {"seed", seed}}));
  EXPECT_EQ(record.samples.size(), 401U) << name << " " << seed;
  double sum = 0.0;
  for (const auto& sample : record.samples)
    sum += std::pow(sample.state.outputs[0] - sample.tracking.reference[0], 2);
  return sum;
}

// Seeds apart from those that the observer was chosen on.
TEST(PlantSampleModel, TheLawToldTheTruthStandsTheNoiseThatItsBaselineStands) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"cstr_tracking", "0.0005"}, {"cstr_disturbance", "0.0005"}, {"cstr_small_steps", "0.0002"}};
  for (const auto& [name, std] : cases)
    for (const char* seed : {"1", "2", "3"})
      EXPECT_LE(costUnderNoise(name + "_nmpc", std, seed),
                costUnderNoise(name + "_pi_best", std, seed))
          << name << " " << seed;
}

TEST(PlantSampleModel, PlantsThatRememberMoreThanTheirStatesAreRefused) {
  const LoopFile file = readLoop("column_imc");
  try {
    makePlantSampleModel(file.simulation, 4);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("nmpc"), std::string::npos) << e.what();
  }
}

TEST(PlantSampleModel, AnExternalPlantHasNoEquationsToPredictWith) {
  EXPECT_THROW(readLoop("example_external", {{"controller", "{type: nmpc}"}}), InputError);
}

/// With the true equations and no disturbance nothing is left between prediction and measurement.
TEST(PlantSampleModel, TheBaselineReachesItsSetpointsOnThePlantItKnows) {
  const LoopFile loop =
      readLoop("surge_tank_up", {{"controller", "{type: nmpc, horizon_steps: 20}"}});
  const RunRecord record = runLoop(loop);
  EXPECT_NEAR(record.samples.back().state.outputs[0], 0.20, 1e-9);
}

}  // namespace config_plant_sample_model_test
}  // namespace fpc
