#include "model/gain_sign.hpp"

#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"
#include "identification/model_fixture.hpp"

namespace fpc {
namespace fuzzy_gain_sign_test {

void takeOver(const TsModel& running, const TsModel& fresh, const Measurement& at) {
  requireFewTurned(turnedGains(running, fresh, at), fresh);
}

/// y(k+1) = a y + b1 u1 + b2 u2: gains b / (1 - a).
TsModel model(double a, double b1, double b2) {
  return test::oneRule(
      test::numbered("u", 2),
      {{SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, 0}, {SignalKind::kInput, 1, 0}},
      Eigen::Vector3d(a, b1, b2));
}

Measurement rest() {
  Measurement m;
  m.outputs = Vector::Zero(1);
  m.input_applied = Vector::Zero(2);
  return m;
}

TEST(GainSign, GainsAreThoseOfPaper) {
  const Matrix gains = stepGains(model(0.5, 2.0, -1.0), rest());
  EXPECT_NEAR(gains(0, 0), 4.0, 1e-12);
  EXPECT_NEAR(gains(0, 1), -2.0, 1e-12);
  EXPECT_EQ(stepGains(model(1.0, 2.0, 0.0), rest())(0, 0), 2.0 * kGainSamples);  // an integrator
}

TEST(GainSign, AGainThatTurnsRoundIsRefusedByName) {
  EXPECT_NO_THROW(takeOver(model(0.5, 2.0, 1.0), model(0.8, 0.1, 0.1), rest()));
  try {
    takeOver(model(0.5, 2.0, 1.0), model(0.5, -2.0, 1.0), rest());
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("from u1 to y"), std::string::npos) << error.what();
  }
}

TEST(GainSign, SmallGainsMayTurnAndUnstableModelsAreNotJudged) {
  EXPECT_NO_THROW(takeOver(model(0.5, 2.0, 0.1), model(0.5, 2.0, -0.1), rest()));
  EXPECT_NO_THROW(takeOver(model(2.0, 2.0, 1.0), model(0.5, -2.0, 1.0), rest()));
}

/// n outputs, y_i(k+1) = 0.5 y_i + b_i u.
TsModel outputsOf(const std::vector<double>& b) {
  TsModel m;
  m.name = "new";
  m.sample_time_s = 1.0;
  m.outputs = test::numbered("y", static_cast<int>(b.size()));
  m.inputs = {test::signal("u")};
  for (std::size_t i = 0; i < b.size(); ++i) {
    const auto own = static_cast<int>(i);
    OutputModel y;
    y.antecedents = {{SignalKind::kOutput, own, 0}};
    y.regressors = {{SignalKind::kOutput, own, 0}, {SignalKind::kInput, 0, 0}};
    y.rules = {{{{MembershipShape::kTriangular, {-1e3, 0.0, 1e3}}},
                (Vector(2) << 0.5, b[i]).finished(),
                0.0,
                0}};
    m.submodels.push_back(y);
  }
  return m;
}

struct Border {
  int outputs, turned;
  bool refused;
};

TEST(GainSign, MoreThanHalfOfTheOutputsAreTooMany) {
  for (const Border& border : {Border{1, 1, true}, Border{2, 0, false}, Border{2, 1, false},
                               Border{2, 2, true}, Border{3, 1, false}, Border{3, 2, true}}) {
    std::vector<double> before(static_cast<std::size_t>(border.outputs), 2.0), after = before;
    for (int i = 0; i < border.turned; ++i) after[static_cast<std::size_t>(i)] = -1.0;
    Measurement at;
    at.outputs = Vector::Zero(border.outputs);
    at.input_applied = Vector::Zero(1);
    const TsModel running = outputsOf(before), fresh = outputsOf(after);
    const auto turned = turnedGains(running, fresh, at);
    const std::string which =
        std::to_string(border.turned) + " of " + std::to_string(border.outputs);
    EXPECT_EQ(turned.size(), static_cast<std::size_t>(border.turned)) << which;
    EXPECT_EQ(tooManyTurned(turned, running), border.refused) << which;
    EXPECT_EQ(wordsOf(turned, fresh).empty(), border.turned == 0) << which;
    if (border.refused)
      EXPECT_THROW(takeOver(running, fresh, at), InputError) << which;
    else
      EXPECT_NO_THROW(takeOver(running, fresh, at)) << which;
  }
}

TEST(GainSign, EveryTurnedOutputIsNamed) {
  Measurement at;
  at.outputs = Vector::Zero(3);
  at.input_applied = Vector::Zero(1);
  const TsModel fresh = outputsOf({-1.0, 1.0, -1.0});
  EXPECT_EQ(wordsOf(turnedGains(outputsOf({1.0, 1.0, 1.0}), fresh, at), fresh),
            "model 'new' turns the sign of the gain from u to y1, u to y3");
}

}  // namespace fuzzy_gain_sign_test
}  // namespace fpc
