// The guard around a law of which everything is known: untouched inside, smaller moves and a PI
// outside, bumpless both ways.
#include "supervision/guard.hpp"

#include "control/pi/pi.hpp"

#include "runtime/session_fixture.hpp"

namespace fpc::test_session {
namespace control_guard_test {

/// Asks for the same input always.
struct Wish final : Controller {
  void reset(const Measurement& start) override { resets.push_back(start.header.step); }
  void forget() override { forgotten_before_reset = resets.size(); }
  void lookOn(const Measurement& now) override { looked_on.push_back(now.header.step); }
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override {
    output.input = of({wish});
    output.source = ActionSource::kBase;
    output.reference = setpoint.present();
    output.predictive = true;
    output.prediction = resting(now.outputs);
    output.ok = true;
    seen = now.input_applied[0];
  }
  /// Nothing moves, whatever the input.
  PredictiveAction resting(const Vector& outputs) const {
    PredictiveAction p;
    p.state = outputs;
    p.A = p.C = Matrix::Identity(2, 2);
    p.B = Matrix::Zero(2, 1);
    p.K = Matrix::Zero(1, 2);
    p.offset_state = p.offset_output = Vector::Zero(2);
    p.feedforward = Matrix::Constant(1, 1, wish);
    return p;
  }
  bool needsModel() const override { return true; }
  void setModel(const TsModel& model) override {
    if (refuses) throw InputError("a model that does not fit");
    models.push_back(model.name);
  }
  std::vector<std::uint32_t> resets, looked_on;
  std::vector<std::string> models;
  bool refuses{false};
  std::size_t forgotten_before_reset{99};
  double wish{700.0}, seen{};
};

class Guard : public testing::Test {
 protected:
  void make(GuardParams params, std::unique_ptr<Controller> fallback = nullptr) {
    auto owned = std::make_unique<Wish>();
    law = owned.get();
    guard = std::make_unique<GuardedController>(std::move(owned), std::move(fallback),
                                                std::move(params), limits(), plant());
    guard->setModel(boxModel());
    guard->reset(sample(0));
  }
  static GuardParams params() {
    GuardParams p;
    p.lock_samples = 0;
    p.least_move = 0.02;
    p.return_samples = 3;
    return p;
  }
  static std::unique_ptr<Controller> pi() {
    PiLoop loop;
    loop.output = 1;
    loop.kp = 0.5;
    loop.ki_per_h = 1.0;
    loop.bias = 775.0;
    PiParams params;
    params.loops = {loop};
    return std::make_unique<PiController>(params, limits(), plant());
  }
  double step(std::uint32_t k, double x, double applied) {
    Measurement now = sample(k, 1, applied);
    now.outputs[1] = x;
    setpoint.advance(k);
    guard->step(now, setpoint, out);
    return out.input[0];
  }

