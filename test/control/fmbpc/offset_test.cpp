// Freedom from offset: the setpoint is reached although plant and model differ.
#include <gtest/gtest.h>

#include "control/fmbpc/law_fixture.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace control_fmbpc_offset_test {

Vector one(double value) { return Vector::Constant(1, value); }

double finalError(FmbpcParams params, const TsModel& model, const TsModel& truth,
                  const Vector& target) {
  const PlantInfo info = test::infoOf(truth);
  const auto n_u = static_cast<Eigen::Index>(info.inputs.size());
  test::ModelPlant plant(
      truth, Vector::Zero(target.size()), Vector::Zero(n_u),
      Vector::Constant(static_cast<Eigen::Index>(info.disturbances.size()), 0.3));
  SetpointSource setpoint = test::setpointOf(info, target);
  FmbpcLaw law(std::move(params), test::wideLimits(n_u), info);
  law.setModel(model);
  double error = 0.0;
  test::start(law, plant, setpoint, 600,
              [&](const Measurement& now, const ControllerOutput& output) {
                EXPECT_TRUE(output.ok);
                error = (now.outputs - target).cwiseAbs().maxCoeff();
              });
  return error;
}

TEST(OffsetFree, ParallelAndRealignedModelsReachTheSetpointDespiteMismatch) {
  const TsModel model = test::firstOrder(0.85, 0.10, 0.0),
                truth = test::firstOrder(0.90, 0.12, 0.3);
  for (const FmbpcForm law : {FmbpcForm::kPublished, FmbpcForm::kGeneral})
    for (const FmbpcRealisation realisation :
         {FmbpcRealisation::kParallel, FmbpcRealisation::kRealigned}) {
      FmbpcParams params = test::generalParams(1, 1, 5, 0.7, 0.01);
      params.law = law;
      params.realisation = realisation;
      EXPECT_LT(finalError(params, model, truth, one(2.0)), 1e-9)
          << wordOf(law) << ", " << wordOf(realisation);
    }
}

TEST(OffsetFree, RealignedWithoutErrorFilterMissesTheSetpoint) {
  FmbpcParams params = test::generalParams(1, 1, 5, 0.7, 0.01);
  params.realisation = FmbpcRealisation::kRealigned;
  params.offset_gain = 0.0;
  EXPECT_GT(finalError(params, test::firstOrder(0.85, 0.10, 0.0), test::firstOrder(0.90, 0.12, 0.3),
                       one(2.0)),
            0.1);
}

/// Two tanks in cross flow: each input reaches both outputs, the second one two samples late.
TsModel crossed(double scale, double offset) {
  TsModel model;
  model.name = "crossed";
  model.sample_time_s = 1.0;
  model.outputs = test::numbered("y", 2);
  model.inputs = test::numbered("u", 2);
  model.disturbances = test::numbered("d", 1);
  model.submodels.resize(2);
  const double numbers[2][7] = {{0.6, 0.2, 0.05, 0.3, 0.1, 0.2, 0.1},
                                {0.5, 0.3, 0.02, 0.1, -0.2, 0.1, 0.05}};
  for (int i = 0; i < 2; ++i) {
    OutputModel& submodel = model.submodels[static_cast<std::size_t>(i)];
    submodel.regressors = {{SignalKind::kOutput, i, 0},     {SignalKind::kOutput, i, 1},
                           {SignalKind::kOutput, 1 - i, 0}, {SignalKind::kInput, 0, 0},
                           {SignalKind::kInput, 1, 2},      {SignalKind::kDisturbance, 0, 0},
                           {SignalKind::kDisturbance, 0, 2}};
    Rule rule;
    rule.coefficients = Eigen::Map<const Vector>(numbers[i], 7);
    rule.coefficients.tail(4) *= scale;
    rule.offset = offset;
    submodel.rules = {rule};
  }
  return model;
}

TEST(OffsetFree, TwoInputsBringTwoOutputsToTheirSetpointsThroughLagsAndDelays) {
  const Vector target = test::pair(1.0, -0.5);
  for (const FmbpcRealisation realisation :
       {FmbpcRealisation::kParallel, FmbpcRealisation::kRealigned})
    for (const double move_weight : {0.0, 0.05}) {
      FmbpcParams params = test::generalParams(2, 2, 12, 0.8, move_weight);
      params.realisation = realisation;
      EXPECT_LT(finalError(params, crossed(1.0, 0.0), crossed(1.2, 0.1), target), 1e-8)
          << wordOf(realisation) << ", L = " << move_weight;
    }
}

}  // namespace control_fmbpc_offset_test
}  // namespace fpc
