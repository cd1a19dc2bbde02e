// How the law behaves in a loop: no bumps, limits always, trouble reported.
#include <gtest/gtest.h>

#include <cmath>

#include "control/fmbpc/law_fixture.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace control_fmbpc_behaviour_test {

Vector one(double value) { return Vector::Constant(1, value); }

/// A running loop on first-order plants, for everything that happens to it.
struct Running {
  explicit Running(FmbpcParams params = test::generalParams(1, 1, 5, 0.7, 0.0), double size = 1e9)
      : info(test::infoOf(test::firstOrder(0.9, 0.1, 0.2))),
        plant(test::firstOrder(0.9, 0.1, 0.2), one(0.0), one(0.0), Vector()),
        setpoint(test::setpointOf(info, one(2.0))),
        law(std::move(params), test::wideLimits(1, size), info) {
    law.setModel(test::firstOrder(0.85, 0.12, 0.0));
    test::start(law, plant, setpoint, 40,
                [this](const Measurement&, const ControllerOutput& o) { last = o; });
  }
  PlantInfo info;
  test::ModelPlant plant;
  SetpointSource setpoint;
  FmbpcLaw law;
  ControllerOutput last;
};

TEST(BumplessTransfer, FirstInputAfterAResetInTheMiddleIsTheAppliedOne) {
  Running loop;
  for (int i = 0; i < 3; ++i) loop.plant.advance(one(4.0));  // by hand
  const Measurement back = loop.plant.measure(43);
  loop.law.reset(back);
  double biggest_move = 0.0, before = 4.0, error = 1.0;
  test::run(loop.law, loop.plant, loop.setpoint, 43, 300,
            [&](const Measurement& now, const ControllerOutput& output) {
              if (now.header.step == 43) {
                EXPECT_EQ(output.input[0], 4.0);
              }
              biggest_move = std::max(biggest_move, std::abs(output.input[0] - before));
              before = output.input[0];
              error = std::abs(now.outputs[0] - 2.0);
            });
  EXPECT_LT(biggest_move, 1.0);
  EXPECT_LT(error, 1e-9);  // the bias dies out
}

TEST(BumplessTransfer, TheFirstSampleOfARunIsThePureLaw) {
  const PlantInfo info = test::infoOf(test::firstOrder(0.9, 0.1, 0.0));
  test::ModelPlant plant(test::firstOrder(0.9, 0.1, 0.0), one(0.0), one(7.0), Vector());
  SetpointSource setpoint = test::setpointOf(info, one(2.0));
  FmbpcLaw law(test::generalParams(1, 1, 1, 0.0, 0.0), test::wideLimits(1), info);
  law.setModel(test::firstOrder(0.9, 0.1, 0.0));
  test::start(law, plant, setpoint, 1, [](const Measurement&, const ControllerOutput& output) {
    EXPECT_NEAR(output.input[0], 20.0, 1e-12);
  });
  law.reset(plant.measure(1));
  test::run(law, plant, setpoint, 1, 2, [](const Measurement& now, const ControllerOutput& output) {
    EXPECT_EQ(output.input, now.input_applied);
  });
}

TEST(FmbpcLaw, LimitsHoldAtEverySampleAndTheModelSeesWhatWasApplied) {
  std::mt19937_64 generator(4);
  FmbpcParams params = test::generalParams(1, 1, 2, 0.0, 0.0);
  const PlantInfo info = test::infoOf(test::firstOrder(0.9, 0.1, 0.2));
  InputLimits limits{one(-1.0), one(2.5), one(0.4)};
  FmbpcLaw law(params, limits, info);
  law.setModel(test::firstOrder(0.85, 0.12, 0.0));
  test::ModelPlant plant(test::firstOrder(0.9, 0.1, 0.2), one(0.0), one(0.0), Vector());
  SetpointSource setpoint =
      test::setpointOf(info, one(40.0), {{100.0 / 3600.0, one(1.0)}});  // out of reach at first
  int clipped = 0;
  double error = 1.0;
  test::start(law, plant, setpoint, 400,
              [&](const Measurement& now, const ControllerOutput& output) {
                EXPECT_LE(output.input[0], 2.5);
                EXPECT_GE(output.input[0], -1.0);
                EXPECT_LE(std::abs(output.input[0] - now.input_applied[0]), 0.4 + 1e-12);
                clipped += output.source == ActionSource::kClipped ? 1 : 0;
                error = std::abs(now.outputs[0] - 1.0);
              });
  EXPECT_GT(clipped, 90);
  EXPECT_LT(error, 1e-9);
}

