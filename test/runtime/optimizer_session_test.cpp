#include <functional>

#include <gtest/gtest.h>

#include "control/clp/fixture.hpp"
#include "fmbpc/base/input_error.hpp"
#include "runtime/optimizer_fixture.hpp"

namespace fpc {
namespace control_optimizer_session_test {

using namespace optimizer_test;

TEST(OptimizerSession, PairsBaseAndPredictionInAnyOrder) {
  OptimizerSession session = make();
  EXPECT_FALSE(session.receive(base(header(0))));
  EXPECT_TRUE(session.receive(prediction(header(0))));
  EXPECT_EQ(session.action().header.step, 0u);
  EXPECT_FALSE(session.receive(prediction(header(1))));
  EXPECT_TRUE(session.receive(base(header(1))));
  EXPECT_EQ(session.action().header.step, 1u);
  EXPECT_EQ(session.report().header.step, 1u);
  EXPECT_EQ(session.action().header.time_ns, header(1).time_ns);
  EXPECT_EQ(session.counts().accepted, 2u);
  EXPECT_EQ(session.counts().repeated, 0u);
}

TEST(OptimizerSession, BaseLawThatIsFeasibleIsSentUnchanged) {
  OptimizerSession session = make();
  const PredictiveAction p = prediction(header(0));
  session.receive(base(header(0)));
  session.receive(p);
  EXPECT_EQ(session.action().input, p.input_base_unclipped);
  EXPECT_EQ(session.action().source, ActionSource::kBase);
  EXPECT_EQ(session.report().status, SolveStatus::kSolved);
  EXPECT_EQ(session.report().perturbation[0], 0.0);
  EXPECT_EQ(session.trouble(), "");
}

TEST(OptimizerSession, ClippedBaseIsOptimizedInsideTheBounds) {
  OptimizerSession session = make();
  session.receive(base(header(0), 1600.0, ActionSource::kClipped));
  ASSERT_TRUE(session.receive(prediction(header(0), 2000.0)));
  EXPECT_EQ(session.report().status, SolveStatus::kSolved);
  EXPECT_NEAR(session.action().input[0], 1600.0, 1e-6);
  EXPECT_LE(session.action().input[0], 1600.0);
  EXPECT_NEAR(session.report().perturbation[0], 1600.0 - 2804.0, 1e-6);
}

TEST(OptimizerSession, PlanBeginsWithWhatIsSentAndKeepsTheLimits) {
  OptimizerSession session = make();
  EXPECT_EQ(session.plan().size(), 0);
  for (const double feedforward : {300.0, 2000.0}) {
    const std::uint32_t step = feedforward < 1000.0 ? 0 : 1;
    session.receive(base(header(step), 1600.0));
    ASSERT_TRUE(session.receive(prediction(header(step), feedforward)));
    const Matrix plan = session.plan();
    ASSERT_EQ(plan.rows(), 1);
    EXPECT_NEAR(plan(0, 0), session.action().input[0], 1e-6);
    EXPECT_GE(plan.minCoeff(), -1e-6);
    EXPECT_LE(plan.maxCoeff(), 1600.0 + 1e-6);
  }
  ASSERT_TRUE(session.receive(base(header(2), 123.0, ActionSource::kManual)));
  EXPECT_EQ(session.plan().size(), 0);
}

TEST(OptimizerSession, HeldManualAndFallbackPassThrough) {
  OptimizerSession session = make();
  std::uint32_t step = 0;
  for (const ActionSource source :
       {ActionSource::kHeld, ActionSource::kManual, ActionSource::kFallback}) {
    ASSERT_TRUE(session.receive(base(header(step), 123.0, source)));
    EXPECT_EQ(session.action().input[0], 123.0);
    EXPECT_EQ(session.action().source, source);
    EXPECT_EQ(session.report().status, SolveStatus::kNotRun);
    EXPECT_EQ(session.report().perturbation, Vector::Zero(1));
    EXPECT_EQ(session.report().header.step, step++);
  }
  ASSERT_TRUE(session.receive(base(header(step), 9999.0, ActionSource::kManual)));
  EXPECT_EQ(session.action().input[0], 1600.0);  // the bounds hold whoever asks
}

TEST(OptimizerSession, RepeatsOfAnAnsweredSampleGetTheCachedAnswer) {
  OptimizerSession session = make();
  session.receive(base(header(0)));
  session.receive(prediction(header(0)));
  const double seconds = session.report().seconds;
  EXPECT_TRUE(session.receive(base(header(0), 1.0)));
  EXPECT_TRUE(session.receive(prediction(header(0), 500.0)));
  EXPECT_NEAR(session.action().input[0], 804.0, 1e-9);
  EXPECT_EQ(session.report().seconds, seconds);  // nothing was solved again
  EXPECT_EQ(session.counts().repeated, 2u);
  EXPECT_EQ(session.counts().accepted, 1u);
}

TEST(OptimizerSession, RepeatBeforeThePartnerCameIsNotAnAnswer) {
  OptimizerSession session = make();
  EXPECT_FALSE(session.receive(base(header(0))));
  EXPECT_FALSE(session.receive(base(header(0))));
  EXPECT_EQ(session.counts().repeated, 1u);
  EXPECT_TRUE(session.receive(prediction(header(0))));
}

TEST(OptimizerSession, OldAndForeignSamplesAreDroppedAndCountedApart) {
  OptimizerSession session = make();
  session.receive(base(header(4, 7)));  // joins late
  EXPECT_TRUE(session.receive(prediction(header(4, 7))));
  EXPECT_EQ(session.counts().gaps, 0u);
  EXPECT_FALSE(session.receive(base(header(3, 7))));
  EXPECT_FALSE(session.receive(prediction(header(2, 7))));
  EXPECT_FALSE(session.receive(base(header(5, 6))));
  EXPECT_EQ(session.counts().old, 2u);
  EXPECT_EQ(session.counts().other_run, 1u);
  EXPECT_EQ(session.action().header.step, 4u);
}

TEST(OptimizerSession, MovesOnWhenAPartnerNeverCame) {
  OptimizerSession session = make();
  EXPECT_FALSE(session.receive(base(header(0))));
  EXPECT_FALSE(session.receive(base(header(1))));
  EXPECT_FALSE(session.receive(prediction(header(0))));
  EXPECT_TRUE(session.receive(prediction(header(1))));
  EXPECT_EQ(session.action().header.step, 1u);
  session.receive(prediction(header(2)));
  EXPECT_FALSE(session.receive(base(header(3))));  // never with the prediction of another sample
}

using Spoil = std::function<void(PredictiveAction&)>;

void expectClipped(const Spoil& spoil, bool base_first) {
  OptimizerSession session = make();
  PredictiveAction bad = prediction(header(0));
  spoil(bad);
  if (base_first) {
    EXPECT_FALSE(session.receive(base(header(0), 2000.0)));
    EXPECT_TRUE(session.receive(bad));
  } else {
    EXPECT_FALSE(session.receive(bad));
    EXPECT_TRUE(session.receive(base(header(0), 2000.0)));
  }
  EXPECT_EQ(session.action().input[0], 1600.0);
  EXPECT_EQ(session.action().source, ActionSource::kClipped);
  EXPECT_EQ(session.report().status, SolveStatus::kInvalidProblem);
  EXPECT_NE(session.trouble(), "");
  EXPECT_EQ(session.counts().wrong_size + session.counts().not_finite, 1u);
  EXPECT_TRUE(session.receive(base(header(0), 2000.0)));  // the cached answer
  session.receive(base(header(1)));
  EXPECT_TRUE(session.receive(prediction(header(1))));  // and the loop goes on
  EXPECT_EQ(session.report().status, SolveStatus::kSolved);
  EXPECT_EQ(session.trouble(), "");
}

void expectClipped(const std::vector<Spoil>& spoils) {
  for (std::size_t i = 0; i < spoils.size(); ++i) {
    SCOPED_TRACE("spoil " + std::to_string(i));
    expectClipped(spoils[i], true);
    expectClipped(spoils[i], false);
  }
}

TEST(OptimizerSession, PredictionOfWrongSizeIsCountedAndTheBaseIsClipped) {
  const std::vector<Spoil> spoils{
      [](PredictiveAction& p) { p.state = Vector::Zero(2); },
      [](PredictiveAction& p) { p.state = Vector(); },
      [](PredictiveAction& p) { p.A = Matrix::Zero(3, 2); },
      [](PredictiveAction& p) { p.B = Matrix::Zero(3, 2); },
      [](PredictiveAction& p) { p.C = Matrix::Zero(1, 3); },
      [](PredictiveAction& p) { p.offset_state = Vector::Zero(4); },
      [](PredictiveAction& p) { p.offset_output = Vector::Zero(1); },
      [](PredictiveAction& p) { p.K = Matrix::Zero(3, 1); },
      [](PredictiveAction& p) { p.feedforward = Matrix::Zero(1, kSteps - 1); },
      [](PredictiveAction& p) { p.feedforward = Matrix::Zero(2, kSteps); },
      [](PredictiveAction& p) { p.reference = Matrix::Zero(2, kSteps - 1); },
      [](PredictiveAction& p) { p.setpoint = Vector::Zero(3); },
      [](PredictiveAction& p) { p.input_base_unclipped = Vector::Zero(2); },
      [](PredictiveAction& p) { p.input_previous = Vector(); }};
  expectClipped(spoils);
}

std::vector<double*> numbersOf(PredictiveAction& p) {
  std::vector<double*> numbers{&p.feedforward(0, kSteps - 1)};
  for (Matrix* m : {&p.A, &p.B, &p.C, &p.K, &p.reference}) numbers.push_back(m->data());
  for (Vector* v : {&p.state, &p.offset_state, &p.offset_output, &p.setpoint, &p.input_previous,
                    &p.input_base_unclipped})
    numbers.push_back(v->data());
  return numbers;
}

TEST(OptimizerSession, PredictionThatIsNotFiniteIsCountedAndTheBaseIsClipped) {
  std::vector<Spoil> spoils;
  for (std::size_t i = 0; i < 12; ++i)
    for (const double bad : {kNaN, kInfinity})
      spoils.push_back([i, bad](PredictiveAction& p) { *numbersOf(p)[i] = bad; });
  expectClipped(spoils);
}

TEST(OptimizerSession, UnusablePredictionDoesNotOpenASample) {
  OptimizerSession session = make();
  PredictiveAction foreign = prediction(header(4000000000u, 99));
  foreign.A = Matrix();
  EXPECT_FALSE(session.receive(foreign));
  EXPECT_FALSE(session.receive(base(header(0))));
  EXPECT_FALSE(session.receive(foreign));  // of another sample than the base
  EXPECT_TRUE(session.receive(prediction(header(0))));
  EXPECT_EQ(session.report().status, SolveStatus::kSolved);
  EXPECT_FALSE(session.receive(foreign));
  EXPECT_EQ(session.counts().wrong_size, 3u);
}

TEST(OptimizerSession, BadBaseActionIsDroppedAndCounted) {
  OptimizerSession session = make();
  ControlAction wrong = base(header(0));
  wrong.input = Vector::Zero(2);
  EXPECT_FALSE(session.receive(wrong));
  EXPECT_FALSE(session.receive(base(header(0), kNaN, ActionSource::kHeld)));
  EXPECT_EQ(session.counts().wrong_size, 1u);
  EXPECT_EQ(session.counts().not_finite, 1u);
  EXPECT_EQ(session.counts().accepted, 0u);
  session.receive(base(header(0)));
  EXPECT_TRUE(session.receive(prediction(header(0))));
}

TEST(OptimizerSession, LongerPredictionThanNeededIsWelcome) {
  OptimizerSession session = make();
  session.receive(base(header(0)));
  EXPECT_TRUE(session.receive(prediction(header(0), 0.0, kSteps + 5)));
  EXPECT_EQ(session.report().status, SolveStatus::kSolved);
}

TEST(OptimizerSession, ModelOfAnotherOrderIsTakenInTheMiddleOfARun) {
  OptimizerSession session = make();
  session.receive(base(header(0)));
  session.receive(prediction(header(0)));
  PredictiveAction larger = prediction(header(1));
  larger.state = Vector::Zero(4);
  larger.state.head(3) = prediction(header(1)).state;
  larger.A.conservativeResizeLike(Matrix::Zero(4, 4));
  larger.B.conservativeResizeLike(Matrix::Zero(4, 1));
  larger.C.conservativeResizeLike(Matrix::Zero(2, 4));
  larger.offset_state.conservativeResizeLike(Vector::Zero(4));
  larger.K.conservativeResizeLike(Matrix::Zero(1, 4));
  session.receive(base(header(1)));
  ASSERT_TRUE(session.receive(larger));
  EXPECT_EQ(session.report().status, SolveStatus::kSolved);
  EXPECT_NEAR(session.action().input[0], 804.0, 1e-9);
  session.receive(base(header(2)));
  EXPECT_TRUE(session.receive(prediction(header(2))));
  EXPECT_EQ(session.report().status, SolveStatus::kSolved);
}

void solve(OptimizerSession& session, const StepHeader& h) {
  session.receive(base(h, 1600.0, ActionSource::kClipped));
  ASSERT_TRUE(session.receive(prediction(h, 2000.0)));
  ASSERT_EQ(session.report().status, SolveStatus::kSolved);
}

TEST(OptimizerSession, GapAndNewRunForgetTheWarmStart) {
  OptimizerSession session = make();
  solve(session, header(0));
  const std::uint32_t cold = session.report().iterations;
  solve(session, header(1));
  ASSERT_LT(session.report().iterations, cold);  // the sample before helps
  solve(session, header(5));
  EXPECT_EQ(session.report().iterations, cold);
  EXPECT_EQ(session.counts().gaps, 1u);
  solve(session, header(0, 2));
  EXPECT_EQ(session.report().iterations, cold);
  EXPECT_EQ(session.counts().new_runs, 1u);
}

TEST(OptimizerSession, BadParamsAreRefusedAtConstruction) {
  ClpParams p = params();
  p.perturbation_steps = 0;
  InputLimits limits = clp_test::sludgeLike(kSteps).limits;
  EXPECT_THROW(OptimizerSession(p, limits, plant()), InputError);
  limits.upper = Vector::Zero(2);
  EXPECT_THROW(OptimizerSession(params(), limits, plant()), InputError);
}

}  // namespace control_optimizer_session_test
}  // namespace fpc
