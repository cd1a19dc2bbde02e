// Structs survive the way through a message bit for bit; what no struct can mean is refused. No master needed.
#include "fmbpc/ros/conversions.hpp"

#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const StepHeader kHeader{1234500000001, 18000000000000000001u, 4294967295u};

bool sameBits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

template <typename List>
bool sameNumbers(const List& a, const List& b) {
  if (a.size() != b.size()) return false;
  for (decltype(a.size()) i = 0; i < a.size(); ++i)
    if (!sameBits(a.data()[i], b.data()[i])) return false;
  return true;
}

bool sameMatrix(const Matrix& a, const Matrix& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && sameNumbers(a, b);
}

bool sameHeader(const StepHeader& a, const StepHeader& b) {
  return a.time_ns == b.time_ns && a.run_id == b.run_id && a.step == b.step;
}

bool sameSignals(const std::vector<SignalInfo>& a, const std::vector<SignalInfo>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& p, const auto& q) {
    return p.name == q.name && p.unit == q.unit && sameBits(p.lower, q.lower) &&
           sameBits(p.upper, q.upper);
  });
}

/// Over the wire, not only through the C++ object.
template <typename Msg>
Msg sent(const Msg& msg) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(msg));
  ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(out, msg);
  Msg received;
  ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(in, received);
  return received;
}

/// Random numbers with everything that is awkward in between.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : random_(seed) {}
  double next() {
    const double awkward[] = {kNan, kInf, -kInf, -0.0, 5e-324, 1.0 / 3.0};
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
}

