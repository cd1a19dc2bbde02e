#include "control/pi/pi.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace control_pi_pi_test {

constexpr double kSampleTime = 720.0;  // 0.2 h

Vector of(std::initializer_list<double> values) {
  Vector v(static_cast<Eigen::Index>(values.size()));
  Eigen::Index i = 0;
  for (const double value : values) v[i++] = value;
  return v;
}

PlantInfo plant(std::size_t n_u) {
  PlantInfo info;
  info.header.time_ns = 1000000000;
  info.sample_time_s = kSampleTime;
  info.outputs = {{"s", "mg/l", 0, 1000}, {"x", "mg/l", 0, 5000}};
  for (std::size_t i = 0; i < n_u; ++i)
    info.inputs.push_back({"u" + std::to_string(i), "m3/h", 0, 3000});
  return info;
}

InputLimits limits(std::size_t n_u, double lower, double upper, double move = kInfinity) {
  const auto n = static_cast<Eigen::Index>(n_u);
  return {Vector::Constant(n, lower), Vector::Constant(n, upper), Vector::Constant(n, move)};
}

// The paper's PI on the substrate: u = 775 + 1 (s - 55) + 0.1 int (s - 55) dt.
PiLoop paperLoop() {
  PiLoop loop;
  loop.input = 0;
  loop.output = 0;
  loop.kp = 1.0;
  loop.ki_per_h = 0.1;
  loop.bias = 775.0;
  loop.reverse = true;
  return loop;
}

// A PI with its setpoints (s 55, x 2000), stepped by hand.
class Bench {
 public:
  Bench(std::vector<PiLoop> loops, const InputLimits& input_limits, std::size_t n_u = 1)
      : pi_({std::move(loops)}, input_limits, plant(n_u)),
        setpoint_(setpoints(), {"s", "x"}, SampleClock(kSampleTime, 1.0)) {}

  static SetpointParams setpoints() {
    SetpointParams p;
    p.initial = of({55.0, 2000.0});
    return p;
  }
  void reset(std::uint32_t step, double s, const Vector& applied) {
    pi_.reset(at(step, s, applied));
  }
  Vector step(std::uint32_t step, double s, const Vector& applied) {
    setpoint_.advance(step);
    pi_.step(at(step, s, applied), setpoint_, out);
    return out.input;
  }
  Measurement at(std::uint32_t step, double s, const Vector& applied) const {
    return {{1000000000 + step * 720000000000, 1, step}, of({s, 1990.0}), Vector(), applied, false};
  }
  double integral(std::size_t i = 0) const { return pi_.signals()[i].second; }

  ControllerOutput out;

 private:
  PiController pi_;
  SetpointSource setpoint_;
};

TEST(PiController, FollowsThePapersFormulaByForwardEuler) {
  Bench bench({paperLoop()}, limits(1, -1e9, 1e9));
  const std::vector<double> s{200.0, 150.0, 90.0, 40.0, 55.0};
  bench.reset(0, s[0], of({775.0}));
  Vector applied = of({775.0});
  double integral = 0.0;
  for (std::uint32_t k = 0; k < s.size(); ++k) {
    applied = bench.step(k, s[k], applied);
    EXPECT_NEAR(applied[0], 775.0 + (s[k] - 55.0) + 0.1 * integral, 1e-9) << "sample " << k;
    EXPECT_EQ(bench.out.source, ActionSource::kBase);
    integral += (s[k] - 55.0) * 0.2;
  }
  EXPECT_NEAR(bench.integral(), 0.1 * integral, 1e-9);
  EXPECT_EQ(bench.out.reference, of({55.0, 2000.0}));
  EXPECT_FALSE(bench.out.predictive);
}

TEST(PiController, DirectLoopUsesSetpointMinusOutput) {
  PiLoop loop = paperLoop();
  loop.output = 1;
  loop.reverse = false;
  Bench bench({loop}, limits(1, 0.0, 3000.0));
  bench.reset(0, 55.0, of({775.0}));
  EXPECT_DOUBLE_EQ(bench.step(0, 55.0, of({775.0}))[0], 775.0 + 10.0);  // x_ref - x = 10
}

