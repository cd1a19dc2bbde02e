// New weights, horizons and models in a running loop: no bump, and they do take effect.
#include <gtest/gtest.h>

#include <cmath>

#include "control/fuzzy_lq/fixture.hpp"
#include "fmbpc/base/input_error.hpp"
#include "runtime/session.hpp"

namespace fpc {
namespace control_optimal_retune_test {

Vector one(double value) { return Vector::Constant(1, value); }

struct Loop {
  explicit Loop(FuzzyOptimalParams params, std::vector<SetpointStep> schedule = {})
      : plant(test::firstOrder(0.9, 0.1, 0.2), one(0.0), one(0.0), Vector()),
        setpoint(test::setpointOf(test::infoOf(test::firstOrder(0.9, 0.1, 0.2)), one(2.0),
                                  std::move(schedule))),
        law(std::move(params), test::wideLimits(1), test::infoOf(test::firstOrder(0.9, 0.1, 0.2))) {
    law.setModel(test::firstOrder(0.85, 0.12, 0.0));
    law.reset(plant.measure(0));
  }
  double step() {
    const Measurement now = plant.measure(k);
    setpoint.advance(k++);
    law.step(now, setpoint, output);
    EXPECT_TRUE(output.ok);
    y = now.outputs[0];
    plant.advance(output.input);
    return output.input[0];
  }
  double run(int samples) {
    for (int i = 1; i < samples; ++i) step();
    return step();
  }

