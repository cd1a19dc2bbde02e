// Structs survive the way through a message bit for bit; what no struct can mean is refused. No
// master needed.
#include "ros/conversions.hpp"

#include <gtest/gtest.h>
#include <cmath>
#include <random>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "same_bits.hpp"

namespace fpc {
namespace ros_conversions_test {

/// Random numbers with everything that is awkward in between.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : random_(seed) {}
  double next() {
    const double awkward[] = {kNaN, kInfinity, -kInfinity, -0.0, 5e-324, 1.0 / 3.0};
    const std::uint64_t draw = random_();
    if (draw % 4 == 0) return awkward[(draw / 4) % 6];
    return std::ldexp(static_cast<double>(random_()), static_cast<int>(draw % 200) - 160);
  }
  Vector vector(Eigen::Index n) {
    return Vector::NullaryExpr(n, [&] { return next(); });
  }
  Matrix matrix(Eigen::Index rows, Eigen::Index cols) {
    return Matrix::NullaryExpr(rows, cols, [&] { return next(); });
  }

 private:
  std::mt19937_64 random_;
};

class Conversions : public ::testing::TestWithParam<std::uint64_t> {
 protected:
  Numbers numbers{GetParam()};
};

TEST_P(Conversions, MeasurementSurvives) {
  const Measurement m{kHeader, numbers.vector(2), numbers.vector(3), numbers.vector(1), true};
  const Measurement r = fromMsg(sent(toMsg(m)));
  EXPECT_TRUE(sameHeader(m.header, r.header));
  EXPECT_TRUE(sameNumbers(m.outputs, r.outputs));
  EXPECT_TRUE(sameNumbers(m.disturbances, r.disturbances));
  EXPECT_TRUE(sameNumbers(m.input_applied, r.input_applied));
  EXPECT_TRUE(r.final);
}

TEST(MeasurementQuality, WhatIsNotGoodIsNoNumber) {
  fmbpc::Measurement msg;
  msg.outputs = {1.0, 2.0};
  msg.disturbances = {3.0};
  EXPECT_TRUE(fromMsg(msg).outputs.allFinite());  // nothing is said: all good
  msg.quality = {fmbpc::Measurement::GOOD, fmbpc::Measurement::STALE, fmbpc::Measurement::BAD};
  const Measurement m = fromMsg(msg);
  EXPECT_EQ(m.outputs[0], 1.0);
  EXPECT_TRUE(std::isnan(m.outputs[1]));
  EXPECT_TRUE(std::isnan(m.disturbances[0]));
  msg.quality.pop_back();
  EXPECT_THROW(fromMsg(msg), InputError);
}

TEST_P(Conversions, ControlActionSurvivesWithEachSource) {
  for (int source = 1; source <= 6; ++source) {
    const ControlAction a{kHeader, numbers.vector(2), static_cast<ActionSource>(source)};
    const ControlAction r = fromMsg(sent(toMsg(a)));
    EXPECT_TRUE(sameHeader(a.header, r.header));
    EXPECT_TRUE(sameNumbers(a.input, r.input));
    EXPECT_EQ(a.source, r.source);
  }
}

TEST_P(Conversions, PredictiveActionSurvives) {
  PredictiveAction a;
  a.header = kHeader;
  a.state = numbers.vector(4);
  a.A = numbers.matrix(4, 4);
  a.B = numbers.matrix(4, 2);
  a.C = numbers.matrix(3, 4);
  a.offset_state = numbers.vector(4);
  a.offset_output = numbers.vector(3);
  a.K = numbers.matrix(2, 4);
  a.feedforward = numbers.matrix(2, 5);
  a.reference = numbers.matrix(3, 5);
  a.setpoint = numbers.vector(3);
  a.input_base_unclipped = numbers.vector(2);
  a.input_previous = numbers.vector(2);
  a.input_lower = numbers.vector(2);
  a.input_upper = numbers.vector(2);
  const PredictiveAction r = fromMsg(sent(toMsg(a)));
  EXPECT_TRUE(sameHeader(a.header, r.header));
  EXPECT_TRUE(sameNumbers(a.state, r.state));
  EXPECT_TRUE(sameMatrix(a.A, r.A));
  EXPECT_TRUE(sameMatrix(a.B, r.B));
  EXPECT_TRUE(sameMatrix(a.C, r.C));
  EXPECT_TRUE(sameNumbers(a.offset_state, r.offset_state));
  EXPECT_TRUE(sameNumbers(a.offset_output, r.offset_output));
  EXPECT_TRUE(sameMatrix(a.K, r.K));
  EXPECT_TRUE(sameMatrix(a.feedforward, r.feedforward));
  EXPECT_TRUE(sameMatrix(a.reference, r.reference));
  EXPECT_TRUE(sameNumbers(a.setpoint, r.setpoint));
  EXPECT_TRUE(sameNumbers(a.input_base_unclipped, r.input_base_unclipped));
  EXPECT_TRUE(sameNumbers(a.input_previous, r.input_previous));
  EXPECT_TRUE(sameNumbers(a.input_lower, r.input_lower));
  EXPECT_TRUE(sameNumbers(a.input_upper, r.input_upper));
}

TEST_P(Conversions, SolverReportSurvivesWithEachStatus) {
  for (int status = 1; status <= 8; ++status) {
    const SolverReport s{kHeader, numbers.vector(2), static_cast<SolveStatus>(status),
                         77,      numbers.next(),    numbers.next(),
                         5};
    const SolverReport r = fromMsg(sent(toMsg(s)));
    EXPECT_TRUE(sameHeader(s.header, r.header));
    EXPECT_TRUE(sameNumbers(s.perturbation, r.perturbation));
    EXPECT_EQ(s.status, r.status);
    EXPECT_EQ(77u, r.iterations);
    EXPECT_TRUE(sameBits(s.kkt_residual, r.kkt_residual));
    EXPECT_TRUE(sameBits(s.seconds, r.seconds));
    EXPECT_EQ(5u, r.active_rows);
  }
}

TEST_P(Conversions, TrackingAndPlantStateSurvive) {
  const Tracking t{kHeader, numbers.vector(2), numbers.vector(2)};
  const Tracking rt = fromMsg(sent(toMsg(t)));
  EXPECT_TRUE(sameHeader(t.header, rt.header));
  EXPECT_TRUE(sameNumbers(t.setpoint, rt.setpoint));
  EXPECT_TRUE(sameNumbers(t.reference, rt.reference));
  const PlantState p{kHeader, numbers.vector(6), numbers.vector(2), numbers.vector(3), 2, true,
                     "stuck"};
  const PlantState rp = fromMsg(sent(toMsg(p)));
  EXPECT_TRUE(sameHeader(p.header, rp.header));
  EXPECT_TRUE(sameNumbers(p.state, rp.state));
  EXPECT_TRUE(sameNumbers(p.outputs, rp.outputs));
  EXPECT_TRUE(sameNumbers(p.disturbances, rp.disturbances));
  EXPECT_EQ(2u, rp.actuator_clips);
  EXPECT_TRUE(rp.input_missing);
}

TEST_P(Conversions, PlantInfoSurvives) {
  PlantInfo info{kHeader, "tank", "tank_frame", numbers.next(), {}, {}, {}, {"analyzer", ""}};
  info.outputs = {{"h", "m", numbers.next(), numbers.next()}, {"T", "K", -kInfinity, kInfinity}};
  info.inputs = {{"q", "m3/h", 0.0, numbers.next()}};
  const PlantInfo r = fromMsg(sent(toMsg(info)));
  EXPECT_TRUE(sameHeader(info.header, r.header));
  EXPECT_EQ(info.name, r.name);
  EXPECT_EQ(info.frame_id, r.frame_id);
  EXPECT_TRUE(sameBits(info.sample_time_s, r.sample_time_s));
  EXPECT_TRUE(sameSignals(info.outputs, r.outputs));
  EXPECT_TRUE(sameSignals(info.inputs, r.inputs));
  EXPECT_TRUE(sameSignals(info.disturbances, r.disturbances));
  EXPECT_EQ(info.output_frames, r.output_frames);
}

TEST_P(Conversions, CommandsAndEffectsSurviveWithEachMode) {
  for (int mode = 1; mode <= 3; ++mode) {
    const Command c{
        1500000000, {"x", "s"}, {numbers.next(), numbers.next()}, static_cast<CommandMode>(mode)};
    const CommandEffect effect = fromMsg(sent(toMsg(CommandEffect{kHeader, c})));
    EXPECT_TRUE(sameHeader(kHeader, effect.header));
    for (const Command& r :
         {fromMsg(sent(toSetpointMsg(c))), fromMsg(sent(toDisturbanceMsg(c))), effect.command}) {
      EXPECT_EQ(c.time_ns, r.time_ns);
      EXPECT_EQ(c.name, r.name);
      EXPECT_TRUE(sameNumbers(c.value, r.value));
      EXPECT_EQ(c.mode, r.mode);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Conversions, ::testing::Range(std::uint64_t{1}, std::uint64_t{6}));

TEST(PlainConversions, EmptyArraysStayEmpty) {
  const Measurement r = fromMsg(sent(toMsg(Measurement{})));
  EXPECT_EQ(0, r.outputs.size());
  EXPECT_FALSE(r.final);
  const Matrix wide = fromMsg(sent(toMsg(Matrix(0, 3))));
  EXPECT_EQ(0, wide.rows());
  EXPECT_EQ(3, wide.cols());
}

TEST(PlainConversions, MatricesTravelRowByRow) {
  Matrix m(2, 3);
  m << 1, 2, 3, 4, 5, 6;
  EXPECT_EQ((std::vector<double>{1, 2, 3, 4, 5, 6}), toMsg(m).data);
}

TEST(PlainConversions, MatrixWithMissingDataIsRefused) {
  fmbpc::PredictiveAction msg;
  msg.A.rows = msg.A.cols = 2;
  msg.A.data = {1.0, 2.0, 3.0};
  EXPECT_THROW(fromMsg(msg), InputError);
  msg.A.rows = msg.A.cols = 65536;  // their product overflows 32 bits to 0
  msg.A.data.clear();
  EXPECT_THROW(fromMsg(msg), InputError);
}

TEST(PlainConversions, AnEmptyMatrixOfBillionsOfColumnsIsRefusedAtOnce) {
  fmbpc::PredictiveAction msg;
  msg.B.cols = 4294967295;
  EXPECT_THROW(fromMsg(msg), InputError);
  msg.B.rows = std::exchange(msg.B.cols, 0);
  EXPECT_THROW(fromMsg(msg), InputError);
}

TEST(PlainConversions, UnknownEnumerationsAreRefused) {
  for (const std::uint8_t value : {0, 8, 255}) {
    fmbpc::ControlAction action;
    action.source = value;
    EXPECT_THROW(fromMsg(action), InputError) << int{value};
  }
  for (const std::uint8_t value : {0, 9}) {
    fmbpc::SolverReport report;
    report.status = value;
    EXPECT_THROW(fromMsg(report), InputError) << int{value};
  }
  for (const std::uint8_t value : {0, 4}) {
    fmbpc::Setpoint setpoint;
    setpoint.name = {"x"};
    setpoint.value = {1.0};
    setpoint.mode = value;
    EXPECT_THROW(fromMsg(setpoint), InputError) << int{value};
  }
}

TEST(PlainConversions, ListsOfDifferentLengthAreRefused) {
  fmbpc::Disturbance disturbance;
  disturbance.name = {"q_i", "s_i"};
  disturbance.value = {1.0};
  disturbance.mode = fmbpc::Disturbance::OVERRIDE;
  EXPECT_THROW(fromMsg(disturbance), InputError);
  fmbpc::PlantInfo info;
  info.outputs.resize(2);
  info.output_frames.resize(1);
  EXPECT_THROW(fromMsg(info), InputError);
}

TEST(PlainConversions, ReleaseNeedsNoValues) {
  fmbpc::Setpoint setpoint;
  setpoint.name = {"x", "s"};
  setpoint.mode = fmbpc::Setpoint::RELEASE;
  EXPECT_EQ(CommandMode::kRelease, fromMsg(setpoint).mode);
}

TEST(PlainConversions, StampsCoverTheRangeOfRosTimeOnly) {
  const std::int64_t last = (std::int64_t{1} << 32) * 1000000000 - 1;
  EXPECT_EQ(last, fromStamp(toStamp(last)));
  EXPECT_EQ(0, fromStamp(toStamp(0)));
  EXPECT_THROW(toStamp(last + 1), InputError);
  EXPECT_THROW(toStamp(-1), InputError);
}

}  // namespace ros_conversions_test
}  // namespace fpc
