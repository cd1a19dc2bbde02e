// Values of signals as words that people type.
#include "fmbpc/control/settings.hpp"

#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace control_settings_test {

const std::vector<SignalInfo> kInputs = {{"q_r", "m3/h", 0, 1600}, {"q_p", "m3/h", 0, 100}};

std::string refusal(const std::string& text) {
  Vector values = Vector::Zero(2);
  try {
    readSignalValues(text, kInputs, "controller.weight_move", values);
  } catch (const InputError& error) {
    EXPECT_EQ(values, Vector::Zero(2)) << text;
    return error.what();
  }
  return "";
}

TEST(Settings, AValueOfANamedInputIsTakenAndTheOthersStay) {
  Vector values = Vector::Ones(2);
  readSignalValues("q_r=1e-7", kInputs, "controller.weight_move", values);
  EXPECT_EQ(values, Eigen::Vector2d(1e-7, 1.0));
}

TEST(Settings, AnUnknownInputIsRefusedInWordsThatNameTheKnownOnes) {
  EXPECT_EQ(refusal("q=1e-7"),
            "controller.weight_move: expected NAME=number, NAME one of q_r, q_p, got 'q=1e-7'");
  EXPECT_EQ(refusal("q_r=1 q=2"),
            "controller.weight_move: expected NAME=number, NAME one of q_r, q_p, got 'q=2'");
}

}  // namespace control_settings_test
}  // namespace fpc
