// What the law tells the optimizer: a frozen local model and the base law as feedback plus
// feedforward.
#include <gtest/gtest.h>

#include <cmath>

#include "control/fmbpc/law_fixture.hpp"

namespace fpc {
namespace control_fmbpc_prediction_test {

double relativeGap(const Vector& a, const Vector& b) {
  return ((a - b).array().abs() / (1.0 + b.array().abs())).maxCoeff();
}

struct Case {
  const char* name;
  FmbpcParams params;
  TsModel model;
  bool bumpless{false};
};

TsModel oneRule(std::uint64_t seed, test::RandomModelShape shape) {
  std::mt19937_64 generator(seed);
  shape.n_rules = 1;
  return test::randomModel(generator, shape);
}

std::vector<Case> cases() {
  std::vector<Case> all;
  FmbpcParams published;
  published.coincidence_steps = 5;
  published.reference_pole = Vector::Constant(2, 0.8);
  all.push_back({"published, lags and delay", published, oneRule(3, {2, 1, 1, 1, 2, 1, 2, 2})});
  FmbpcParams square = test::generalParams(2, 2, 4, 0.7, 0.0);
  square.weight_output << 1.0, 20.0;
  all.push_back({"general 2x2, lags", square, oneRule(5, {2, 2, 1, 1, 2, 0, 2, 2})});
  FmbpcParams moves = test::generalParams(2, 2, 6, 0.7, 0.4);
  all.push_back({"general 2x2 with move weight, lags and delay", moves,
                 oneRule(8, {2, 2, 2, 1, 3, 1, 3, 2})});
  all.push_back({"the same after a reset in the middle", moves, all.back().model, true});
  moves.preview = true;
  all.push_back({"with preview", moves, all.back().model, false});
  moves.realisation = FmbpcRealisation::kRealigned;
  moves.offset_gain = 0.0;
  all.push_back({"realigned", moves, all.back().model, true});
  FmbpcParams three = test::generalParams(3, 2, 3, 0.5, 0.1);
  all.push_back(
      {"general, three outputs and two inputs", three, oneRule(11, {3, 2, 0, 1, 1, 2, 1, 1})});
  for (auto& c : all) c.params.prediction_steps = 12;
  return all;
}

/// u(k+i), x(k+i+1) for i < n_c as the prediction says.
std::vector<Vector> foretold(const PredictiveAction& now) {
  std::vector<Vector> inputs;
  Vector x = now.state;
  for (Eigen::Index i = 0; i < now.feedforward.cols(); ++i) {
    inputs.push_back(-now.K * x + now.feedforward.col(i));
    x = (now.A * x + now.B * inputs.back() + now.offset_state).eval();
  }
  return inputs;
}

TEST(Prediction, BaseLawOfALinearModelComesTrueInClosedLoop) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    std::mt19937_64 generator(17);
    const PlantInfo info = test::infoOf(c.model);
    const auto n_y = static_cast<Eigen::Index>(info.outputs.size()),
               n_u = static_cast<Eigen::Index>(info.inputs.size()),
               n_d = static_cast<Eigen::Index>(info.disturbances.size());
    test::ModelPlant plant(c.model, test::randomVector(generator, n_y),
                           test::randomVector(generator, n_u), test::randomVector(generator, n_d));
    const double second = 1.0 / 3600.0;
    const double change_at = c.bumpless ? 0.0 : 9.0 * second;
    SetpointSource setpoint = test::setpointOf(info, test::randomVector(generator, n_y),
                                               {{change_at, test::randomVector(generator, n_y)}});
    FmbpcLaw law(c.params, test::wideLimits(n_u), info);
    law.setModel(c.model);
    test::start(law, plant, setpoint, 1);
    std::uint32_t k = 1;
    if (c.bumpless) {
      for (; k < 500; ++k)
        plant.advance(Vector::Constant(n_u, 0.5));  // by hand, until the plant rests
      law.reset(plant.measure(k));
      test::run(law, plant, setpoint, k, k + 1);
      ++k;
    }
    // From now on the sensors are off: y - y_m is constant because plant and model are the same.
    if (c.params.realisation == FmbpcRealisation::kParallel)
      plant.output_bias = test::randomVector(generator, n_y);
    const std::uint32_t settled =
        c.params.preview || c.bumpless ? k + 2 : 10;  // without preview the setpoint must rest
    test::run(law, plant, setpoint, k, settled);
    k = settled;
    std::vector<Vector> promise;
    test::run(law, plant, setpoint, k, k + 12,
              [&](const Measurement& now, const ControllerOutput& output) {
                ASSERT_TRUE(output.predictive);
                if (promise.empty()) promise = foretold(output.prediction);
                const Vector& u = promise[now.header.step - k];
                EXPECT_LT(relativeGap(output.prediction.input_base_unclipped, u), 1e-9)
                    << "i = " << now.header.step - k;
              });
  }
}

