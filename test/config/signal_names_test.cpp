// Names of signals are keys and columns: what would stand for two things is refused.
#include <gtest/gtest.h>

#include "runtime/loop_fixture.hpp"

namespace fpc {
namespace config_signal_names_test {

class SignalNames : public LoopFolder {
 protected:
  /// What reading a matrix with two outputs, an input and a disturbance of these names says.
  std::string errorFor(const std::string& first, const std::string& second,
                       const std::string& input, const std::string& disturbance = "d") {
    const auto quoted = [](const std::string& name) { return "'" + name + "'"; };
    const std::string a = quoted(first), b = quoted(second), u = quoted(input),
                      d = quoted(disturbance);
    const auto element = [](const std::string& output, const std::string& from) {
      return "    - {output: " + output + ", from: " + from + ", gain: 1, time_constant_min: 5}\n";
    };
    file_ = write("loop.yaml",
                  "sampling: {sample_time_s: 60, duration_h: 1}\ncontroller:\n  type: pi\n  loops: "
                  "[{input: " +
                      u + ", output: " + a + ", kp: 1, ki_per_h: 1}]\nplant:\n" +
                      "  type: transfer_matrix\n  matrix:\n    outputs: [{name: " + a +
                      "}, {name: " + b + "}]\n    inputs: [{name: " + u +
                      "}]\n    disturbances: [{name: " + d + "}]\n    elements:\n" + element(b, u) +
                      element(a, d) + element(a, u));
    return errorOf([&] { readLoop(file_); });
  }
  std::string file_;
};

const char kNamesTaken[] = "nothing was thrown";

TEST_F(SignalNames, WhatStandsForOneThingPasses) {
  EXPECT_EQ(errorFor("A", "B", "u"), kNamesTaken);
  EXPECT_EQ(errorFor("TIC 101.PV", "B_u", "seed"), kNamesTaken);
}

TEST_F(SignalNames, AHeaderMustBeAbleToCarryThem) {
  for (const char* name : {"A,b", "A[1]", "A\"", " A", "A "})
    expectWords(errorFor(name, "B", "u"),
                {file_ + ":8: plant.matrix.outputs[0].name: expected a name without comma"});
  expectWords(errorFor("A", "B", "u,"), {":9: plant.matrix.inputs[0].name"});
  expectWords(errorFor("A", "B", "u", "d]"), {":10: plant.matrix.disturbances[0].name"});
}

TEST_F(SignalNames, KeysOfSectionsByNameAreNoNames) {
  for (const char* name : {"time_h", "ramp_h", "hold_s", "step_s"})
    expectWords(errorFor("A", name, "u"),
                {":8: plant.matrix.outputs[1].name: expected another name", name});
  expectWords(errorFor("A", "B", "u", "seed"), {":10: plant.matrix.disturbances[0].name"});
}

TEST_F(SignalNames, NoTwoColumnsOfTheTableAreTheSame) {
  expectWords(errorFor("A", "B", "A_setpoint"),
              {":7: plant.matrix: expected names", "'A_setpoint' is input A_setpoint and",
               "column setpoint of output A"});
  for (const char* input : {"A_true", "B_reference", "time"})
    expectWords(errorFor("A", "B", input), {std::string("'") + input + "' is"});
  expectWords(errorFor("A", "u_base", "u"), {"'u_base' is output u_base and", "of input u"});
}

TEST_F(SignalNames, NoTwoStatesAreTheSame) {
  expectWords(errorFor("A", "A_u", "u"),
              {":14: plant.matrix.elements[2].from: expected names", "A from u makes 'A_u' again"});
}

TEST_F(SignalNames, AnExternalPlantIsHeldToTheSame) {
  const std::string file = write(
      "loop.yaml",
      "plant:\n  type: external\n  name: rig\n  outputs: [{name: A}]\n"
      "  inputs: [{name: A_setpoint, lower: 0, upper: 1}]\n"
      "sampling: {sample_time_s: 1, duration_h: 0}\nsetpoint: {initial: {A: 0}}\n"
      "controller: {type: pi, loops: [{input: A_setpoint, output: A, kp: 1, ki_per_h: 1}]}\n");
  expectWords(errorOf([&] { readLoop(file); }), {file + ":2: plant.type", "A_setpoint"});
}

using IntegratorSection = LoopFolder;

TEST_F(IntegratorSection, IsRefusedForAPlantWithStepsOfItsOwn) {
  const auto errorWithIntegrator = [](const char* loop, Overrides overrides) {
    overrides.emplace_back("plant.integrator.max_steps", "2");
    return errorOf([&] { readLoop(loop, overrides); });
  };
  for (const char* loop : {"heated_tank", "surge_tank_steps", "bsm1_own_open"})
    expectWords(errorWithIntegrator(loop, {}),
                {"--set plant.integrator", "no such section", "its own"});
  EXPECT_EQ(errorWithIntegrator("surge_tank_steps", {{"plant.parameters.difference_step", "0"}}),
            kNamesTaken);
  EXPECT_EQ(errorWithIntegrator("asp_case1", {}), kNamesTaken);
}

}  // namespace config_signal_names_test
}  // namespace fpc
