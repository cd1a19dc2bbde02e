// What the fuzzy optimal law hands to the constraint optimizer, and what that makes of it.
#include <gtest/gtest.h>

#include <cmath>

#include "control/clp/closed_loop_paradigm.hpp"
#include "control/fuzzy_lq/fixture.hpp"

namespace fpc {
namespace control_optimal_prediction_test {

TEST(FuzzyOptimalPrediction, BaseActionFollowsFromItsGainStateAndFeedforward) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    std::mt19937_64 generator(seed);
    const TsModel truth = test::dominantModel(generator, 2);
    const TsModel model = test::mistaken(truth, generator, 0.1);
    for (const FuzzyOptimalDisturbance disturbance :
         {FuzzyOptimalDisturbance::kInside, FuzzyOptimalDisturbance::kOutside,
          FuzzyOptimalDisturbance::kNone}) {
      FuzzyOptimalParams params = test::optimalParams(2, 2, 6, 2, 0.1);
      params.disturbance = disturbance;
      params.prediction_steps = 10;
      params.tuning.weight.input.setConstant(0.05);
      params.tuning.input_target.setConstant(0.2);
      test::ModelPlant plant(truth, Vector::Zero(2), Vector::Zero(2), Vector::Constant(1, 0.3));
      SetpointSource setpoint = test::setpointOf(test::infoOf(truth), test::pair(0.5, -0.5));
      FuzzyOptimalLaw law(params, test::wideLimits(2), test::infoOf(truth));
      law.setModel(model);
      test::start(law, plant, setpoint, 40, [](const Measurement&, const ControllerOutput& out) {
        ASSERT_TRUE(out.predictive);
        const PredictiveAction& p = out.prediction;
        EXPECT_LT((p.feedforward.col(0) - p.K * p.state - out.input).norm(), 1e-12);
        EXPECT_EQ(p.input_base_unclipped, out.input);
        EXPECT_EQ(p.feedforward.cols(), 10);
        EXPECT_EQ(p.reference.cols(), 10);
      });
    }
  }
}

TEST(FuzzyOptimalPrediction, OfOneRuleIsWhatThenHappens) {
  const TsModel model = test::linearExampleModel();
  FuzzyOptimalParams params = test::optimalParams(2, 2, 5, 2, 0.1);
  params.prediction_steps = 30;
  params.reference_pole.setConstant(0.7);
  test::ModelPlant plant(model, Vector::Zero(2), Vector::Zero(2), Vector());
  SetpointSource setpoint = test::setpointOf(test::infoOf(model), test::pair(6.1, 12.8));
  FuzzyOptimalLaw law(params, test::wideLimits(2), test::infoOf(model));
  law.setModel(model);
  PredictiveAction first;
  Vector x;
  test::start(law, plant, setpoint, 30, [&](const Measurement& now, const ControllerOutput& out) {
    if (now.header.step == 0) {
      first = out.prediction;
      x = first.state;
    }
    const Vector u = first.feedforward.col(now.header.step) - first.K * x;
    EXPECT_LT((u - out.input).norm(), 1e-9) << now.header.step;
    x = (first.A * x + first.B * u + first.offset_state).eval();
    EXPECT_LT((first.C * x + first.offset_output - first.C * first.A * out.prediction.state -
               first.C * first.B * out.input - first.C * first.offset_state)
                  .norm(),
              1e-9);
  });
}

struct Constrained {
  double squared_error{};  ///< each output over its setpoint
  bool inside{true};
  int optimized{};
};

/// The linear example from rest at 0, inputs and moves bounded so that the law runs into them.
Constrained runConstrained(bool with_optimizer) {
  const TsModel model = test::linearExampleModel();
  const InputLimits limits{test::pair(0.0, 0.0), test::pair(1.3, 1.2), test::pair(0.3, 0.3)};
  FuzzyOptimalParams params = test::optimalParams(2, 2, 1, 1, 0.2);
  params.prediction_steps = 30;
  test::ModelPlant plant(model, Vector::Zero(2), Vector::Zero(2), Vector());
  const Vector target = test::pair(6.1, 12.8);
  SetpointSource setpoint = test::setpointOf(test::infoOf(model), target);
  FuzzyOptimalLaw law(params, limits, test::infoOf(model));
  law.setModel(model);
  ClpParams clp;
  clp.perturbation_steps = 30;
  clp.weight_perturbation = Vector::Constant(2, 1e-3);
  clp.weight_tracking = Vector::Ones(2);
  ControllerOutput output;
  ControlAction action;
  SolverReport report;
  std::unique_ptr<ClosedLoopParadigm> optimizer;
  Constrained result;
  law.reset(plant.measure(0));
  for (std::uint32_t k = 0; k < 200; ++k) {
    const Measurement now = plant.measure(k);
    setpoint.advance(k);
    law.step(now, setpoint, output);
    Vector input = output.input;
    if (with_optimizer) {
      if (!optimizer)
        optimizer =
            std::make_unique<ClosedLoopParadigm>(clp, limits, output.prediction.state.size(), 2, 2);
      optimizer->step(output.prediction, action, report);
      EXPECT_EQ(report.status, SolveStatus::kSolved);
      input = action.input;
      result.optimized += action.source == ActionSource::kConstrained;
    }
    result.inside = result.inside && (input.array() >= -1e-12).all() &&
                    (input.array() <= limits.upper.array() + 1e-12).all() &&
                    ((input - now.input_applied).array().abs() <= 0.3 + 1e-12).all();
    result.squared_error += (now.outputs - target).cwiseQuotient(target).squaredNorm();
    plant.advance(input);
  }
  return result;
}

TEST(FuzzyOptimalPrediction, WithActiveLimitsTheOptimizerBeatsClipping) {
  const Constrained clipped = runConstrained(false), optimized = runConstrained(true);
  EXPECT_TRUE(clipped.inside);
  EXPECT_TRUE(optimized.inside);
  EXPECT_GT(optimized.optimized, 0);
  RecordProperty("clipped", std::to_string(clipped.squared_error));
  RecordProperty("optimized", std::to_string(optimized.squared_error));
  EXPECT_LT(optimized.squared_error, 0.95 * clipped.squared_error)
      << "clipped " << clipped.squared_error;
}

}  // namespace control_optimal_prediction_test
}  // namespace fpc
