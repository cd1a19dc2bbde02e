// The reactor with bounds that bite: baselines with and without anti-windup, and the law, whose two
// models take what was applied and therefore cannot wind up.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "fmbpc/model/local_model.hpp"
#include "runtime/factory.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace paper_cstr_limits_test {

Overrides bounds(const std::string& lower, const std::string& upper) {
  return {{"actuator.input_lower.q_c", lower}, {"actuator.input_upper.q_c", upper}};
}

double score(const std::string& name, const Overrides& overrides) {
  const LoopFile loop = readLoop(name, overrides);
  const Summary summary = summarize(loop, runLoop(loop), 0.0);
  std::printf("%-24s %s %s  %.6f\n", name.c_str(), overrides[0].second.c_str(),
              overrides[1].second.c_str(), summary.outputs[0].ise_reference);
  EXPECT_EQ(summary.input_violations, 0U) << name;
  EXPECT_GE(summary.inputs[0].min, std::stod(overrides[0].second)) << name;
  EXPECT_LE(summary.inputs[0].max, std::stod(overrides[1].second)) << name;
  return summary.outputs[0].ise_reference;
}

TEST(CstrLimits, AntiWindupHelpsThePiOnceAndHarmsItOnce) {
  EXPECT_NEAR(score("cstr_tracking_pi", bounds("85", "115")), 0.01689, 1e-5);
  EXPECT_NEAR(score("cstr_tracking_pi_aw", bounds("85", "115")), 0.01381, 1e-5);
  EXPECT_NEAR(score("cstr_tracking_pi", bounds("60", "113")), 0.01586, 1e-5);
  EXPECT_NEAR(score("cstr_tracking_pi_aw", bounds("60", "113")), 0.01646, 1e-5);
}

// Both models are run again from what was applied; they must agree with the signals of the law.
TEST(CstrLimits, BothModelsTakeTheClippedInput) {
  const LoopFile loop = readLoop("cstr_tracking", bounds("85", "112"));
  Simulation reactor = makeSimulation(loop);
  ControllerSession session = makeControllerSession(loop);
  session.setModel(loop.model);
  LocalModel model(loop.model);  // with its delay: all past inputs in the state
  Vector state(model.stateSize());
  const Vector none(0);
  int clipped = 0;
  model.restState(reactor.measurement().outputs, reactor.measurement().input_applied, none, state);
  const auto signal = [&](const std::string& name) {
    for (const auto& [key, value] : session.controller().signals())
      if (key == name) return value;
    return std::nan("");
  };
  for (int k = 0; k < 400; ++k) {
    const Measurement& now = reactor.measurement();
    session.receive(now);
    ASSERT_NEAR(signal("CA_model"), state[model.outputState(0)], 1e-12) << "sample " << k;
    clipped += session.answer().base.source == ActionSource::kClipped;
    const Vector applied = session.answer().base.input;
    model.blend(state, none);
    state = (model.affine().A * state + model.affine().B * applied + model.affine().g).eval();
    reactor.advance(applied);
  }
  EXPECT_GT(clipped, 20);
}

/// sum of (y_r - y)^2 from two minutes after the setpoint is back within reach.
double errorAfterwards(const std::string& name, const std::string& lower) {
  const RunRecord record = runLoop(readLoop(name, bounds(lower, "115")));
  double sum = 0.0;
  for (std::size_t k = 320; k <= 400; ++k)
    sum += std::pow(
        record.samples[k].tracking.reference[0] - record.samples[k].measurement.outputs[0], 2);
  std::printf("%-24s bound %2s: after 32 min %.6f\n", name.c_str(), lower.c_str(), sum);
  return sum;
}

// 0.045 mol/l needs 80.7 l/min: with 85 as lower bound it stays out of reach from 20 to 30 min.
TEST(CstrLimits, TheLawDoesNotWindUpAtItsBoundAndPiDoes) {
  for (const char* law : {"cstr_tracking", "cstr_tracking_literal", "cstr_tracking_preview"})
    EXPECT_LE(errorAfterwards(law, "85"), errorAfterwards(law, "0")) << law;
  const double wound = errorAfterwards("cstr_tracking_pi", "85");
  EXPECT_GT(wound, errorAfterwards("cstr_tracking_pi", "0"));
  EXPECT_GT(wound, 1.5 * errorAfterwards("cstr_tracking_pi_aw", "85"));
}

TEST(CstrLimits, TheLawKeepsItsLeadWithinBounds) {
  for (const auto& [lower, upper] : {std::pair("85", "115"), std::pair("60", "113")}) {
    const double law = score("cstr_tracking", bounds(lower, upper));
    EXPECT_LT(law, score("cstr_tracking_pi_aw", bounds(lower, upper)));
    EXPECT_LT(law, score("cstr_tracking_pi", bounds(lower, upper)));
    EXPECT_LT(law, score("cstr_tracking_gspi", bounds(lower, upper)));
  }
}

}  // namespace paper_cstr_limits_test
}  // namespace fpc
