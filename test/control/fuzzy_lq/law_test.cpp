// What the fuzzy optimal law answers, sample by sample.
#include "control/fuzzy_lq/law.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "control/fuzzy_lq/fixture.hpp"
#include "fmbpc/base/input_error.hpp"
#include "model/shared_partition.hpp"

namespace fpc {
namespace control_optimal_law_test {

Vector one(double value) { return Vector::Constant(1, value); }

/// The first answer of a law at a measurement at which everything has rested.
Vector firstInput(const FuzzyOptimalParams& params, const TsModel& model, const Measurement& now,
                  const Vector& target) {
  const PlantInfo info = test::infoOf(model);
  FuzzyOptimalLaw law(params, test::wideLimits(now.input_applied.size()), info);
  law.setModel(model);
  law.reset(now);
  SetpointSource setpoint = test::setpointOf(info, target);
  setpoint.advance(0);
  ControllerOutput output;
  law.step(now, setpoint, output);
  EXPECT_TRUE(output.ok);
  return output.input;
}

TEST(FuzzyOptimalLaw, OneStepWithoutWeightIsTheModelInverse) {
  Measurement now;
  now.outputs = one(2.0);
  now.input_applied = one(1.0);
  now.disturbances = Vector();
  FuzzyOptimalParams params = test::optimalParams(1, 1, 1, 1, 0.0);
  // At rest d = 2 - (0.9 2 + 0.2 1 + 0.1) = -0.1; then 0.9 2 + 0.2 u + 0.1 - 0.1 = 3.
  EXPECT_NEAR(firstInput(params, test::firstOrder(0.9, 0.2, 0.1), now, one(3.0))[0], 6.0, 1e-12);
  params.disturbance = FuzzyOptimalDisturbance::kNone;
  EXPECT_NEAR(firstInput(params, test::firstOrder(0.9, 0.2, 0.1), now, one(3.0))[0], 5.5, 1e-12);
  params.disturbance = FuzzyOptimalDisturbance::kInside;  // (b^2 + L) du = b (y_r - y)
  params.tuning.weight.move = one(0.06);
  EXPECT_NEAR(firstInput(params, test::firstOrder(0.9, 0.2, 0.1), now, one(3.0))[0], 3.0, 1e-12);
}

TEST(FuzzyOptimalLaw, InputIsTheBlendOfTheRulesOwnInputs) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 generator(seed);
    const TsModel model = test::dominantModel(generator, 2);
    Measurement now;
    now.outputs = test::randomVector(generator, 2);
    now.input_applied = test::randomVector(generator, 2);
    now.disturbances = test::randomVector(generator, 1);
    const Vector target = test::randomVector(generator, 2);
    FuzzyOptimalParams params = test::optimalParams(2, 2, 6, 2, 0.1);
    for (int g = 0; g < 3; ++g) {
      params.tuning.rules.push_back(params.tuning.weight);
      params.tuning.rules.back().move *= 1.0 + g;
    }
    const RuleSplit split = splitRules(model);
    FiringResult firing;
    firingWeights(model.submodels[0], now.outputs.head(1), firing);
    Vector sum = Vector::Zero(2);
    for (std::size_t g = 0; g < 3; ++g) {
      FuzzyOptimalParams own = params;
      own.tuning.rules = {params.tuning.rules[g]};
      sum += firing.weights[static_cast<Eigen::Index>(g)] *
             firstInput(own, split.rules[g], now, target);
    }
    EXPECT_LT((firstInput(params, model, now, target) - sum).norm(), 1e-11) << "seed " << seed;
  }
}

/// Runs on a plant with limits; the largest excess of bounds and moves.
TEST(FuzzyOptimalLaw, LimitsHoldAtEverySample) {
  std::mt19937_64 generator(2);
  const TsModel truth = test::dominantModel(generator, 2);
  const PlantInfo info = test::infoOf(truth);
  const InputLimits limits{test::pair(-0.5, -0.5), test::pair(0.6, 0.6), test::pair(0.1, 0.05)};
  test::ModelPlant plant(truth, Vector::Zero(2), Vector::Zero(2), one(0.3));
  SetpointSource setpoint = test::setpointOf(info, test::pair(2.0, -2.0));
  FuzzyOptimalLaw law(test::optimalParams(2, 2, 5, 2, 0.0), limits, info);
  law.setModel(truth);
  bool clipped = false;
  test::start(law, plant, setpoint, 100, [&](const Measurement& now, const ControllerOutput& out) {
    EXPECT_TRUE((out.input.array() <= limits.upper.array()).all());
    EXPECT_TRUE((out.input.array() >= limits.lower.array()).all());
    EXPECT_TRUE(
        ((out.input - now.input_applied).array().abs() <= limits.move.array() + 1e-12).all());
    clipped = clipped || out.source == ActionSource::kClipped;
  });
  EXPECT_TRUE(clipped);
}

TEST(FuzzyOptimalLaw, RefusesModelsItCannotServe) {
  std::mt19937_64 generator(1);
  const TsModel different = test::randomModel(generator, {});
  FuzzyOptimalLaw law(test::optimalParams(2, 2, 5, 1, 0.1), test::wideLimits(2),
                      test::infoOf(different));
  EXPECT_THROW(law.setModel(different), InputError);
  EXPECT_NO_THROW(law.setModel(test::sharedRandomModel(generator, {})));
  FuzzyOptimalParams weights = test::optimalParams(2, 2, 5, 1, 0.1);
  weights.tuning.rules.assign(2, weights.tuning.weight);
  FuzzyOptimalLaw two(weights, test::wideLimits(2), test::infoOf(different));
  EXPECT_THROW(two.setModel(test::sharedRandomModel(generator, {})), InputError);  // three rules
}

