// Every error names a key that the file can have, by its whole path, and a misspelt section first.
#include <gtest/gtest.h>

#include "runtime/loop_fixture.hpp"

namespace fpc {
namespace config_error_keys_test {

using ErrorKeys = LoopFolder;

/// What reading the shipped heated tank with this override says.
std::string errorOfOverride(const std::string& override, const std::string& loop = "heated_tank") {
  return errorOf([&] { readLoop(loop, {parseOverride(override)}); });
}

TEST_F(ErrorKeys, ChecksOfThePlantNameTheWholePathOfTheKey) {
  expectWords(errorOfOverride("sensors.T.delay_s=1e9"),
              {"--set sensors.T.delay_s: expected at most"});
  expectWords(errorOfOverride("actuator.input_upper.heat=1e9"),
              {"--set actuator.input_upper.heat: expected a number >= 0 and <= 20"});
  expectWords(errorOfOverride("disturbance.commands=[{time_h: 1, name: T_in, value: 1e9}]"),
              {"--set disturbance.commands[0].value: expected a number >= 0 and <= 40"});
  expectWords(errorOfOverride("disturbance.commands=[{time_h: 1, name: T_in, value: 9}, "
                              "{time_h: 1, name: input/heat, value: 1e9}]"),
              {"--set disturbance.commands[1].value: expected a number >= 0 and <= 20 [kW]",
               "input heat, got 1e+09"});
  expectWords(errorOfOverride("plant.parameters.difference_step=0.03", "surge_tank_steps"),
              {"--set plant.parameters.difference_step: expected a whole part"});
}

TEST_F(ErrorKeys, WhatNobodyMeasuresIsNamedWithWhatItNeeds) {
  const auto expect = [&](const std::string& override, const std::string& words) {
    expectWords(errorOfOverride(override, "cstr_tracking_rate"), {words});
  };
  const std::string estimated = "controller.observer.estimated";
  expect(estimated + ".rate.std=-1",
         "--set " + estimated + ".rate.std: expected a finite number > 0");
  expect(estimated + ".rate.walk_std=-1",
         estimated + ".rate.walk_std: expected a finite number >= 0");
  expect(estimated + ".load.std=3", estimated +
                                        ".load: expected an unmeasured disturbance of the model, "
                                        "which has d_q_c, rate");
  expect("model.file=cstr_lags.yaml",
         "expected an unmeasured disturbance of the model, which has none");
  expect("plant.measured_disturbances=[rate]",
         estimated + ".rate: expected a disturbance that is not measured");
  expect("model.identify.online.every=10", "--set model.identify: expected no such section beside");
  expect("controller.reference_holdback=0",
         "--set controller.reference_holdback: expected a number > 0");
  expect("estimator.outputs=[CA]", "--set estimator.outputs: expected nothing beside");
  expect("controller.realisation=parallel", "controller.realisation: expected observer where");
}

/// The model is five samples late.
TEST_F(ErrorKeys, APlanThatEndsWithinTheDeadTimeIsRefused) {
  const auto with = [](const char* horizon, const char* delay) {
    return errorOf([&] {
      readLoop("cstr_tracking_robust",
               {{"controller.horizon_steps", horizon}, {"controller.delay_steps", delay}});
    });
  };
  expectWords(with("5", "0"),
              {"controller.horizon_steps: expected more samples than the dead time of CA"});
  EXPECT_EQ(with("6", "0"), "nothing was thrown");
  EXPECT_EQ(with("1", "5"), "nothing was thrown");
}

TEST_F(ErrorKeys, ChecksOfAMatrixNameItsItems) {
  expectWords(errorOfOverride("plant.matrix.outputs.0.name=Q"),
              {"plant.matrix.elements[0].output: expected one of the matrix's outputs"});
  expectWords(errorOfOverride("plant.matrix.outputs.0.lower=60"),
              {"plant.matrix.outputs[0].nominal: expected a number between lower and upper"});
  expectWords(errorOfOverride("plant.matrix.outputs.0.upper=-1"),
              {"--set plant.matrix.outputs[0].upper: expected lower < upper"});
}

TEST_F(ErrorKeys, TheLineIsThatOfTheKeyInTheFile) {
  const std::string file =
      write("loop.yaml", "extends: heated_tank\nactuator:\n  input_upper: {heat: 1e9}\n");
  expectWords(errorOf([&] { readLoop(file); }), {file + ":3: actuator.input_upper.heat: expected"});
}

TEST_F(ErrorKeys, AMisspeltSectionIsNamedBeforeWhatLacksWithoutIt) {
  const auto errorIn = [&](const std::string& text) {
    const std::string file = write("loop.yaml", text);
    const std::string error = errorOf([&] { readLoop(file); });
    EXPECT_EQ(error.rfind(file + ":1: ", 0), 0U) << error;
    return error;
  };
  expectWords(errorIn("Extends: heated_tank\n"), {"Extends: unknown key (extends?)"});
  expectWords(errorIn("plugin: [mine]\nextends: heated_tank\n"),
              {"plugin: unknown key (plugins?)"});
  std::string text = smallLoop();
  text.replace(text.find("controller"), 10, "controler");
  text = "controler:" + text.substr(text.find("controler") + 10) +
         text.substr(0, text.find("controler"));
  expectWords(errorIn(text), {"controler: unknown key (controller?)"});
}

}  // namespace config_error_keys_test
}  // namespace fpc