TEST(PiController, StartBiasBeginsAtTheBiasWhateverTheInputIs) {
  Bench bench({paperLoop()}, limits(1, 0.0, 3000.0));
  bench.reset(0, 55.0, of({100.0}));
  EXPECT_EQ(bench.step(0, 55.0, of({100.0}))[0], 775.0);
}

TEST(PiController, BumplessStartMovesOnFromTheAppliedInput) {
  PiLoop loop = paperLoop();
  loop.start = PiStart::kBumpless;
  Bench bench({loop}, limits(1, 0.0, 3000.0));
  bench.reset(0, 200.0, of({100.0}));
  EXPECT_EQ(bench.step(0, 200.0, of({100.0}))[0], 100.0);
  EXPECT_NEAR(bench.step(1, 200.0, of({100.0}))[0], 100.0 + 0.1 * 145.0 * 0.2, 1e-9);
}

TEST(PiController, LaterResetIsBumplessAlsoWithStartBias) {
  Bench bench({paperLoop()}, limits(1, 0.0, 3000.0));
  bench.reset(0, 55.0, of({775.0}));
  bench.step(0, 55.0, of({775.0}));
  bench.reset(7, 120.0, of({333.3}));
  EXPECT_EQ(bench.step(7, 120.0, of({333.3}))[0], 333.3);
  EXPECT_NEAR(bench.step(8, 120.0, of({333.3}))[0], 333.3 + 0.1 * 65.0 * 0.2, 1e-9);
}

TEST(PiController, WithoutIntegralTheTransferDecaysToTheLaw) {
  PiLoop loop = paperLoop();
  loop.ki_per_h = 0.0;
  Bench bench({loop}, limits(1, 0.0, 3000.0));
  bench.reset(5, 155.0, of({1875.0}));  // the law asks 875
  Vector applied = of({1875.0});
  for (std::uint32_t k = 0; k < 200; ++k) {
    applied = bench.step(5 + k, 155.0, applied);
    EXPECT_NEAR(applied[0], 875.0 + 1000.0 * std::pow(0.9, k), 1e-8);
  }
}

TEST(PiController, StaysInsideBoundsAndMoveLimitAndSaysClipped) {
  Bench bench({paperLoop()}, limits(1, 500.0, 800.0, 10.0));
  bench.reset(0, 400.0, of({775.0}));
  EXPECT_EQ(bench.step(0, 400.0, of({775.0}))[0], 785.0);
  EXPECT_EQ(bench.out.source, ActionSource::kClipped);
  EXPECT_EQ(bench.step(1, 400.0, of({785.0}))[0], 795.0);
  EXPECT_EQ(bench.step(2, 400.0, of({795.0}))[0], 800.0);
  EXPECT_EQ(bench.step(3, -1e4, of({800.0}))[0], 790.0);
}

// s = 155 asks 875 and more, the bound is 800; then s = 45 asks 765 + integral.
double afterSaturation(AntiWindup anti_windup, double kp = 1.0) {
  PiLoop loop = paperLoop();
  loop.kp = kp;
  loop.anti_windup = anti_windup;
  Bench bench({loop}, limits(1, 0.0, 800.0));
  bench.reset(0, 155.0, of({775.0}));
  for (std::uint32_t k = 0; k < 1000; ++k) bench.step(k, 155.0, of({800.0}));
  return bench.integral();
}

TEST(PiController, AntiWindupNoneWindsUp) {
  EXPECT_NEAR(afterSaturation(AntiWindup::kNone), 1000 * 0.1 * 100.0 * 0.2, 1e-8);
}

TEST(PiController, AntiWindupClampStopsTheIntegralAtTheBound) {
  EXPECT_EQ(afterSaturation(AntiWindup::kClamp), 0.0);
}

TEST(PiController, AntiWindupClampLetsTheErrorDriveBackIn) {
  Bench bench({paperLoop()}, limits(1, 0.0, 800.0));
  bench.reset(3, 25.0, of({1000.0}));  // transferred from beyond the bound, error inwards
  EXPECT_EQ(bench.step(3, 25.0, of({1000.0}))[0], 800.0);
  const double start = 1000.0 - 745.0;
  EXPECT_NEAR(bench.integral(), start - 0.1 * 30.0 * 0.2, 1e-9);
}

