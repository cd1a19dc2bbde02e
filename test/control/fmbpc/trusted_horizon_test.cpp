// How far ahead the errors of a plan count: as far as its model is trusted.
#include <gtest/gtest.h>

#include <cmath>

#include "control/fmbpc/law_fixture.hpp"

namespace fpc {
namespace control_fmbpc_trusted_horizon_test {

Vector one(double value) { return Vector::Constant(1, value); }

FmbpcParams planning(int horizon) {
  FmbpcParams params = test::generalParams(1, 1, 3, 0.5, 0.2);
  params.law = FmbpcForm::kIterated;
  params.realisation = FmbpcRealisation::kRealigned;
  params.horizon_steps = horizon;
  params.iterations = 30;
  return params;
}

/// Inputs at outputs that are given, of a model whose data end at `upper`.
std::vector<double> plannedInputs(int horizon, double upper, Eigen::Index least, int delay = 0) {
  TsModel model = test::firstOrder(0.8, 0.3, 0.05, delay);
  model.outputs[0].lower = -upper;
  model.outputs[0].upper = upper;
  const PlantInfo info = test::infoOf(model);
  FmbpcLaw law(planning(horizon), test::wideLimits(1), info);
  if (least > 0) law.setTrustThreshold(0.25, least);
  law.setModel(model);
  SetpointSource setpoint = test::setpointOf(info, one(5.0));
  Measurement now;
  now.disturbances = Vector(0);
  now.input_applied = one(1.0);
  ControllerOutput output;
  std::vector<double> inputs;
  for (std::uint32_t k = 0; k < 8; ++k) {
    now.header.step = k;
    now.outputs = one(4.0 + 0.1 * k);
    if (k == 0) law.reset(now);
    setpoint.advance(k);
    law.step(now, setpoint, output);
    inputs.push_back(output.input[0]);
  }
  return inputs;
}

// Far outside the data the plan is that of the samples that always count; inside nothing changes.
TEST(TrustedHorizon, ErrorsCountAsFarAsTheModelIsTrusted) {
  const auto far = plannedInputs(20, 1.0, 4), near = plannedInputs(4, 1.0, 0);
  const auto inside = plannedInputs(20, 100.0, 4), whole = plannedInputs(20, 1.0, 0);
  EXPECT_EQ(far[0], whole[0]);  // no plan yet that could lead outside
  for (std::size_t k = 1; k < far.size(); ++k) {
    EXPECT_NEAR(far[k], near[k], 1e-6) << k;
    EXPECT_EQ(inside[k], whole[k]) << k;
    EXPECT_GT(std::abs(near[k] - whole[k]), 1e-3) << k;
  }
}

// What counts always is counted from the dead time on: no input does anything about errors before.
TEST(TrustedHorizon, TheDeadTimeDoesNotUseUpWhatAlwaysCounts) {
  const auto far = plannedInputs(40, 1.0, 4, 15), near = plannedInputs(19, 1.0, 0, 15);
  for (std::size_t k = 1; k < far.size(); ++k) {
    EXPECT_NEAR(far[k], near[k], 1e-6) << k;
    EXPECT_GT(std::abs(far[k] - 1.0), 1e-3) << k;  // it does not rest
  }
}

}  // namespace control_fmbpc_trusted_horizon_test
}  // namespace fpc