/// As the surge tank: b1 = 0, b2 > 0.
TEST(FuzzyOptimalLaw, AHorizonShorterThanTheRelativeDegreeIsRefusedOrSaidOnce) {
  const TsModel model = test::firstOrder(0.9, 0.2, 0.0, 1);
  const PlantInfo info = test::infoOf(model);
  FuzzyOptimalLaw law(test::optimalParams(1, 1, 1, 1, 0.0), test::wideLimits(1), info);
  try {
    law.setModel(model);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("horizon_steps"), std::string::npos) << error.what();
  }
  FuzzyOptimalLaw weighed(test::optimalParams(1, 1, 1, 1, 0.1), test::wideLimits(1), info);
  weighed.setModel(model);
  test::ModelPlant plant(model, one(0.0), one(0.0), Vector());
  SetpointSource setpoint = test::setpointOf(info, one(1.0));
  bool first = true;
  test::start(weighed, plant, setpoint, 3, [&](const Measurement&, const ControllerOutput& output) {
    EXPECT_TRUE(output.ok);
    EXPECT_EQ(output.events.has(EventCode::kHorizonTooShort), first);
    first = false;
  });
}

TEST(FuzzyOptimalLaw, PreviewMovesBeforeTheSetpointDoes) {
  const TsModel model = test::firstOrder(0.9, 0.2, 0.0);
  for (const bool preview : {false, true}) {
    FuzzyOptimalParams params = test::optimalParams(1, 1, 6, 6, 0.5);
    params.preview = preview;
    test::ModelPlant plant(model, one(0.0), one(0.0), Vector());
    SetpointSource setpoint =
        test::setpointOf(test::infoOf(model), one(0.0), {{20.0 / 3600.0, one(1.0), 0.0}});
    FuzzyOptimalLaw law(params, test::wideLimits(1), test::infoOf(model));
    law.setModel(model);
    double before = 0.0;
    test::start(law, plant, setpoint, 60,
                [&](const Measurement& now, const ControllerOutput& output) {
                  if (now.header.step == 17) before = output.input[0];
                  if (now.header.step == 12) {
                    EXPECT_NEAR(output.input[0], 0.0, 1e-12);
                  }
                  if (now.header.step == 59) {
                    EXPECT_NEAR(now.outputs[0], 1.0, 1e-6);
                  }
                });
    EXPECT_EQ(std::abs(before) > 1e-3, preview);
  }
}

TEST(FuzzyOptimalLaw, AMeasurementThatIsNotFiniteIsHeldAndLeftBehind) {
  const TsModel model = test::firstOrder(0.9, 0.2, 0.0);
  test::ModelPlant plant(model, one(0.0), one(0.0), Vector());
  SetpointSource setpoint = test::setpointOf(test::infoOf(model), one(1.0));
  FuzzyOptimalLaw law(test::optimalParams(1, 1, 4, 1, 0.1), test::wideLimits(1),
                      test::infoOf(model));
  law.setModel(model);
  test::start(law, plant, setpoint, 5);
  Measurement bad = plant.measure(5);
  bad.outputs[0] = std::nan("");
  ControllerOutput output;
  setpoint.advance(5);
  law.step(bad, setpoint, output);
  EXPECT_FALSE(output.ok);
  EXPECT_EQ(output.source, ActionSource::kHeld);
  EXPECT_EQ(output.input, bad.input_applied);
  plant.advance(output.input);
  double error = 1.0;
  test::run(law, plant, setpoint, 6, 200, [&](const Measurement& now, const ControllerOutput& out) {
    EXPECT_TRUE(out.ok);
    if (now.header.step == 6) {
      EXPECT_NEAR(out.input[0], now.input_applied[0], 1e-12);
    }
    error = std::abs(now.outputs[0] - 1.0);
  });
  EXPECT_LT(error, 1e-8);
}

TEST(FuzzyOptimalParams, EachFieldIsCheckedByName) {
  const auto refusal = [](auto change) {
    FuzzyOptimalParams params = test::optimalParams(1, 2, 5, 1, 0.1);
    change(params);
    try {
      params.validate(1, 2);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  using P = FuzzyOptimalParams;
  EXPECT_EQ(refusal([](P&) {}), "");
  const std::pair<const char*, std::string> refusals[] = {
      {"horizon_steps", refusal([](P& p) { p.tuning.horizon_steps = 0; })},
      {"move_steps", refusal([](P& p) { p.tuning.move_steps = 6; })},
      {"weight_output", refusal([](P& p) { p.tuning.weight.output.setZero(); })},
      {"weight_move", refusal([](P& p) { p.tuning.weight.move[1] = -1.0; })},
      {"weight_input", refusal([](P& p) { p.tuning.weight.input.resize(1); })},
      {"rules[0].weight_move", refusal([](P& p) {
         p.tuning.rules = {p.tuning.weight};
         p.tuning.rules[0].move[0] = std::nan("");
       })},
      {"input_target", refusal([](P& p) { p.tuning.input_target.resize(3); })},
      {"reference_pole", refusal([](P& p) { p.reference_pole[0] = 1.0; })},
      {"prediction_steps", refusal([](P& p) { p.prediction_steps = 0; })}};
  for (const auto& [field, words] : refusals)
    EXPECT_NE(words.find(std::string("controller.") + field), std::string::npos)
        << field << ": " << words;
}

}  // namespace control_optimal_law_test
}  // namespace fpc
