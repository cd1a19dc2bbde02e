// A new model in a running loop: it takes over without a bump, or not at all.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "control/fmbpc/law_fixture.hpp"
#include "fmbpc/base/input_error.hpp"
#include "runtime/session.hpp"

namespace fpc {
namespace control_fmbpc_model_change_test {

Vector one(double value) { return Vector::Constant(1, value); }

constexpr double kPole = 0.9, kGain = 0.1;  // of the plant

FmbpcParams params(FmbpcRealisation realisation = FmbpcRealisation::kParallel, double decay = 0.9) {
  FmbpcParams p = test::generalParams(1, 1, 5, 0.7, 0.0);
  p.realisation = realisation;
  p.transfer_decay = decay;
  return p;
}

/// A session on a first-order plant whose setpoint steps, so that inputs move all the time.
struct Loop {
  explicit Loop(const FmbpcParams& law = params(), double max_pole = 1.0)
      : plant(test::firstOrder(kPole, kGain, 0.2), one(0.0), one(0.0), Vector()) {
    PlantInfo info = test::infoOf(test::firstOrder(kPole, kGain, 0.2));
    info.header.time_ns = 1000000000;
    SetpointParams setpoint;
    setpoint.initial = one(2.0);
    const double infinite = std::numeric_limits<double>::infinity();
    setpoint.lower = one(-infinite);
    setpoint.upper = setpoint.rate_per_h = one(infinite);
    setpoint.schedule = {{15.0 / 3600.0, one(3.0)}};
    session = std::make_unique<ControllerSession>(
        std::make_unique<FmbpcLaw>(law, test::wideLimits(1, 100.0), info), setpoint,
        test::wideLimits(1, 100.0), one(0.0), info, max_pole);
    session->setModel(test::firstOrder(0.85, 0.12, 0.0));
  }
  /// Answers the present sample; the plant moves on.
  double step() {
    Measurement m = plant.measure(k);
    m.header.run_id = 1;
    m.header.time_ns = static_cast<std::int64_t>(k + 1) * 1000000000;
    EXPECT_EQ(session->receive(m), Receipt::kAnswered);
    y = m.outputs[0];
    plant.advance(session->answer().base.input);
    ++k;
    return session->answer().base.input[0];
  }
  void run(int samples) {
    for (int i = 0; i < samples; ++i) step();
  }
  std::string refusal(const TsModel& model) {
    try {
      session->setModel(model);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  test::ModelPlant plant;
  std::unique_ptr<ControllerSession> session;
  std::uint32_t k{0};
  double y{};
};

/// y+ = a y + a2 y(k-1) + b u(k-1) under two rules of another variable.
TsModel otherShape() {
  TsModel model = test::firstOrder(0.0, 0.0, 0.0);
  OutputModel& y = model.submodels[0];
  y.antecedents = {{SignalKind::kInput, 0, 1}};
  y.regressors = {
      {SignalKind::kOutput, 0, 0}, {SignalKind::kOutput, 0, 2}, {SignalKind::kInput, 0, 0}};
  const Vector theta = (Vector(3) << 0.8, 0.08, 0.11).finished();
  y.rules = {{{{MembershipShape::kGaussian, {0.0, 2.0}}}, theta, 0.1, 0},
             {{{MembershipShape::kGaussian, {3.0, 2.0}}}, theta, 0.2, 0}};
  return model;
}

TEST(ModelChange, TheFirstInputOfTheNewModelIsWhatTheOldOneWouldHaveSent) {
  for (const FmbpcRealisation realisation :
       {FmbpcRealisation::kParallel, FmbpcRealisation::kRealigned})
    for (const TsModel& other :
         {test::firstOrder(0.5, 0.9, 1.0), test::firstOrder(0.85, 0.12, 5.0), otherShape()}) {
      Loop with(params(realisation)), without(params(realisation));
      with.run(18);  // in the middle of a setpoint step
      without.run(18);
      with.session->setModel(other);
      const double expected = without.step();
      EXPECT_EQ(with.step(), expected) << wordOf(realisation) << " " << other.name;
      EXPECT_EQ(with.session->answer().base.source, ActionSource::kBase);
      EXPECT_TRUE(with.session->answer().has_prediction);
      EXPECT_TRUE(with.session->resetReason().empty());
    }
}

TEST(ModelChange, ThePredictionOfTheFirstSampleIsThatOfTheNewModel) {
  Loop loop;
  loop.run(18);
  loop.session->setModel(otherShape());
  const double input = loop.step();
  const PredictiveAction& p = loop.session->answer().prediction;
  ASSERT_EQ(p.state.size(), 4);  // three lags of y, u(k-1)
  EXPECT_NEAR(-p.K.row(0).dot(p.state) + p.feedforward(0, 0), input, 1e-9);
}

TEST(ModelChange, TheBiasDiesOutAndTheLoopEndsWithoutOffset) {
  for (const TsModel& other : {test::firstOrder(0.5, 0.9, 1.0), otherShape()}) {
    Loop loop;
    loop.run(18);
    loop.session->setModel(other);
    loop.run(400);
    EXPECT_NEAR(loop.y, 3.0, 1e-6);
  }
}

TEST(ModelChange, TheSameModelAgainChangesNothingAtAll) {
  for (const FmbpcRealisation realisation :
       {FmbpcRealisation::kParallel, FmbpcRealisation::kRealigned}) {
    Loop with(params(realisation)), without(params(realisation));
    for (int i = 0; i < 40; ++i) {
      if (i % 3 == 1) with.session->setModel(test::firstOrder(0.85, 0.12, 0.0));
      ASSERT_NEAR(with.step(), without.step(), 1e-9) << wordOf(realisation) << " " << i;
    }
  }
}

TEST(ModelChange, OfTwoModelsBetweenTwoSamplesTheLastOneCounts) {
  Loop once, twice;
  once.run(18);
  twice.run(18);
  twice.session->setModel(otherShape());
  once.session->setModel(test::firstOrder(0.5, 0.9, 1.0));
  twice.session->setModel(test::firstOrder(0.5, 0.9, 1.0));
  for (int i = 0; i < 10; ++i) ASSERT_EQ(once.step(), twice.step());
}

TEST(ModelChange, AGapOrManualBetweenModelAndSampleStartsTheNewModelFromTheAppliedInput) {
  Loop loop;
  loop.run(18);
  loop.session->setModel(otherShape());
  loop.session->manual(true);
  const double by_hand = loop.step();
  loop.session->manual(false);
  EXPECT_NEAR(loop.step(), by_hand, 1e-12);
  ASSERT_EQ(loop.session->answer().prediction.state.size(), 4);
  loop.run(400);
  EXPECT_NEAR(loop.y, 3.0, 1e-6);
}

TEST(ModelRefusal, WhatDoesNotFitIsNamedAndTheOldModelStays) {
  TsModel poisoned = test::firstOrder(0.85, 0.12, 0.0);
  poisoned.submodels[0].rules[0].coefficients[0] = std::numeric_limits<double>::quiet_NaN();
  TsModel names = test::firstOrder(0.85, 0.12, 0.0);
  names.inputs[0].name = "v";
  TsModel units = test::firstOrder(0.85, 0.12, 0.0);
  units.outputs[0].unit = "furlong";
  TsModel slow = test::firstOrder(0.85, 0.12, 0.0);
  slow.sample_time_s = 2.0;
  TsModel sizes = test::firstOrder(0.85, 0.12, 0.0);
  sizes.submodels[0].rules[0].coefficients.resize(5);
  const std::vector<std::pair<TsModel, std::string>> cases = {
      {poisoned, "finite"},    {names, "v"},   {units, "furlong"}, {slow, "sample_time_s"},
      {sizes, "coefficients"}, {TsModel(), ""}};
  for (const auto& [model, word] : cases) {
    Loop with, without;
    with.run(18);
    without.run(18);
    const std::string words = with.refusal(model);
    EXPECT_FALSE(words.empty()) << word;
    EXPECT_NE(words.find(word), std::string::npos) << words;
    EXPECT_EQ(with.session->models(), 1u);
    for (int i = 0; i < 10; ++i) ASSERT_EQ(with.step(), without.step()) << word;
  }
}

TEST(ModelRefusal, AModelUnstableAtThePresentSampleIsRefusedUnlessTheLoopAllowsIt) {
  const TsModel unstable = test::firstOrder(1.02, 0.12, 0.0);
  Loop strict;
  strict.run(18);
  EXPECT_NE(strict.refusal(unstable).find("model.max_pole 1, got 1.02"), std::string::npos);
  EXPECT_EQ(strict.session->models(), 1u);
  Loop lenient(params(), 1.05);
  lenient.run(18);
  EXPECT_EQ(lenient.refusal(unstable), "");
  EXPECT_EQ(lenient.session->models(), 2u);
}

TEST(ModelRefusal, AModelThatIsUnstableElsewhereIsTaken) {
  TsModel model = otherShape();
  model.submodels[0].antecedents = {{SignalKind::kOutput, 0, 0}};
  for (Rule& rule : model.submodels[0].rules)
    rule.antecedents[0] = {MembershipShape::kTriangular, {-1e3, 0.0, 50.0}};
  model.submodels[0].rules[1].antecedents[0] = {MembershipShape::kTriangular, {50.0, 100.0, 1e3}};
  model.submodels[0].rules[1].coefficients[0] = 1.5;
  Loop loop;
  loop.run(18);
  EXPECT_EQ(loop.refusal(model), "");
}

TEST(ModelRefusal, AFirstModelIsNotJudgedByItsPoles) {
  // FM_2 has rules with poles 1.00 and 1.03; a loop that names it must run.
  Loop loop;
  EXPECT_EQ(loop.refusal(test::firstOrder(1.02, 0.12, 0.0)),
            "");  // no sample yet, nothing to judge it at
  EXPECT_EQ(loop.session->models(), 2u);
  for (const char* name : {"fm_1", "fm_2"}) {
    PlantInfo info = test::activatedSludgeInfo();
    info.header.time_ns = 1000000000;
    SetpointParams setpoint;
    setpoint.initial = test::pair(55.0, 2000.0);
    const double infinite = std::numeric_limits<double>::infinity();
    setpoint.lower = Vector::Constant(2, -infinite);
    setpoint.upper = setpoint.rate_per_h = Vector::Constant(2, infinite);
    ControllerSession session(
        std::make_unique<FmbpcLaw>(test::publishedParams(), test::wideLimits(1, 1600.0), info),
        setpoint, test::wideLimits(1, 1600.0), one(570.0), info);
    Measurement m;
    m.header.run_id = 1;
    m.outputs = test::pair(55.0, 2000.0);
    m.disturbances = test::pair(1300.0, 366.67);
    m.input_applied = one(570.0);
    EXPECT_EQ(session.receive(m), Receipt::kNotReady);
    EXPECT_NO_THROW(session.setModel(test::shippedModel(name)));
  }
}

}  // namespace control_fmbpc_model_change_test
}  // namespace fpc
