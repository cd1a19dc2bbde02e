// What a PI may take besides its error, on numbers known on paper.
#include "control/pi/pi_terms.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "control/pi/pi.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace control_pi_pi_terms_test {

constexpr double kSampleTime = 720.0;  // 0.2 h

SetpointSource source() {
  SetpointParams p;
  p.initial = Vector::Constant(1, 10.0);
  p.schedule = {{1.0, Vector::Constant(1, 20.0), 0.0}};  // from sample 5
  p.lower = Vector::Constant(1, -1e9);
  p.upper = Vector::Constant(1, 1e9);
  p.rate_per_h = Vector::Constant(1, 1e9);
  return {p, {"y"}, SampleClock(kSampleTime, 1.0)};
}

Measurement at(std::uint32_t step, double y, double d, double u = 0.0) {
  return {{1000000000 + step * 720000000000, 1, step},
          Vector::Constant(1, y),
          Vector::Constant(1, d),
          Vector::Constant(1, u),
          false};
}

/// aim and sum of samples 0..n-1 with y(k), d(k).
template <typename Y, typename D>
std::vector<std::pair<double, double>> play(const PiTerms& terms, int n, Y y, D d) {
  SetpointSource setpoint = source();
  PiTermState state(terms, 0, 1, kSampleTime);
  state.reset();
  std::vector<std::pair<double, double>> out;
  for (int k = 0; k < n; ++k) {
    setpoint.advance(static_cast<std::uint32_t>(k));
    const Measurement now = at(static_cast<std::uint32_t>(k), y(k), d(k));
    const double aim = state.aim(now, setpoint);
    out.emplace_back(aim, state.sum(now, 1.0));
  }
  return out;
}

double zero(int) { return 0.0; }

TEST(PiTerms, PreviewLooksAheadInTheSchedule) {
  PiTerms terms;
  terms.preview_h = 0.4;  // two samples
  const auto out = play(terms, 6, zero, zero);
  EXPECT_EQ(out[2].first, 10.0);
  EXPECT_EQ(out[3].first, 20.0);
}

TEST(PiTerms, PathStartsAtTheOutputAndLeadAddsItsSlope) {
  PiTerms terms;
  terms.setpoint_pole = 0.5;
  terms.setpoint_lead_h = 0.1;
  const auto out = play(
      terms, 3, [](int) { return 6.0; }, zero);
  // r: 6, 8, 9; slopes (2, 1, 0.5) per 0.2 h times 0.1 h.
  EXPECT_DOUBLE_EQ(out[0].first, 6.0 + 1.0);
  EXPECT_DOUBLE_EQ(out[1].first, 8.0 + 0.5);
  EXPECT_DOUBLE_EQ(out[2].first, 9.0 + 0.25);
}

TEST(PiTerms, StaticInputIsThatOfThePath) {
  PiTerms terms;
  terms.static_input = {{10.0, 100.0}, {20.0, 300.0}};
  const auto out = play(terms, 6, zero, zero);
  EXPECT_EQ(out[0].second, 100.0);
  EXPECT_EQ(out[5].second, 300.0);
  EXPECT_EQ(valueOf(terms.static_input, 15.0, 0.0), 200.0);
  EXPECT_EQ(valueOf(terms.static_input, 5.0, 0.0), 100.0);
  EXPECT_EQ(valueOf(terms.static_input, 25.0, 0.0), 300.0);
}

TEST(PiTerms, DerivativeOfARampIsItsSlopeAfterTheLag) {
  PiTerms terms;
  terms.kd_h = 2.0;
  terms.derivative_lag_h = 0.3;
  const auto out = play(
      terms, 60, [](int k) { return 5.0 * 0.2 * k; }, zero);
  EXPECT_EQ(out[0].second, 0.0);
  EXPECT_NEAR(out[1].second, -2.0 * 5.0 * 0.2 / 0.5, 1e-12);  // dt / (lag + dt)
  EXPECT_NEAR(out[59].second, -2.0 * 5.0, 1e-9);
}

TEST(PiTerms, FeedforwardIsGainTimesDeviationBehindItsLag) {
  PiTerms terms;
  terms.feedforward = {{0, 3.0, 1.0, 0.0}};
  EXPECT_EQ(play(terms, 1, zero, [](int) { return 5.0; })[0].second, 12.0);
  terms.feedforward = {{0, 3.0, 1.0, 1.0}};
  const auto lag = play(terms, 6, zero, [](int k) { return k == 0 ? 1.0 : 2.0; });
  EXPECT_NEAR(lag[5].second, 3.0 * (1.0 - std::exp(-1.0)), 1e-12);  // 5 samples of 0.2 h
}