TEST(FmbpcLaw, HoldsWithoutAModelAndRefusesOneThatDoesNotFit) {
  const PlantInfo info = test::infoOf(test::firstOrder(0.9, 0.1, 0.2));
  FmbpcLaw law(test::generalParams(1, 1, 5, 0.7, 0.0), test::wideLimits(1, 3.0), info);
  EXPECT_TRUE(law.needsModel());
  test::ModelPlant plant(test::firstOrder(0.9, 0.1, 0.2), one(0.0), one(5.0), Vector());
  SetpointSource setpoint = test::setpointOf(info, one(2.0));
  test::start(law, plant, setpoint, 2, [](const Measurement&, const ControllerOutput& output) {
    EXPECT_FALSE(output.ok);
    EXPECT_FALSE(output.predictive);
    EXPECT_EQ(output.source, ActionSource::kHeld);
    EXPECT_EQ(output.input[0], 3.0);  // held, but inside the bounds
  });
  EXPECT_THROW(law.setModel(test::shippedModel("fm_1")), InputError);
  law.setModel(test::firstOrder(0.85, 0.12, 0.0));
  EXPECT_THROW(law.setModel(test::shippedModel("fm_1")), InputError);
  test::run(law, plant, setpoint, 2, 3,
            [](const Measurement&, const ControllerOutput& output) { EXPECT_TRUE(output.ok); });
}

/// Of two inputs the second acts only after the horizon.
TsModel oneLateInput() {
  TsModel model = test::firstOrder(0.9, 0.1, 0.0);
  model.inputs = {test::signal("early"), test::signal("late")};
  model.submodels[0].regressors.push_back({SignalKind::kInput, 1, 9});
  model.submodels[0].rules[0].coefficients = (Vector(3) << 0.9, 0.1, 0.2).finished();
  return model;
}

TEST(FmbpcLaw, AnInputThatActsAfterTheHorizonIsNamedBesideOneThatActs) {
  const TsModel model = oneLateInput();
  const PlantInfo info = test::infoOf(model);
  for (const int horizon : {5, 20}) {
    FmbpcLaw law(test::generalParams(1, 2, horizon, 0.7, 0.1), test::wideLimits(2), info);
    test::ModelPlant plant(model, one(0.0), Vector::Zero(2), Vector());
    SetpointSource setpoint = test::setpointOf(info, one(2.0));
    law.setModel(model);
    test::start(law, plant, setpoint, 10, [&](const Measurement&, const ControllerOutput& o) {
      EXPECT_TRUE(o.ok);
      EXPECT_EQ(o.events.has(EventCode::kInputWithoutEffect), horizon == 5);
      if (horizon == 5) EXPECT_EQ(o.input[1], 0.0);
    });
  }
}

TEST(FmbpcLaw, AnInputThatNoRuleKnowsIsNoEvent) {
  TsModel model = test::firstOrder(0.9, 0.1, 0.0);
  model.inputs = {test::signal("early"), test::signal("unknown")};
  const PlantInfo info = test::infoOf(model);
  FmbpcLaw law(test::generalParams(1, 2, 5, 0.7, 0.1), test::wideLimits(2), info);
  test::ModelPlant plant(model, one(0.0), Vector::Zero(2), Vector());
  SetpointSource setpoint = test::setpointOf(info, one(2.0));
  law.setModel(model);
  test::start(law, plant, setpoint, 10, [&](const Measurement&, const ControllerOutput& o) {
    EXPECT_TRUE(o.events.empty());
  });
}

TEST(FmbpcLaw, AWeightOfMovesDoesNotHideThatNoInputActs) {
  Running loop(test::generalParams(1, 1, 5, 0.7, 0.1));
  loop.law.setModel(test::firstOrder(0.9, 0.1, 0.0, 9));
  test::run(loop.law, loop.plant, loop.setpoint, 40, 43,
            [&](const Measurement&, const ControllerOutput& output) {
              EXPECT_FALSE(output.ok);
              EXPECT_TRUE(output.events.has(EventCode::kInputWithoutEffect));
            });
}

