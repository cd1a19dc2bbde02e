// Three inputs whose gains nearly cancel in one direction, on plants in which that direction has
// the other sign.
#include <gtest/gtest.h>

#include <cmath>

#include "control/fmbpc/law_fixture.hpp"
#include "model/gain_sign.hpp"

namespace fpc {
namespace control_fmbpc_weak_direction_test {

/// y(k+1) = 0.8 y + 0.2 G u, outputs and inputs from -2 to 2.
TsModel coupled(const Matrix& G) {
  TsModel model;
  model.name = "coupled";
  model.sample_time_s = 1.0;
  for (const char* name : {"y1", "y2", "y3"}) model.outputs.push_back({name, "", -2.0, 2.0});
  for (const char* name : {"u1", "u2", "u3"}) model.inputs.push_back({name, "", -2.0, 2.0});
  for (int i = 0; i < 3; ++i) {
    OutputModel submodel;
    submodel.regressors = {{SignalKind::kOutput, i, 0}};
    for (int j = 0; j < 3; ++j) submodel.regressors.push_back({SignalKind::kInput, j, 0});
    Rule rule;
    rule.coefficients = (Vector(4) << 0.8, 0.2 * G.row(i).transpose()).finished();
    submodel.rules = {rule};
    model.submodels.push_back(submodel);
  }
  return model;
}

/// Singular values 2.96, 0.3 and `weak`.
Matrix gains(double weak) {
  const Matrix U = (Matrix(3, 3) << 1, 1, 1, 1, 0, -2, 1, -1, 1).finished().colwise().normalized();
  const Matrix V = (Matrix(3, 3) << 1, 1, 1, 1, -1, 1, 1, 0, -2).finished().colwise().normalized();
  return U * Eigen::Vector3d(2.96, 0.3, weak).asDiagonal() * V.transpose();
}

/// The largest error over the last 50 of 400 samples, and how often an input was at a bound in
/// them.
struct Outcome {
  double error{};
  int at_bound{};
};

Outcome loopOn(double weak, double weight_input) {
  const TsModel model = coupled(gains(0.05));
  const PlantInfo info = test::infoOf(model);
  FmbpcParams params = test::generalParams(3, 3, 3, 0.5, 0.1);
  params.law = FmbpcForm::kIterated;
  params.realisation = FmbpcRealisation::kRealigned;
  params.horizon_steps = 20;
  params.weight_input = Vector::Constant(3, weight_input);
  params.input_target = Vector::Zero(3);
  FmbpcLaw law(params, test::wideLimits(3, 2.0), info);
  law.setModel(model);
  const Vector asked = (Vector(3) << 0.5, 0.47, 0.5).finished();
  SetpointSource setpoint = test::setpointOf(info, asked);
  test::ModelPlant plant(coupled(gains(weak)), Vector::Zero(3), Vector::Zero(3), Vector(0));
  Outcome outcome;
  test::start(law, plant, setpoint, 400, [&](const Measurement& now, const ControllerOutput& out) {
    if (now.header.step < 350) return;
    outcome.error = std::max(outcome.error, (now.outputs - asked).cwiseAbs().maxCoeff());
    outcome.at_bound += (out.input.cwiseAbs().array() >= 2.0 - 1e-9).any();
  });
  return outcome;
}

TEST(WeakDirection, IsSaidWithItsInputs) {
  Measurement at;
  at.outputs = at.input_applied = Vector::Zero(3);
  at.disturbances = Vector(0);
  const std::string words = weakDirection(coupled(gains(0.05)), at);
  EXPECT_NE(words.find("u1, u2, u3"), std::string::npos) << words;
  EXPECT_NE(words.find("0.01689"), std::string::npos) << words;
  EXPECT_EQ(weakDirection(coupled(gains(0.2)), at), "");
}

// Without a target the law walks along the weak direction until bounds stop it; with one it rests
// near the setpoint.
TEST(WeakDirection, AnInputTargetKeepsAPlantStableThatTurnsItRound) {
  for (const double weak : {0.05, 0.02, -0.02, -0.05}) {
    SCOPED_TRACE(weak);
    const Outcome free = loopOn(weak, 0.0), drawn = loopOn(weak, 0.02);
    EXPECT_EQ(free.at_bound > 0, weak < 0.0);
    EXPECT_EQ(drawn.at_bound, 0);
    EXPECT_LT(drawn.error, 0.1);
  }
}

}  // namespace control_fmbpc_weak_direction_test
}  // namespace fpc