TEST_P(Conversions, SolverReportSurvivesWithEachStatus) {
  for (int status = 1; status <= 8; ++status) {
    const SolverReport s{kHeader,        numbers.vector(2), static_cast<SolveStatus>(status), 77,
                         numbers.next(), numbers.next(),    5};
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
  const PlantState p{kHeader, numbers.vector(6), numbers.vector(2), numbers.vector(3), 2, true};
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
  info.outputs = {{"h", "m", numbers.next(), numbers.next()}, {"T", "K", -kInf, kInf}};
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
    const Command c{1500000000, {"x", "s"}, {numbers.next(), numbers.next()},
                    static_cast<CommandMode>(mode)};
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

TEST(Conversions, EmptyArraysStayEmpty) {
  const Measurement r = fromMsg(sent(toMsg(Measurement{})));
  EXPECT_EQ(0, r.outputs.size());
  EXPECT_FALSE(r.final);
  const Matrix wide = fromMsg(sent(toMsg(Matrix(0, 3))));
  EXPECT_EQ(0, wide.rows());
  EXPECT_EQ(3, wide.cols());
}

TEST(Conversions, MatricesTravelRowByRow) {
  Matrix m(2, 3);
  m << 1, 2, 3, 4, 5, 6;
  EXPECT_EQ((std::vector<double>{1, 2, 3, 4, 5, 6}), toMsg(m).data);
}

TsModel smallModel() {
  const auto set = [](MembershipShape shape, std::vector<double> p) { return Membership{shape, p}; };
  OutputModel submodel;
  submodel.antecedents = {{SignalKind::kOutput, 0, 0}, {SignalKind::kDisturbance, 0, 0}};
  submodel.regressors = {{SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, 1}};
  Rule rule;
  rule.antecedents = {set(MembershipShape::kExponential, {0.0, 1.0, 2.0, 3.0}),
                      set(MembershipShape::kGaussian, {1.0 / 3.0, 0.1})};
  rule.coefficients = Eigen::Vector2d(0.9, -0.1);
  rule.offset = 1e-300;
  rule.data_count = 18446744073709551615u;
  Rule other = rule;
  other.antecedents = {set(MembershipShape::kTriangular, {0.0, 1.0, 2.0}),
                       set(MembershipShape::kTrapezoidal, {0.0, 1.0, 2.0, 3.0})};
  submodel.rules = {rule, other};
  TsModel model;
  model.name = "small";
  model.source = "made up";
  model.sample_time_s = 720.0;
  model.outputs = {{"x", "mg/l", -kInf, kInf}};
  model.inputs = {{"q_r", "m3/h", 0.0, 1600.0}};
  model.disturbances = {{"q_i", "m3/h", 700.0, 2300.0}};
  model.submodels = {submodel};
  return model;
}

TEST(Conversions, FuzzyModelSurvives) {
  const TsModel m = smallModel();
  const TsModel r = fromMsg(sent(toMsg(m)));
  EXPECT_EQ(m.name, r.name);
  EXPECT_EQ(m.source, r.source);
  EXPECT_TRUE(sameBits(m.sample_time_s, r.sample_time_s));
  EXPECT_TRUE(sameSignals(m.outputs, r.outputs));
  EXPECT_TRUE(sameSignals(m.inputs, r.inputs));
  EXPECT_TRUE(sameSignals(m.disturbances, r.disturbances));
  ASSERT_EQ(1u, r.submodels.size());
  EXPECT_EQ(m.submodels[0].antecedents, r.submodels[0].antecedents);
  EXPECT_EQ(m.submodels[0].regressors, r.submodels[0].regressors);
  ASSERT_EQ(2u, r.submodels[0].rules.size());
  for (std::size_t i = 0; i < 2; ++i) {
    const Rule& a = m.submodels[0].rules[i];
    const Rule& b = r.submodels[0].rules[i];
    EXPECT_EQ(a.antecedents, b.antecedents);
    EXPECT_TRUE(sameNumbers(a.coefficients, b.coefficients));
    EXPECT_TRUE(sameBits(a.offset, b.offset));
    EXPECT_EQ(a.data_count, b.data_count);
  }
}

TEST(Conversions, MatrixWithMissingDataIsRefused) {
  fmbpc::PredictiveAction msg;
  msg.A.rows = msg.A.cols = 2;
  msg.A.data = {1.0, 2.0, 3.0};
  EXPECT_THROW(fromMsg(msg), InputError);
  msg.A.rows = msg.A.cols = 65536;  // their product overflows 32 bits to 0
  msg.A.data.clear();
  EXPECT_THROW(fromMsg(msg), InputError);
}

TEST(Conversions, UnknownEnumerationsAreRefused) {
  for (const std::uint8_t value : {0, 7, 255}) {
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
  fmbpc::FuzzyModel model = toMsg(smallModel());
  model.submodels[0].rules[0].antecedents[0].shape = 4;
  EXPECT_THROW(fromMsg(model), InputError);
  model = toMsg(smallModel());
  model.submodels[0].regressors[0].kind = 0;
  EXPECT_THROW(fromMsg(model), InputError);
}

TEST(Conversions, ListsOfDifferentLengthAreRefused) {
  fmbpc::Disturbance disturbance;
  disturbance.name = {"q_i", "s_i"};
  disturbance.value = {1.0};
  disturbance.mode = fmbpc::Disturbance::OVERRIDE;
  EXPECT_THROW(fromMsg(disturbance), InputError);
  fmbpc::PlantInfo info;
  info.outputs.resize(2);
  info.output_frames.resize(1);
  EXPECT_THROW(fromMsg(info), InputError);
  fmbpc::FuzzyModel model = toMsg(smallModel());
  model.submodels[0].rules[1].coefficients.pop_back();
  EXPECT_THROW(fromMsg(model), InputError);
}

TEST(Conversions, ReleaseNeedsNoValues) {
  fmbpc::Setpoint setpoint;
  setpoint.name = {"x", "s"};
  setpoint.mode = fmbpc::Setpoint::RELEASE;
  EXPECT_EQ(CommandMode::kRelease, fromMsg(setpoint).mode);
}

TEST(Conversions, StampsCoverTheRangeOfRosTimeOnly) {
  const std::int64_t last = (std::int64_t{1} << 32) * 1000000000 - 1;
  EXPECT_EQ(last, fromStamp(toStamp(last)));
  EXPECT_EQ(0, fromStamp(toStamp(0)));
  EXPECT_THROW(toStamp(last + 1), InputError);
  EXPECT_THROW(toStamp(-1), InputError);
}

}  // namespace
}  // namespace fpc