/// A load: 3 (c q - 200), of what is 4 and 60 now.
TEST(PiTerms, AProductIsFedForward) {
  PiFeedforward load{0, 3.0, 200.0, 0.0};
  load.times = 1;
  PiTerms terms;
  terms.feedforward = {load};
  PiTermState state(terms, 0, 1, kSampleTime);
  state.reset();
  SetpointSource setpoint = source();
  setpoint.advance(0);
  Measurement now = at(0, 0.0, 4.0);
  now.disturbances = Eigen::Vector2d(4.0, 60.0);
  state.aim(now, setpoint);
  EXPECT_DOUBLE_EQ(state.sum(now, 1.0), 3.0 * 40.0);
}

/// Unclipped 8, sent 4: dI = dt (ki e + (4 - 8) / Tt).
TEST(PiTerms, TheClippedPartComesBackWithTheTrackingTime) {
  PlantInfo info;
  info.sample_time_s = 1800.0;
  info.outputs = {{"y", "", 0, 100}};
  info.inputs = {{"u", "", -2, 4}};
  PiLoop loop;
  loop.kp = 2.0;
  loop.ki_per_h = 0.5;
  loop.reverse = true;
  loop.anti_windup = AntiWindup::kTracking;
  for (const auto& [time_h, integral] :
       {std::pair{2.0, 0.0}, {8.0, 0.75}, {0.0, 0.5}, {0.1, -3.0}}) {
    loop.tracking_time_h = time_h;
    PiController law(
        {{loop}, {}},
        {Vector::Constant(1, -2.0), Vector::Constant(1, 4.0), Vector::Constant(1, kInfinity)},
        info);
    SetpointSource setpoint = source();
    setpoint.advance(0);
    const Measurement now = at(0, 14.0, 0.0);
    law.reset(now);
    ControllerOutput output;
    law.step(now, setpoint, output);
    EXPECT_EQ(output.input[0], 4.0);
    EXPECT_NEAR(law.signals()[0].second, integral, 1e-14) << time_h;
  }
}

PlantInfo plant() {
  PlantInfo info;
  info.header.time_ns = 1000000000;
  info.sample_time_s = kSampleTime;
  info.outputs = {{"y", "", 0, 1000}};
  info.inputs = {{"u", "", 0, 1000}};
  info.disturbances = {{"d", "", 0, 1000}};
  return info;
}

TEST(PiTerms, GainsAreScheduledByTheOutput) {
  PiLoop loop;
  loop.kp = 1.0;
  loop.gain_schedule = {{0.0, 1.0}, {10.0, 3.0}};
  const InputLimits limits{Vector::Constant(1, -1e9), Vector::Constant(1, 1e9),
                           Vector::Constant(1, 1e9)};
  PiController pi({{loop}, {}}, limits, plant());
  SetpointSource setpoint = source();
  setpoint.advance(0);
  ControllerOutput out;
  pi.reset(at(0, 4.0, 5.0));
  pi.step(at(0, 4.0, 5.0), setpoint, out);
  EXPECT_NEAR(out.input[0], 1.8 * 6.0, 1e-12);  // g(4) = 1.8
}

TEST(PiTerms, MistakesNameTheirKey) {
  const auto errorWith = [](const std::function<void(PiLoop&)>& change) -> std::string {
    PiLoop loop;
    change(loop);
    try {
      PiParams{{loop}, {}}.validate(1, 1, 1);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  const auto names = [](const std::string& error, const std::string& key) {
    EXPECT_NE(error.find(key), std::string::npos) << error;
  };
  names(errorWith([](PiLoop& l) {
          l.terms.feedforward = {{1, 1.0, 0.0, 0.0}};
        }),
        "feedforward[0].disturbance");
  names(errorWith([](PiLoop& l) {
          l.terms.feedforward = {{0, 1.0, 0.0, 0.0}};
          l.terms.feedforward[0].times = 1;
        }),
        "feedforward[0].times");
  names(errorWith([](PiLoop& l) { l.tracking_time_h = -1.0; }), "tracking_time_h");
  names(errorWith([](PiLoop& l) { l.terms.feedforward = {{0, 1.0, 0.0, -1.0}}; }), "lag_h");
  names(errorWith([](PiLoop& l) { l.terms.preview_h = -1.0; }), "preview_h");
  names(errorWith([](PiLoop& l) { l.terms.setpoint_pole = 1.0; }), "setpoint_pole");
  names(errorWith([](PiLoop& l) {
          l.terms.static_input = {{2.0, 1.0}, {1.0, 1.0}};
        }),
        "static_input");
}

}  // namespace control_pi_pi_terms_test
}  // namespace fpc
