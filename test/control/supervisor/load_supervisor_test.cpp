#include "control/supervisor/load_supervisor.hpp"

#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace control_supervisor_load_supervisor_test {

PlantInfo plant() {
  PlantInfo info;
  info.sample_time_s = 1800.0;
  info.outputs = {{"S", "g/m3", 0.0, 100.0}};
  info.inputs = {{"air", "-", -2.0, 4.0}, {"other", "-", -1.0, 1.0}};
  info.disturbances = {{"c", "g/m3", 0.0, 100.0}, {"q", "m3/d", 0.0, 1e6}};
  return info;
}

LoadSupervisorParams params() {
  LoadSupervisorParams p;
  p.flow = 1;
  p.nominal_load = 200.0;
  p.kp = 2.0;
  p.load_gain = 3.0;
  p.ki_per_h = 0.5;
  p.tracking_time_h = 2.0;
  p.integral_limit = 0.6;
  return p;
}

InputLimits limits() {
  return {Eigen::Vector2d(-2.0, -1.0), Eigen::Vector2d(4.0, 1.0), Vector::Constant(2, kInfinity)};
}

Measurement sample(std::uint32_t step, double y, double c, double q, double air) {
  Measurement m;
  m.header.step = step;
  m.outputs = Vector::Constant(1, y);
  m.disturbances = Eigen::Vector2d(c, q);
  m.input_applied = Eigen::Vector2d(air, 0.5);
  return m;
}

class Supervisor : public ::testing::Test {
 protected:
  LoadSupervisor law{params(), limits(), plant()};
  SetpointSource setpoint = [] {
    SetpointParams p;
    p.initial = Vector::Constant(1, 1.0);
    p.lower = Vector::Constant(1, -kInfinity);
    p.upper = p.rate_per_h = Vector::Constant(1, kInfinity);
    return SetpointSource(p, {"S"}, SampleClock(1800.0, 1.0));
  }();
  ControllerOutput output;
  double send(const Measurement& m) {
    setpoint.advance(m.header.step);
    law.step(m, setpoint, output);
    return output.input[0];
  }
};

TEST_F(Supervisor, ErrorIntegralAndLoadAddUpAsOnPaper) {
  law.reset(sample(0, 1.5, 20.0, 10.0, 0.0));
  EXPECT_NEAR(send(sample(0, 1.5, 20.0, 10.0, 0.0)), 2.0 * 0.5, 1e-14);
  // dt ki e = 0.5 * 0.5 * 0.5
  EXPECT_NEAR(send(sample(1, 1.5, 30.0, 10.0, 1.0)), 1.0 + 0.125 + 3.0 * 0.5, 1e-14);
  EXPECT_EQ(output.input[1], 0.5) << "not its input";
  EXPECT_EQ(output.source, ActionSource::kBase);
}

TEST_F(Supervisor, AtABoundTheIntegralIsPulledBack) {
  law.reset(sample(0, 5.0, 20.0, 10.0, 0.0));
  EXPECT_EQ(send(sample(0, 5.0, 20.0, 10.0, 0.0)), 4.0);
  EXPECT_EQ(output.source, ActionSource::kClipped);
  // unclipped 8, sent 4: dI = 0.5 (8/4 + (4-8)/2) = 0
  EXPECT_NEAR(law.signals()[0].second, 0.0, 1e-14);
}

TEST_F(Supervisor, TheIntegralStaysWithinItsLimit) {
  law.reset(sample(0, 2.0, 20.0, 10.0, 0.0));
  for (std::uint32_t k = 0; k < 100; ++k) send(sample(k, 2.0, 20.0, 10.0, 0.0));
  EXPECT_NEAR(law.signals()[0].second, 0.6, 1e-14);
}

TEST_F(Supervisor, AStartInTheMiddleOfARunMovesNothing) {
  law.reset(sample(7, 1.1, 20.0, 10.0, 0.7));
  EXPECT_EQ(send(sample(7, 1.1, 20.0, 10.0, 0.7)), 0.7);
}

TEST_F(Supervisor, BadParamsAreErrorsThatNameTheField) {
  const auto throws = [](auto spoil) {
    LoadSupervisorParams p = params();
    spoil(p);
    EXPECT_THROW(p.validate(), InputError);
  };
  throws([](auto& p) { p.kp = std::nan(""); });
  throws([](auto& p) { p.nominal_load = 0.0; });
  throws([](auto& p) { p.ki_per_h = 0.0; });
  throws([](auto& p) { p.tracking_time_h = -1.0; });
  throws([](auto& p) { p.integral_limit = -1.0; });
}

}  // namespace control_supervisor_load_supervisor_test
}  // namespace fpc