  Wish* law{};
  std::unique_ptr<GuardedController> guard;
  SetpointSource setpoint{setpoints(), {"s", "x"}, SampleClock(720.0, 1.0)};
  ControllerOutput out;
};

TEST_F(Guard, InsideTheDataTheLawPassesUntouched) {
  make(params());
  EXPECT_EQ(step(0, 2000.0, 570.0), 700.0);
  EXPECT_EQ(out.source, ActionSource::kBase);
  EXPECT_TRUE(out.predictive);
  EXPECT_EQ(out.prediction.input_lower[0], 0.0);
  EXPECT_EQ(out.prediction.input_upper[0], 1600.0);
  EXPECT_TRUE(out.events.empty());
  EXPECT_EQ(guard->view().trust, 1.0);
  EXPECT_EQ(guard->signals().front().first, "model_trust");
  EXPECT_EQ(guard->signals().front().second, 1.0);
}

TEST_F(Guard, OutsideMovesShrinkToTheLeast) {
  make(params());
  // x 2200 + half of its range: no trust at all.
  EXPECT_DOUBLE_EQ(step(0, 2400.0, 570.0), 570.0 + 0.02 * 1600.0);
  EXPECT_EQ(out.source, ActionSource::kGuarded);
  ASSERT_TRUE(out.predictive);  // an optimizer stays in charge of the limits of outputs
  EXPECT_DOUBLE_EQ(out.prediction.input_lower[0], 570.0 - 0.02 * 1600.0);
  EXPECT_DOUBLE_EQ(out.prediction.input_upper[0], 570.0 + 0.02 * 1600.0);
  EXPECT_TRUE(out.events.has(EventCode::kOutsideModel));
  EXPECT_TRUE(guard->view().outside);
  EXPECT_EQ(guard->signals().front().second, 0.0);
}

TEST_F(Guard, AWishOutsideTheDataIsSeenAndGranted) {
  make(params());
  law->wish = 1400.0;  // two thirds of the range beyond
  EXPECT_DOUBLE_EQ(step(0, 2000.0, 990.0), 1400.0);
  EXPECT_EQ(guard->view().trust, 0.0);
  EXPECT_TRUE(guard->view().outside);
  EXPECT_TRUE(out.events.empty()) << "the process is inside";
  EXPECT_EQ(out.source, ActionSource::kBase);
}

TEST_F(Guard, BetweenTheThresholdsMovesShrinkInProportion) {
  GuardParams p = params();
  p.trust_low = 0.0;
  p.trust_high = 1.0;
  make(p);
  law->wish = 0.0;
  const double moved = 900.0 - step(0, 2250.0, 900.0);  // an eighth of the range: trust 0.5
  EXPECT_NEAR(moved, (0.02 + 0.48 * 0.5) * 1600.0, 1e-9);
}

TEST_F(Guard, ThePiTakesOverWithoutABumpAndTheLawComesBackWithoutOne) {
  make(params(), pi());
  EXPECT_EQ(step(0, 2000.0, 570.0), 700.0);
  EXPECT_EQ(step(1, 2400.0, 700.0), 700.0);  // bumpless
  EXPECT_EQ(out.source, ActionSource::kFallback);
  EXPECT_LT(step(2, 2400.0, 700.0), 700.0);  // x too high: less
  law->resets.clear();
  EXPECT_NE(step(3, 2000.0, 690.0), 700.0);
  EXPECT_NE(step(4, 2000.0, 690.0), 700.0);
  EXPECT_TRUE(law->resets.empty());
  EXPECT_EQ(law->forgotten_before_reset, 99U);
  EXPECT_EQ(step(5, 2000.0, 690.0), 700.0);  // the third sample inside
  EXPECT_EQ(law->resets, Steps{5});          // reset: its own bumpless start
  EXPECT_EQ(law->forgotten_before_reset, 0U) << "what it learned out there, before that reset";
  EXPECT_EQ(out.source, ActionSource::kBase);
}

TEST_F(Guard, ALawWithAModelIsAFallbackThatFollowsTheProcess) {
  auto owned = std::make_unique<Wish>();
  Wish* fallback = owned.get();
  fallback->wish = 650.0;
  make(params(), std::move(owned));
  EXPECT_EQ(fallback->models.size(), 1U);
  EXPECT_EQ(step(0, 2000.0, 570.0), 700.0);
  EXPECT_EQ(step(1, 2000.0, 700.0), 700.0);
  EXPECT_EQ(fallback->looked_on, (Steps{0, 1}));
  fallback->resets.clear();
  EXPECT_EQ(step(2, 2400.0, 700.0), 650.0);
  EXPECT_EQ(out.source, ActionSource::kFallback);
  EXPECT_FALSE(out.predictive);
  EXPECT_EQ(fallback->resets, Steps{2}) << "from the present sample";
  EXPECT_EQ(fallback->looked_on, (Steps{0, 1})) << "it acts";
  fallback->wish = 2000.0;
  EXPECT_EQ(step(3, 2400.0, 650.0), 1600.0) << "limits hold";
  guard->lookOn(sample(4));
  EXPECT_EQ(fallback->looked_on.back(), 4U);
  EXPECT_EQ(law->looked_on, Steps{4});
}

TEST_F(Guard, AnInputThatTheModelDoesNotKnowIsNeverLockedUp) {
  GuardParams p = params();
  p.lock_samples = 8;
  for (const bool known : {true, false}) {
    make(p);
    TsModel model = boxModel();
    if (!known)
      for (OutputModel& sub : model.submodels)
        for (auto* of : {&sub.regressors, &sub.antecedents})
          for (Regressor& r : *of)
            if (r.kind == SignalKind::kInput) r = {SignalKind::kOutput, 0, 3};
    guard->setModel(model);
    law->wish = limits().lower[0];
    bool acted = false;
    double applied = law->wish;
    for (std::uint32_t k = 1; k < 200; ++k) {
      applied = step(k, 900.0 - k, applied);  // further and further from its setpoint
      acted = acted || applied != law->wish;
    }
    EXPECT_EQ(acted, known);
  }
}

// A law that is not stable with this plant does not become so: the PI stays.
TEST_F(Guard, WhatSwingsFurtherEachTimeIsHandedToTheFallbackForGood) {
  GuardParams p = params();
  p.growing_swings = 6;
  make(p, pi());
  double applied = 700.0;
  std::uint32_t handed = 0;
  for (std::uint32_t k = 1; k < 150; ++k) {
    law->wish = 700.0 + (k < 70 ? std::pow(1.05, k) * std::sin(k) : 0.0);
    applied = step(k, 1800.0, applied);
    if (out.source != ActionSource::kFallback) continue;
    if (handed == 0) handed = k;
    EXPECT_TRUE(out.events.has(EventCode::kOscillationGrows)) << k;
  }
  EXPECT_GT(handed, 15U);
  EXPECT_LT(handed, 40U);
  EXPECT_EQ(out.source, ActionSource::kFallback) << "long after the law is quiet again";
  guard->reset(sample(150));
  step(151, 1800.0, 700.0);
  EXPECT_EQ(out.source, ActionSource::kBase);
}

TEST_F(Guard, AModelThatTheFallbackRefusesIsNoBodysModel) {
  auto owned = std::make_unique<Wish>();
  Wish* fallback = owned.get();
  make(params(), std::move(owned));
  fallback->refuses = true;
  TsModel other = boxModel();
  other.name = "other";
  EXPECT_THROW(guard->setModel(other), InputError);
  EXPECT_EQ(law->models.back(), boxModel().name);
}

TEST_F(Guard, InASwingALawWithAModelBeginsAtThePresentSample) {
  GuardParams p = params();
  p.growing_swings = 6;
  auto owned = std::make_unique<Wish>();
  Wish* fallback = owned.get();
  make(p, std::move(owned));
  fallback->resets.clear();
  double applied = 700.0;
  std::uint32_t k = 0;
  while (k < 70 && out.source != ActionSource::kFallback) {
    law->wish = 700.0 + std::pow(1.05, ++k) * std::sin(k);
    out.begin();
    applied = step(k, 1800.0, applied);
  }
  EXPECT_LT(k, 40U);
  EXPECT_EQ(fallback->resets, Steps{k});
  EXPECT_EQ(fallback->seen, 700.0 + std::pow(1.05, k - 1) * std::sin(k - 1));
}

// Outside the model's data the plant swings under the fallback; the law had swung a little before.
TEST_F(Guard, OnlySwingsOfTheLawAreCounted) {
  GuardParams p = params();
  p.growing_swings = 6;
  make(p, pi());
  double applied = 700.0;
  for (std::uint32_t k = 1; k < 130; ++k) {
    const bool outside = k > 12 && k < 65;
    const double wave = std::pow(1.05, k % 64) * std::sin(k);
    law->wish = 700.0 + (k <= 12 || (k > 65 && k < 80) ? wave : 0.0);
    Measurement now = sample(k, 1, applied);
    now.outputs[1] = 2000.0 + (outside ? 10.0 * wave : 0.0);
    if (outside) now.disturbances[0] = 3000.0;
    setpoint.advance(k);
    out.begin();
    guard->step(now, setpoint, out);
    applied = out.input[0];
    EXPECT_FALSE(out.events.has(EventCode::kOscillationGrows)) << k;
    EXPECT_EQ(out.source == ActionSource::kFallback, k > 12 && k < 67) << k;
  }
}

TEST_F(Guard, MistakesNameTheirKey) {
  const auto errorWith = [](const std::function<void(GuardParams&)>& change) -> std::string {
    GuardParams p = params();
    change(p);
    try {
      p.validate(2, false);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  const auto names = [](const std::string& error, const std::string& key) {
    EXPECT_NE(error.find(key), std::string::npos) << error;
  };
  names(errorWith([](GuardParams& p) { p.trust_high = 0.1; }), "guard.trust");
  names(errorWith([](GuardParams& p) { p.return_samples = 0; }), "guard.return_samples");
  names(errorWith([](GuardParams& p) { p.lock_samples = -1; }), "guard.lock_samples");
  names(errorWith([](GuardParams& p) { p.growing_swings = 2; }), "guard.growing_swings");
  names(errorWith([](GuardParams& p) { p.growing_swings = 6; }), "guard.fallback");
  names(errorWith([](GuardParams& p) { p.lock_outputs = {2}; }), "outputs that the law follows");
}

}  // namespace control_guard_test
}  // namespace fpc::test_session
