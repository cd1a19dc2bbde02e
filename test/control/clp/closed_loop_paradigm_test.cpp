// Behaviour of the closed-loop paradigm, sample by sample, on cases whose answer is known on paper.
#include "control/clp/fixture.hpp"

#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"

namespace fpc::clp_test {
namespace control_clp_closed_loop_paradigm_test {

TEST(ClosedLoopParadigm, OneStepWithOneBoundIsClipping) {
  Case made = eager(1);
  made.limits.upper = one(20.0);
  const Outcome out = decide(made, steps(1));
  EXPECT_EQ(out.input(), 20.0);
  EXPECT_EQ(out.report.perturbation[0], -30.0);
  EXPECT_EQ(out.report.status, SolveStatus::kSolved);
  EXPECT_EQ(out.action.source, ActionSource::kConstrained);
  EXPECT_EQ(out.report.active_rows, 1u);
  EXPECT_LE(out.report.kkt_residual, 1e-9);
}

TEST(ClosedLoopParadigm, HeadersAreThoseOfThePredictiveAction) {
  Case made = eager(3);
  made.now.header = {123456789, 7, 42};
  const Outcome out = decide(made, steps(3));
  for (const StepHeader& header : {out.action.header, out.report.header}) {
    EXPECT_EQ(header.time_ns, 123456789);
    EXPECT_EQ(header.run_id, 7u);
    EXPECT_EQ(header.step, 42u);
  }
  EXPECT_GE(out.report.seconds, 0.0);
}

TEST(ClosedLoopParadigm, ABoundHitLaterIsMetByPerturbationsFromThere) {
  Case made = firstOrderLag(1.0, 0.1, 0.0, 0.0, 4, 0.0);  // K = 0: T = I, each c stands alone
  made.now.feedforward << 1.0, 2.0, 9.0, 9.0;
  made.now.input_base_unclipped = one(1.0);
  made.limits.upper = one(5.0);
  const Outcome out = decide(made, steps(4));
  EXPECT_NEAR(out.input(), 1.0, 1e-9);
  EXPECT_EQ(out.report.active_rows, 2u);
  EXPECT_EQ(out.action.source, ActionSource::kBase);
}

TEST(ClosedLoopParadigm, TrackingTermWeighsPerturbationAgainstError) {
  Case made = firstOrderLag(0.5, 2.0, 0.0, 3.0, 1, 4.0);
  made.now.reference << 11.0;
  ClpParams params = steps(1);
  params.weight_perturbation = one(4.0);
  params.weight_tracking = one(0.5);
  // min 4 (u - 3)^2 + 0.5 (2 + 2 u - 11)^2: u = (12 + 9) / (4 + 2)
  const Outcome out = decide(made, params);
  EXPECT_NEAR(out.input(), 3.5, 1e-9);
  EXPECT_NEAR(out.report.perturbation[0], 0.5, 1e-9);
}

TEST(ClosedLoopParadigm, FailingSolverMeansClippedBaseAndItsStatus) {
  Case made = eager(20);
  made.limits = {one(-1.0), one(1.5), one(0.2)};
  made.now.input_previous = one(1.4);
  ClpParams params = steps(20);
  params.qp.max_iterations = 1;
  const Outcome out = decide(made, params);
  EXPECT_EQ(out.report.status, SolveStatus::kIterationLimit);
  EXPECT_EQ(out.input(), 1.5);
  EXPECT_EQ(out.report.perturbation[0], 1.5 - 50.0);
  EXPECT_EQ(out.action.source, ActionSource::kClipped);
}

TEST(ClosedLoopParadigm, ABaseThatDoesNotFollowFromTheLawIsClipped) {
  Case made = eager(5);
  made.limits.upper = one(20.0);
  made.now.input_base_unclipped[0] += 1e-6;
  const Outcome out = decide(made, steps(5));
  EXPECT_EQ(out.report.status, SolveStatus::kInconsistent);
  EXPECT_EQ(out.input(), 20.0);
  EXPECT_EQ(out.action.source, ActionSource::kClipped);
  made.now.input_base_unclipped[0] -= 1e-6 - 1e-9;
  EXPECT_EQ(decide(made, steps(5)).report.status, SolveStatus::kSolved);
}

TEST(ClosedLoopParadigm, NothingThatIsNotFiniteComesThrough) {
  for (const double bad : {std::nan(""), kInfinity, -kInfinity}) {
    for (int field = 0; field < 10; ++field) {
      SCOPED_TRACE(field);
      Case made = eager(5);
      made.limits = {one(-5.0), one(20.0), one(100.0)};
      PredictiveAction& now = made.now;
      double* const place[] = {now.state.data(),
                               now.A.data(),
                               now.B.data(),
                               now.C.data(),
                               now.offset_state.data(),
                               now.offset_output.data(),
                               now.K.data(),
                               now.feedforward.data() + 3,
                               now.reference.data() + 2,
                               now.setpoint.data()};
      *place[field] = bad;
      const Outcome out = decide(made, steps(5));
      EXPECT_EQ(out.report.status, SolveStatus::kInvalidProblem);
      EXPECT_EQ(out.input(), 20.0);
      EXPECT_EQ(out.action.source, ActionSource::kClipped);
      EXPECT_EQ(out.report.perturbation[0], -30.0);
    }
  }
}

TEST(ClosedLoopParadigm, WithoutAFiniteBaseTheInputIsHeldInsideItsBounds) {
  Case made = eager(5);
  made.limits = {one(-5.0), one(20.0), one(100.0)};
  made.now.input_base_unclipped = one(std::nan(""));
  made.now.input_previous = one(30.0);
  Outcome out = decide(made, steps(5));
  EXPECT_EQ(out.input(), 20.0);
  EXPECT_EQ(out.action.source, ActionSource::kHeld);
  EXPECT_EQ(out.report.status, SolveStatus::kInvalidProblem);
  EXPECT_EQ(out.report.perturbation[0], 0.0);
  made.now.input_previous = one(std::nan(""));
  out = decide(made, steps(5));
  EXPECT_EQ(out.input(), 0.0);
}

TEST(ClosedLoopParadigm, OverflowInThePredictionIsAStatus) {
  Case made = eager(10);
  made.limits.upper = one(20.0);
  made.now.A = Matrix::Constant(1, 1, 1e200);
  const Outcome out = decide(made, steps(10));
  EXPECT_NE(out.report.status, SolveStatus::kSolved);
  EXPECT_EQ(out.input(), 20.0);
}

TEST(ClosedLoopParadigm, LqRefusesABaseLawThatIsNotStable) {
  Case made = firstOrderLag(1.1, 0.1, 0.5, 0.0, 5, -100.0);  // Phi = 1.05, base 50
  made.limits.upper = one(20.0);
  ClpParams params = steps(5);
  params.cost = ClpCostKind::kLq;
  const Outcome out = decide(made, params);
  EXPECT_EQ(out.report.status, SolveStatus::kNumericalError);
  EXPECT_EQ(out.input(), 20.0);
}

TEST(ClosedLoopParadigm, LqRefusesATargetThatNoInputReaches) {
  Case made = eager(5);
  made.now.B.setZero();
  ClpParams params = steps(5);
  params.cost = ClpCostKind::kLq;
  EXPECT_EQ(decide(made, params).report.status, SolveStatus::kNumericalError);
}

TEST(ClosedLoopParadigm, LongerTrajectoriesAreReadToTheHorizonOnly) {
  Case made = eager(6);
  made.limits.upper = one(20.0);
  const Outcome expected = decide(made, steps(6));
  made.now.feedforward.conservativeResize(1, 9);
  made.now.reference.conservativeResize(1, 9);
  made.now.feedforward.rightCols(3).setConstant(std::nan(""));
  made.now.reference.rightCols(3).setConstant(std::nan(""));
  const Outcome out = decide(made, steps(6));
  EXPECT_EQ(out.report.status, SolveStatus::kSolved);
  EXPECT_EQ(out.input(), expected.input());
}

TEST(ClosedLoopParadigm, AWrongSizeIsNamed) {
  Case made = eager(6);
  ClosedLoopParadigm clp = made.make(steps(7));
  Outcome out;
  try {
    clp.step(made.now, out.action, out.report);
    FAIL() << "accepted six columns for seven steps";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("feedforward"), std::string::npos) << error.what();
  }
}

TEST(ClosedLoopParadigm, AfterResetItRepeatsItselfBitForBit) {
  Draw draw(5);
  Case made = randomCase(draw, 4, 2, 2, 12);
  made.limits = {Vector::Constant(2, -8.0), Vector::Constant(2, 8.0), Vector::Constant(2, 3.0)};
  made.now.input_previous.setZero();
  ClosedLoopParadigm clp = made.make(steps(12));
  Matrix runs[2];
  for (Matrix& run : runs) {
    clp.reset();
    PredictiveAction now = made.now;
    Outcome out;
    run.resize(2, 25);
    for (int k = 0; k < 25; ++k) {
      now.input_base_unclipped = baseLaw(now);
      clp.step(now, out.action, out.report);
      run.col(k) = out.action.input;
      now.state = now.A * now.state + now.B * out.action.input + now.offset_state;
      now.input_previous = out.action.input;
    }
  }
  EXPECT_TRUE(runs[0] == runs[1]);
}

}  // namespace control_clp_closed_loop_paradigm_test
}  // namespace fpc::clp_test
