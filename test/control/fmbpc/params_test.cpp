#include <gtest/gtest.h>

#include <cmath>

#include "control/fmbpc/law_fixture.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace control_fmbpc_params_test {

Vector one(double value) { return Vector::Constant(1, value); }

TEST(FmbpcParams, ValidateNamesTheField) {
  const auto expect = [](const std::string& key, const std::function<void(FmbpcParams&)>& spoil) {
    FmbpcParams params = test::generalParams(2, 1, 6, 0.5, 0.0);
    spoil(params);
    try {
      params.validate(2, 1);
      ADD_FAILURE() << "accepted: " << key;
    } catch (const InputError& e) {
      EXPECT_EQ(std::string(e.what()).rfind("controller." + key + ":", 0), 0U) << e.what();
    }
  };
  EXPECT_NO_THROW(test::generalParams(2, 1, 6, 0.5, 0.0).validate(2, 1));
  FmbpcParams no_key = test::generalParams(2, 1, 6, 0.5, 0.0);
  no_key.offset_gain = std::nan("");
  EXPECT_THROW(no_key.validate(2, 1), InputError);
  expect("coincidence_steps", [](FmbpcParams& p) { p.coincidence_steps = 0; });
  expect("prediction_steps", [](FmbpcParams& p) { p.prediction_steps = 0; });
  expect("reference_pole", [](FmbpcParams& p) { p.reference_pole = one(0.5); });
  expect("reference_pole", [](FmbpcParams& p) { p.reference_pole[1] = 1.0; });
  expect("weight_output", [](FmbpcParams& p) { p.weight_output = one(1.0); });
  expect("weight_output", [](FmbpcParams& p) { p.weight_output.setZero(); });
  expect("weight_move", [](FmbpcParams& p) { p.weight_move = one(-1.0); });
  for (const FmbpcForm law : {FmbpcForm::kPublished, FmbpcForm::kGeneral, FmbpcForm::kIterated})
    expect("weight_output", [law](FmbpcParams& p) {
      p.law = law;
      p.weight_output[1] = std::nan("");
    });
}

}  // namespace control_fmbpc_params_test
}  // namespace fpc