  test::ModelPlant plant;
  SetpointSource setpoint;
  FuzzyOptimalLaw law;
  ControllerOutput output;
  std::uint32_t k{};
  double y{};
};

FuzzyOptimalParams params(double decay = 0.9) {
  FuzzyOptimalParams p = test::optimalParams(1, 1, 8, 2, 0.5);
  p.transfer_decay = decay;
  return p;
}

FuzzyOptimalTuning quick(const FuzzyOptimalLaw& law) {
  FuzzyOptimalTuning tuning = law.tuning();
  tuning.horizon_steps = 3;
  tuning.move_steps = 1;
  tuning.weight.move = one(0.001);
  return tuning;
}

TEST(FuzzyOptimalRetune, AtRestNothingMoves) {
  Loop loop(params());
  const double before = loop.run(300);
  loop.law.retune(quick(loop.law));
  for (int i = 0; i < 50; ++i) EXPECT_NEAR(loop.step(), before, 1e-9);
  loop.law.setModel(test::firstOrder(0.8, 0.3, -0.4));
  for (int i = 0; i < 50; ++i) EXPECT_NEAR(loop.step(), before, 1e-9);
}

TEST(FuzzyOptimalRetune, InTheMiddleOfAMoveTheInputIsTheOneTheOldLawWouldHaveSent) {
  const std::vector<SetpointStep> step{{50.0 / 3600.0, one(3.0), 0.0}};
  for (const int at : {51, 53, 60}) {
    Loop calm(params(), step), retuned(params(), step), swapped(params(), step);
    for (Loop* loop : {&calm, &retuned, &swapped}) loop->run(at);
    retuned.law.retune(quick(retuned.law));
    swapped.law.setModel(test::firstOrder(0.8, 0.2, 0.1));
    const double old = calm.step();
    EXPECT_NEAR(retuned.step(), old, 1e-12);
    EXPECT_NEAR(swapped.step(), old, 1e-12);
    const double next = calm.step();
    EXPECT_GT(std::abs(retuned.step() - next), 1e-6);  // and then the new one is at work
    EXPECT_GT(std::abs(swapped.step() - next), 1e-6);
  }
}

TEST(FuzzyOptimalRetune, TheNextSetpointIsReachedAsTheNewWeightsSay) {
  const std::vector<SetpointStep> step{{400.0 / 3600.0, one(3.0), 0.0}};
  Loop calm(params(), step), retuned(params(), step);
  FuzzyOptimalParams fresh_params = params();
  fresh_params.tuning = quick(calm.law);
  Loop fresh(fresh_params, step);
  calm.run(300);
  retuned.run(300);
  fresh.run(300);
  retuned.law.retune(quick(retuned.law));
  for (int i = 300; i < 406; ++i) {
    calm.step();
    EXPECT_NEAR(retuned.step(), fresh.step(), 1e-7);
  }
  EXPECT_GT(retuned.y, calm.y + 1e-3);
  EXPECT_EQ(retuned.law.tuning().horizon_steps, 3);
}

TEST(FuzzyOptimalRetune, WhatIsRefusedChangesNothing) {
  Loop loop(params()), untouched(params());
  loop.run(20);
  untouched.run(20);
  FuzzyOptimalTuning bad = loop.law.tuning();
  bad.move_steps = 9;  // beyond the horizon
  EXPECT_THROW(loop.law.retune(bad), InputError);
  bad = loop.law.tuning();
  bad.rules.assign(2, bad.weight);  // the model has one rule
  EXPECT_THROW(loop.law.retune(bad), InputError);
  EXPECT_EQ(loop.law.tuning().move_steps, 2);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(loop.step(), untouched.step());
}

TEST(FuzzyOptimalRetune, BeforeTheFirstSampleTheNewTuningIsSimplyThere) {
  Loop retuned(params());
  retuned.law.retune(quick(retuned.law));
  FuzzyOptimalParams fresh = params();
  fresh.tuning = quick(retuned.law);
  Loop other(fresh);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(retuned.step(), other.step());
}

TEST(FuzzyOptimalSettings, AreTextsThatReadBack) {
  std::mt19937_64 generator(4);
  const TsModel model = test::dominantModel(generator, 2);
  FuzzyOptimalParams p = test::optimalParams(2, 2, 5, 1, 0.1);
  FuzzyOptimalLaw law(p, test::wideLimits(2), test::infoOf(model));
  law.setModel(model);
  const Settings before = law.settings();
  EXPECT_EQ(before[2], (std::pair<std::string, std::string>{"weight_output", "y1=1 y2=1"}));
  EXPECT_TRUE(law.retune(before));
  EXPECT_EQ(law.settings(), before);
  law.retune({{"weight_move", "u2=0.5"}, {"horizon_steps", "7"}, {"weight_output", "2"}});
  EXPECT_EQ(law.tuning().weight.move, test::pair(0.1, 0.5));
  EXPECT_EQ(law.tuning().weight.output, test::pair(2.0, 2.0));
  EXPECT_EQ(law.tuning().horizon_steps, 7);
  law.retune({{"weight_move", "u1=1; 2, 3; 4"}});
  ASSERT_EQ(law.tuning().rules.size(), 3U);
  EXPECT_EQ(law.tuning().rules[0].move, test::pair(1.0, 0.5));
  EXPECT_EQ(law.tuning().rules[1].move, test::pair(2.0, 3.0));
  EXPECT_EQ(law.tuning().rules[2].move, test::pair(4.0, 4.0));
  EXPECT_EQ(law.tuning().rules[2].output, test::pair(2.0, 2.0));
  const Settings by_rule = law.settings();
  EXPECT_EQ(by_rule[3].second, "u1=1 u2=0.5; u1=2 u2=3; u1=4 u2=4");
  law.retune(by_rule);
  EXPECT_EQ(law.settings(), by_rule);
}

TEST(FuzzyOptimalSettings, WhatIsNoneIsRefusedByKey) {
  Loop loop(params());
  const std::pair<std::string, std::string> bad[] = {
      {"weight_move", "z=1"},    {"weight_move", "1 2"},    {"weight_move", ""},
      {"weight_move", "-1"},     {"weight_output", "much"}, {"move_steps", "9"},
      {"horizon_steps", "0"},    {"horizon_steps", "2.5"},  {"input_target", "inf"},
      {"reference_pole", "much"}};
  const Settings before = loop.law.settings();
  for (const auto& setting : bad) try {
      loop.law.retune({setting});
      ADD_FAILURE() << setting.first << ": " << setting.second << " was taken";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("controller." + setting.first), std::string::npos)
          << error.what();
    }
  EXPECT_THROW(loop.law.retune({{"weight_move", "1; 2"}}), InputError);  // the model has one rule
  EXPECT_EQ(loop.law.settings(), before);
}

TEST(FuzzyOptimalRetune, AStartInTheMiddleOfARunGoesOnFromTheAppliedInput) {
  Loop loop(params());
  loop.run(5);
  for (int i = 0; i < 30; ++i) {  // a person's input
    loop.plant.advance(one(0.7));
    ++loop.k;
  }
  loop.law.reset(loop.plant.measure(loop.k));
  EXPECT_NEAR(loop.step(), 0.7, 1e-12);
  EXPECT_LT(std::abs(loop.step() - 0.7), 0.5);
  loop.run(300);
  EXPECT_NEAR(loop.y, 2.0, 1e-8);
}

}  // namespace control_optimal_retune_test
}  // namespace fpc