TEST(Prediction, FirstInputIsTheBaseActionForNonlinearModels) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    const TsModel model = test::randomModel(generator, {});
    FmbpcParams params = test::generalParams(2, 2, 5, 0.6, seed % 2 == 0 ? 0.0 : 0.2);
    params.prediction_steps = 4;
    params.realisation = seed % 3 == 0 ? FmbpcRealisation::kRealigned : FmbpcRealisation::kParallel;
    const PlantInfo info = test::infoOf(model);
    test::ModelPlant plant(model, Vector::Zero(2), Vector::Zero(2), Vector::Zero(1));
    SetpointSource setpoint = test::setpointOf(info, test::randomVector(generator, 2));
    FmbpcLaw law(params, test::wideLimits(2, 3.0), info);
    law.setModel(model);
    test::start(
        law, plant, setpoint, 60, [&](const Measurement& now, const ControllerOutput& output) {
          ASSERT_TRUE(output.predictive);
          const PredictiveAction& p = output.prediction;
          EXPECT_LT(relativeGap(p.input_base_unclipped, -p.K * p.state + p.feedforward.col(0)),
                    1e-9);
          EXPECT_LT(relativeGap(p.C * p.state + p.offset_output, now.outputs), 1e-12);
          EXPECT_EQ(p.input_previous, now.input_applied);
          EXPECT_EQ(p.setpoint, setpoint.present());
          EXPECT_EQ(p.header.step, now.header.step);
          EXPECT_EQ(p.reference.cols(), 4);
          EXPECT_LT(relativeGap(p.reference.col(0), 0.6 * output.reference + 0.4 * p.setpoint),
                    1e-14);
        });
  }
}

TEST(Prediction, PublishedGainIsTheBiomassRowOverM2) {
  const PlantInfo info = test::activatedSludgeInfo();
  const Vector y = (Vector(2) << 60.0, 2010.0).finished(),
               d = (Vector(2) << 1300.0, 366.67).finished();
  test::ModelPlant plant(test::shippedModel("fm_1"), y, Vector::Constant(1, 570.0), d);
  SetpointSource setpoint = test::setpointOf(info, y);
  FmbpcLaw law(test::publishedParams(), test::wideLimits(1), info);
  law.setModel(test::shippedModel("fm_1"));
  test::start(law, plant, setpoint, 5, [&](const Measurement&, const ControllerOutput& output) {
    const PredictiveAction& p = output.prediction;
    const double f = p.A(1, 1), m2 = p.B(1, 0) * (1.0 - std::pow(f, 6)) / (1.0 - f);
    EXPECT_EQ(p.K(0, 0), 0.0);
    EXPECT_NEAR(p.K(0, 1), std::pow(f, 6) / m2, 1e-10 * std::abs(p.K(0, 1)));
    EXPECT_EQ(p.K(0, 2), 0.0);
  });
}

}  // namespace control_fmbpc_prediction_test
}  // namespace fpc
