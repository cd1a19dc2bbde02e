// An output that nobody measures: a filter on paper, and a law that is handed what it says.
#include "estimation/output_estimator.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "control/estimating_controller.hpp"
#include "runtime/session_fixture.hpp"

namespace fpc::test_session {
namespace control_output_estimator_test {

/// h(k+1) = 0.9 h + u, y(k+1) = 0.5 y + 0.4 h: h is not measured.
TsModel model() {
  TsModel m;
  m.name = "hidden";
  m.sample_time_s = 720.0;
  m.outputs = {{"s", "mg/l", -1e6, 1e6}, {"x", "mg/l", -1e6, 1e6}};
  m.inputs = {{"q_r", "m3/h", -1e6, 1e6}};
  OutputModel hidden, shown;
  hidden.regressors = {{SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, 0}};
  shown.regressors = {{SignalKind::kOutput, 0, 0}, {SignalKind::kOutput, 1, 0}};
  Rule one, two;
  one.coefficients = of({0.9, 1.0});
  two.coefficients = of({0.4, 0.5});
  hidden.rules = {one};
  shown.rules = {two};
  m.submodels = {hidden, shown};
  return m;
}

EstimatorParams params(double noise) {
  EstimatorParams p;
  p.outputs = {0};
  p.initial = of({0.0, 0.0});
  p.initial_std = of({3.0, 0.0});
  p.noise_std = of({0.0, noise});
  p.process_std = of({0.2, 0.1});
  return p;
}

TEST(OutputEstimator, FindsWhatIsHidden) {
  OutputEstimator estimator(model(), params(0.01));
  double h = 7.0, y = 2.0;
  estimator.rest(of({std::nan(""), y}), of({0.0}), Vector());
  for (int k = 0; k < 40; ++k) {
    const double u = std::sin(0.4 * k);
    const double h_next = 0.9 * h + u;
    y = 0.5 * y + 0.4 * h;
    h = h_next;
    estimator.advance(of({-1e9, y}), of({u}), Vector());
    EXPECT_NEAR(estimator.estimate(1), y, 0.05);
  }
  EXPECT_NEAR(estimator.estimate(0), h, 1e-3);
}

// One step by hand: P = diag(9, 0) -> F P F' + Q, K = P c / (c' P c + R).
TEST(OutputEstimator, OneStepOnPaper) {
  OutputEstimator estimator(model(), params(0.5));
  EstimatorParams exact = params(0.5);
  estimator.rest(of({0.0, 0.0}), of({0.0}), Vector());
  const double p_yy = 0.4 * 0.4 * 9.0 + 0.5 * 0.5 * 0.25 + 0.01, p_hy = 0.9 * 0.4 * 9.0;
  const double p_hh = 0.81 * 9.0 + 0.04, s = p_yy + 0.25;
  estimator.advance(of({0.0, 3.0}), of({0.0}), Vector());
  EXPECT_NEAR(estimator.estimate(0), p_hy / s * 3.0, 1e-6);
  EXPECT_NEAR(estimator.estimate(1), p_yy / s * 3.0, 1e-6);
  EXPECT_NEAR(estimator.deviation(0), std::sqrt(p_hh - p_hy * p_hy / s), 1e-6);
  EXPECT_EQ(exact.outputs.size(), 1U);
}

TEST(OutputEstimator, MistakesNameTheirKey) {
  const auto errorWith = [](const std::function<void(EstimatorParams&)>& change) -> std::string {
    EstimatorParams p = params(0.1);
    change(p);
    try {
      p.validate(2);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  const auto names = [](const std::string& error, const std::string& key) {
    EXPECT_NE(error.find(key), std::string::npos) << error;
  };
  names(errorWith([](EstimatorParams& p) { p.outputs = {0, 1}; }), "estimator.outputs");
  names(errorWith([](EstimatorParams& p) { p.outputs = {2}; }), "estimator.outputs");
  names(errorWith([](EstimatorParams& p) { p.process_std[0] = 0.0; }), "estimator.process_std");
  names(errorWith([](EstimatorParams& p) { p.noise_std[1] = -1.0; }), "estimator.noise_std");
  names(errorWith([](EstimatorParams& p) { p.initial[0] = std::nan(""); }), "estimator.initial");
}

/// Keeps what it was shown.
struct Witness final : Controller {
  void reset(const Measurement& start) override { seen = start; }
  void step(const Measurement& now, const SetpointSource&, ControllerOutput& output) override {
    seen = now;
    output.input = now.input_applied;
  }
  bool needsModel() const override { return true; }
  void setModel(const TsModel&) override {}
  Measurement seen;
};

TEST(EstimatingController, TheLawSeesTheEstimateWhateverIsMeasured) {
  auto owned = std::make_unique<Witness>();
  Witness& law = *owned;
  PlantInfo info = plant();
  for (SignalInfo& output : info.outputs) output.lower = -1e6, output.upper = 1e6;
  EstimatingController controller(std::move(owned), params(0.01), info);
  TsModel m = model();
  m.disturbances = {{"q_i", "m3/h", 0, 1e6}};
  controller.setModel(m);
  SetpointSource setpoint{setpoints(), {"s", "x"}, SampleClock(720.0, 1.0)};
  ControllerOutput out;
  double h = 7.0, y = 2.0;
  for (std::uint32_t k = 0; k < 40; ++k) {
    Measurement now = sample(k, 1, 0.5);
    now.outputs = of({1e5, y});
    if (k == 0) controller.reset(now);
    setpoint.advance(k);
    controller.step(now, setpoint, out);
    EXPECT_NE(law.seen.outputs[0], 1e5);
    EXPECT_NEAR(law.seen.outputs[1], y, 0.2);
    if (k == 39) break;
    y = 0.5 * y + 0.4 * h;
    h = 0.9 * h + 0.5;
  }
  EXPECT_NEAR(law.seen.outputs[0], h, 0.01);
  EXPECT_EQ(controller.signals().back().first, "s_estimate");
  EXPECT_EQ(controller.signals().back().second, law.seen.outputs[0]);
  controller.setModel(m);  // another model goes on from the estimate
  Measurement now = sample(40, 1, 0.5);
  now.outputs = of({1e5, y});
  controller.step(now, setpoint, out);
  EXPECT_NEAR(law.seen.outputs[0], h, 0.05);
}

}  // namespace control_output_estimator_test
}  // namespace fpc::test_session