TEST(PiController, AntiWindupClampKnowsTheMoveLimit) {
  Bench bench({paperLoop()}, limits(1, 0.0, 3000.0, 5.0));
  bench.reset(0, 155.0, of({775.0}));
  for (std::uint32_t k = 0; k < 3; ++k) bench.step(k, 155.0, of({775.0}));
  EXPECT_EQ(bench.integral(), 0.0);
  bench.step(3, 58.0, of({775.0}));  // asks 778: inside
  EXPECT_NEAR(bench.integral(), 0.1 * 3.0 * 0.2, 1e-12);
}

// At rest ki e dt = (u - 800) dt ki / kp: u stays above the bound by kp e = 100, the integral
// at 25.
TEST(PiController, AntiWindupTrackingSettlesWhereTheClippedPartBalancesTheError) {
  EXPECT_NEAR(afterSaturation(AntiWindup::kTracking), 800.0 + 100.0 - 875.0, 1e-5);
  EXPECT_NEAR(afterSaturation(AntiWindup::kTracking, 0.0), 800.0 - 775.0 + 0.1 * 100.0 * 0.2, 1e-9);
}

TEST(PiController, InputsWithoutALoopStayWhereTheyAre) {
  PiLoop second = paperLoop();
  second.input = 2;
  Bench bench({second}, limits(3, 0.0, 3000.0), 3);
  bench.reset(0, 55.0, of({10.0, 20.0, 30.0}));
  EXPECT_EQ(bench.step(0, 56.0, of({10.0, 20.0, 30.0})), of({10.0, 20.0, 776.0}));
}

TEST(PiController, SeveralLoopsMoveTheirOwnInputs) {
  PiLoop first = paperLoop(), second = paperLoop();
  second.input = 1;
  second.output = 1;
  second.reverse = false;
  second.bias = 100.0;
  Bench bench({first, second}, limits(2, 0.0, 3000.0), 2);
  bench.reset(0, 56.0, of({0.0, 0.0}));
  EXPECT_EQ(bench.step(0, 56.0, of({0.0, 0.0})), of({776.0, 110.0}));
  EXPECT_NEAR(bench.integral(0), 0.1 * 1.0 * 0.2, 1e-12);
  EXPECT_NEAR(bench.integral(1), 0.1 * 10.0 * 0.2, 1e-12);
}

TEST(PiController, OverflowHoldsTheInputAndRecovers) {
  PiLoop loop = paperLoop();
  loop.kp = 1e10;
  Bench bench({loop}, limits(1, 0.0, 3000.0));
  bench.reset(4, 1e305, of({700.0}));
  EXPECT_EQ(bench.step(4, 1e305, of({700.0}))[0], 700.0);
  EXPECT_FALSE(bench.out.ok);
  EXPECT_EQ(bench.out.source, ActionSource::kHeld);
  EXPECT_TRUE(bench.out.events.has(EventCode::kLawFailed));
  bench.reset(5, 55.0, of({700.0}));
  EXPECT_EQ(bench.step(5, 55.0, of({700.0}))[0], 700.0);
  EXPECT_TRUE(bench.out.ok);
}

std::string messageOf(const PiParams& params) {
  try {
    params.validate(2, 1);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(PiParams, ValidationNamesTheField) {
  EXPECT_EQ(messageOf({{paperLoop()}}), "");
  EXPECT_NE(messageOf({}).find("controller.loops"), std::string::npos);
  const auto expectNamed = [](const char* field, auto change) {
    PiLoop loop = paperLoop();
    change(loop);
    EXPECT_NE(messageOf({{loop}}).find(std::string("controller.loops[0].") + field),
              std::string::npos)
        << field;
  };
  expectNamed("input", [](PiLoop& l) { l.input = 1; });
  expectNamed("input", [](PiLoop& l) { l.input = -1; });
  expectNamed("output", [](PiLoop& l) { l.output = 2; });
  expectNamed("kp", [](PiLoop& l) { l.kp = kNaN; });
  expectNamed("ki_per_h", [](PiLoop& l) { l.ki_per_h = kInfinity; });
  expectNamed("bias", [](PiLoop& l) { l.bias = kNaN; });
}

TEST(PiParams, TwoLoopsOnOneInputAreRefused) {
  PiLoop second = paperLoop();
  second.output = 1;
  EXPECT_NE(messageOf({{paperLoop(), second}}).find("controller.loops[1].input"),
            std::string::npos);
}

}  // namespace control_pi_pi_test
}  // namespace fpc