TEST(FmbpcLaw, AnInputWithoutEffectIsHeldAndSaidSo) {
  Running loop;
  const double before = loop.last.input[0];
  loop.law.setModel(test::firstOrder(0.9, 0.1, 0.0, 9));  // acts after the horizon
  test::run(loop.law, loop.plant, loop.setpoint, 40, 43,
            [&](const Measurement&, const ControllerOutput& output) {
              EXPECT_FALSE(output.ok);
              EXPECT_FALSE(output.predictive);
              EXPECT_EQ(output.source, ActionSource::kHeld);
              EXPECT_EQ(output.input[0], before);
              EXPECT_TRUE(output.events.has(EventCode::kInputWithoutEffect));
            });
}

TEST(FmbpcLaw, ARunawayModelHoldsAndStartsAgainWithoutABump) {
  Running loop;
  loop.law.setModel(test::firstOrder(1e200, 1e-200, 0.0));
  bool held = false;
  test::run(loop.law, loop.plant, loop.setpoint, 40, 60,
            [&](const Measurement&, const ControllerOutput& output) {
              EXPECT_TRUE(output.input.allFinite());
              held = held || !output.ok;
            });
  EXPECT_TRUE(held);
  loop.law.setModel(test::firstOrder(0.85, 0.12, 0.0));
  double error = 1.0;
  test::run(loop.law, loop.plant, loop.setpoint, 60, 300,
            [&](const Measurement& now, const ControllerOutput& output) {
              if (now.header.step == 60) {
                EXPECT_EQ(output.input, now.input_applied);
              }
              error = std::abs(now.outputs[0] - 2.0);
            });
  EXPECT_LT(error, 1e-9);
}

TEST(FmbpcLaw, NaNMeasurementsAreHeldAndForgotten) {
  Running loop;
  const double before = loop.last.input[0];
  Measurement bad = loop.plant.measure(40);
  bad.outputs[0] = std::nan("");
  ControllerOutput output;
  loop.law.step(bad, loop.setpoint, output);
  EXPECT_EQ(output.source, ActionSource::kHeld);
  EXPECT_EQ(output.input[0], before);
  bad.input_applied[0] = HUGE_VAL;
  loop.law.step(bad, loop.setpoint, output);
  EXPECT_EQ(output.input[0], before);
  loop.plant.advance(output.input);
  test::run(loop.law, loop.plant, loop.setpoint, 42, 43,
            [&](const Measurement&, const ControllerOutput& next) {
              EXPECT_TRUE(next.ok);
              EXPECT_EQ(next.input[0], before);
            });
}

TEST(FmbpcLaw, NoRuleFiringIsAnEventNotAFailure) {
  TsModel crisp = test::firstOrder(0.85, 0.12, 0.0);
  crisp.submodels[0].antecedents = {{SignalKind::kOutput, 0, 0}};
  crisp.submodels[0].rules[0].antecedents = {{MembershipShape::kTriangular, {-1.0, 0.0, 1.0}}};
  Running loop;
  loop.law.setModel(crisp);
  test::run(loop.law, loop.plant, loop.setpoint, 40, 41,
            [](const Measurement&, const ControllerOutput& output) {
              EXPECT_TRUE(output.ok);
              EXPECT_TRUE(output.events.has(EventCode::kNoRuleFired));
            });
}

TEST(FmbpcLaw, SignalsShowTheModelAndItsCorrection) {
  Running loop;
  const auto& signals = loop.law.signals();
  ASSERT_EQ(signals.size(), 3U);
  EXPECT_EQ(signals[0].first, "y_model");
  EXPECT_EQ(signals[1].first, "y_correction");
  EXPECT_EQ(signals[2].first, "u_unclipped");
  EXPECT_NEAR(signals[0].second + signals[1].second,
              loop.last.prediction.state[0] + loop.last.prediction.offset_output[0], 1e-12);
  EXPECT_EQ(signals[2].second, loop.last.prediction.input_base_unclipped[0]);
}

}  // namespace control_fmbpc_behaviour_test
}  // namespace fpc
