// Loop files whose plant is an identified model, and loops rehearsed on theirs.
#include <cmath>

#include "runtime/loop_fixture.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace config_model_plant_loop_test {

using ModelPlantLoop = LoopFolder;

std::string onModel(const std::string& more) {
  return "plant: {type: model, model: cstr_auto.yaml" + more +
         "}\nsampling: {sample_time_s: 6, duration_h: 0.5}\n"
         "setpoint: {schedule: [{time_h: 0.1, CA: 0.09}]}\n"
         "controller: {type: pi, loops: [{input: q_c, output: CA, kp: 60, ki_per_h: 1800}]}\n";
}

TEST_F(ModelPlantLoop, IsReadAndRuns) {
  const LoopFile loop = readLoop(write("a.yaml", onModel("")));
  EXPECT_GT(loop.simulation.noise_std[0] + loop.simulation.disturbance_noise_std.maxCoeff(), 0.0);
  EXPECT_NEAR(loop.plant_info.inputs[0].upper, 114.41120656127228, 1e-12) << "of the data";
  const Summary summary = summarize(loop, runLoop(loop), 0.0);
  EXPECT_TRUE(summary.complete);
  EXPECT_NEAR(runLoop(loop).samples.back().measurement.outputs[0], 0.09, 0.004);
}

TEST_F(ModelPlantLoop, RangesOfTheFileGoOverThoseOfTheData) {
  const LoopFile loop =
      readLoop(write("a.yaml", onModel(", ranges: {q_c: [0, 200], CA: [0, 0.5]}")));
  EXPECT_EQ(loop.plant_info.inputs[0].upper, 200.0);
  EXPECT_EQ(loop.plant_info.outputs[0].lower, 0.0);
  expectWords(errorOf([&] { readLoop(write("b.yaml", onModel(", ranges: {q_x: [0, 1]}"))); }),
              {"b.yaml:1", "plant.ranges.q_x", "unknown"});
  expectWords(errorOf([&] { readLoop(write("c.yaml", onModel(", ranges: {q_c: [2, 1]}"))); }),
              {"c.yaml:1", "plant.ranges.q_c", "[2, 1]"});
}

TEST_F(ModelPlantLoop, WhatIsNoModelIsNamed) {
  std::string text = onModel("");
  text.replace(text.find("cstr_auto"), 9, "nowhere");
  expectWords(errorOf([&] { readLoop(write("a.yaml", text)); }), {"plant.model", "nowhere.yaml"});
  text = onModel("");
  text.replace(text.find("sample_time_s: 6"), 16, "sample_time_s: 9");
  expectWords(errorOf([&] { readLoop(write("b.yaml", text)); }), {"sampling.sample_time_s", "6"});
}

/// A loop on a plant that nobody can simulate, beside it a model of other ranges.
std::string external(const std::string& more) {
  return "plant:\n  type: external\n  name: reactor\n"
         "  outputs: [{name: CA, unit: mol/l, lower: 0, upper: 0.5}]\n"
         "  inputs: [{name: q_c, unit: l/min, lower: 0, upper: 200}]\n"
         "gateway: {type: float64}\nsampling: {sample_time_s: 6, duration_h: 0.5}\n"
         "setpoint: {initial: {CA: 0.09}}\nmodel: {file: cstr_auto.yaml}\n"
         "actuator: {initial: {q_c: 95}}\n" +
         more;
}

TEST_F(ModelPlantLoop, AnExternalPlantIsRehearsedOnTheModel) {
  const std::string file =
      write("a.yaml", external("controller: {type: fmbpc, law: general, coincidence_steps: 12}\n"));
  EXPECT_TRUE(readLoop(file).external_plant);
  const LoopFile loop = readLoop(file, {{"plant.type", "model"}});
  EXPECT_FALSE(loop.external_plant);
  EXPECT_FALSE(loop.gateway.enabled());
  EXPECT_EQ(loop.plant_info.inputs[0].upper, 200.0);
  EXPECT_EQ(loop.plant_info.outputs[0].upper, 0.5);
  const RunRecord record = runLoop(loop);
  EXPECT_TRUE(summarize(loop, record, 0.0).complete);
  EXPECT_NEAR(record.samples.back().measurement.outputs[0], 0.09, 0.004);
  const LoopFile again = parseLoop(loop.resolved, "a");  // the text that nodes get
  EXPECT_EQ(again.simulation.initial_state, loop.simulation.initial_state);
  EXPECT_EQ(runLoop(again).samples.back().measurement.outputs,
            record.samples.back().measurement.outputs);
}

TEST_F(ModelPlantLoop, KeysOverItCountAsEver) {
  const std::string file =
      write("a.yaml", external("controller: {type: fmbpc, law: general, coincidence_steps: 12}\n"));
  const LoopFile loop =
      readLoop(file, {{"plant.type", "model"}, {"plant.ranges.q_c", "[50, 150]"}, {"seed", "7"}});
  EXPECT_EQ(loop.plant_info.inputs[0].upper, 150.0);
  EXPECT_EQ(loop.simulation.noise_seed, 7U);
}

TEST_F(ModelPlantLoop, WithoutAModelThereIsNothingToRehearseOn) {
  std::string text = external(
      "controller: {type: pi, loops: [{input: q_c, output: CA, kp: 60, ki_per_h: 1800}]}\n");
  text.erase(text.find("model:"), std::string("model: {file: cstr_auto.yaml}\n").size());
  const std::string file = write("a.yaml", text);
  expectWords(errorOf([&] { readLoop(file, {{"plant.type", "model"}}); }), {"model.file"});
}

TEST_F(ModelPlantLoop, UnitsThatTheModelDoesNotStateRefuseNoLoop) {
  std::string model =
      "name: m\nsample_time_s: 6\noutputs: {CA: UNIT}\ninputs: {q_c: ''}\nsubmodels:\n"
      "  CA:\n    antecedents: []\n    regressors: [CA(k), q_c(k)]\n"
      "    rules: [{then: {CA(k): 0.9, q_c(k): 1e-4, offset: 0}}]\n";
  const auto with = [&](const std::string& unit) {
    std::string text = model;
    text.replace(text.find("UNIT"), 4, unit);
    std::string loop = external("controller: {type: fmbpc, law: general}\n");
    loop.replace(loop.find("cstr_auto.yaml"), 14, write("m" + unit + ".yaml", text));
    return write("loop" + unit + ".yaml", loop);
  };
  EXPECT_EQ(readLoop(with("''")).model.outputs[0].unit, "mol/l");
  expectWords(errorOf([&] { readLoop(with("kg")); }), {"CA", "'mol/l'", "'kg'"});
}

}  // namespace config_model_plant_loop_test
}  // namespace fpc
