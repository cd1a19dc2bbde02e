// How far ahead a plan is trusted: on paper, and what the guard says of it.
#include "supervision/horizon_trust.hpp"

#include <cmath>

#include "runtime/session_fixture.hpp"
#include "supervision/guard.hpp"

namespace fpc::test_session {
namespace control_horizon_trust_test {

/// A law that plans 20 samples: x rises by `slope` in each of them.
struct Planner final : Controller, PlanView {
  void reset(const Measurement&) override {}
  void step(const Measurement& now, const SetpointSource&, ControllerOutput& output) override {
    output.input = of({wish});
    output.source = ActionSource::kBase;
    output.predictive = false;
    output.ok = true;
    x = now.outputs[1];
  }
  bool needsModel() const override { return true; }
  void setModel(const TsModel&) override {}
  Eigen::Index plannedSteps() const override { return 20; }
  void planned(Eigen::Index i, Eigen::Ref<Vector> point) const override {
    point << 55.0, x + slope * static_cast<double>(i), 600.0, 1300.0;
  }
  void setTrustThreshold(double threshold, Eigen::Index least) override {
    heeded = threshold;
    counted = least;
  }
  double x{}, slope{}, wish{600.0}, heeded{};
  Eigen::Index counted{};
};

class PlanAhead : public testing::Test {
 protected:
  PlanAhead() { make({}); }
  void make(GuardParams params) {
    auto owned = std::make_unique<Planner>();
    planner = owned.get();
    params.lock_samples = 0;
    guard =
        std::make_unique<GuardedController>(std::move(owned), nullptr, params, limits(), plant());
    guard->setModel(boxModel());
    guard->reset(sample(0));
  }
  void step(double x, double slope) {
    planner->slope = slope;
    Measurement now = sample(k++, 1, 590.0);
    now.outputs[1] = x;
    setpoint.advance(now.header.step);
    guard->step(now, setpoint, out);
  }
  double signal(const std::string& name) const {
    for (const auto& [key, value] : guard->signals())
      if (key == name) return value;
    return std::nan("");
  }
  Planner* planner{};
  std::unique_ptr<GuardedController> guard;
  SetpointSource setpoint{setpoints(), {"s", "x"}, SampleClock(720.0, 1.0)};
  ControllerOutput out;
  std::uint32_t k{};
};

TEST_F(PlanAhead, InsideTheDataNothingIsSaid) {
  step(2000.0, 10.0);
  EXPECT_EQ(signal("model_trust_ahead"), 1.0);
  EXPECT_EQ(signal("model_trust_steps"), 20.0);
  EXPECT_TRUE(out.events.empty());
}

TEST_F(PlanAhead, HowFarItIsTrustedIsSaidAndNothingIsChanged) {
  step(2000.0, 18.0);  // the 15th: 2270
  EXPECT_LT(signal("model_trust_ahead"), 0.25);
  EXPECT_EQ(signal("model_trust"), 1.0);
  EXPECT_EQ(signal("model_trust_steps"), 15.0);
  EXPECT_TRUE(out.events.empty()) << "a signal, no event";
  EXPECT_EQ(out.input[0], 600.0);
  EXPECT_EQ(out.source, ActionSource::kBase);
  step(2000.0, 90.0);
  EXPECT_EQ(signal("model_trust_steps"), 3.0);
  step(2000.0, 0.0);
  EXPECT_EQ(signal("model_trust_steps"), 20.0);
}

// The fourth sample is 2360, where there is no trust: a quarter of the 1600 between the bounds is
// left to move. With the smaller slope the tenth is 2180, inside.
TEST_F(PlanAhead, MovesShrinkForWhatIsExpectedSoon) {
  planner->wish = 1500.0;
  step(2000.0, 18.0);
  EXPECT_EQ(out.input[0], 1500.0);
  step(2000.0, 90.0);
  EXPECT_DOUBLE_EQ(out.input[0], 590.0 + 0.25 * 1600.0);
  EXPECT_EQ(out.source, ActionSource::kGuarded);
}

TEST_F(PlanAhead, WithoutLookingAheadOnlyThePresentCounts) {
  GuardParams present;
  present.look_ahead = present.horizon_least = 0;
  make(present);
  EXPECT_EQ(planner->heeded, 0.0);
  planner->wish = 1500.0;
  step(2000.0, 90.0);
  EXPECT_EQ(out.input[0], 1500.0);
}

TEST_F(PlanAhead, ThePlannerIsToldHowFarItsErrorsCount) {
  EXPECT_EQ(planner->heeded, 0.25);
  EXPECT_EQ(planner->counted, 12);
}

// x(k+1) = x + 100 under its own feedback u = 600: 2000, 2100, ..., the third is 2300.
TEST(HorizonTrust, APredictiveActionIsRunForward) {
  PredictiveAction p;
  p.state = of({2000.0});
  p.A = Matrix::Constant(1, 1, 1.0);
  p.B = Matrix::Constant(1, 1, 0.5);
  p.C = (Matrix(2, 1) << 0.0, 1.0).finished();
  p.offset_state = of({-200.0});
  p.offset_output = of({55.0, 0.0});
  p.K = Matrix::Zero(1, 1);
  p.feedforward = Matrix::Constant(1, 6, 600.0);
  HorizonTrust trust;
  trust.judge(boxModel(), p, of({1300.0}), 0.25);
  EXPECT_EQ(trust.horizon(), 10);  // the last feedforward is held
  EXPECT_EQ(trust.trustedSteps(), 3);
  EXPECT_EQ(trust.least(), 0.0);
  trust.judge(boxModel(), p, of({9000.0}), 0.25);  // no such flow in the data
  EXPECT_EQ(trust.trustedSteps(), 1);
}

}  // namespace control_horizon_trust_test
}  // namespace fpc::test_session
