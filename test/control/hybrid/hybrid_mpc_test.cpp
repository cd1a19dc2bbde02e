// Behaviour of the hybrid predictive law around its search: costs by hand, blocks, transitions,
// faults, budgets; and what it never sends.
#include "control/hybrid/hybrid_mpc.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "control/hybrid/fixture.hpp"
#include "fmbpc/base/input_error.hpp"
#include "runtime/session.hpp"

namespace fpc {
namespace control_hybrid_hybrid_mpc_test {

SetpointParams asked(double T) {
  SetpointParams params;
  params.initial = Eigen::Vector2d(T, 20.0);
  return params;
}

ControllerSession sessionOf(HybridMpcParams params, double T = 40.0) {
  ControllerSession session(
      std::make_unique<HybridMpc>(std::move(params), test::batchReactorLimits(),
                                  test::batchReactorInfo()),
      asked(T), test::batchReactorLimits(), Eigen::Vector3d(0.0, 0.0, 1.0), [] {
        PlantInfo info = test::batchReactorInfo();
        info.header.time_ns = 1000000000;
        return info;
      }());
  session.setModel(test::batchModel("batch_fuzzy"));
  return session;
}

Measurement measured(std::uint32_t step, double T, double Tw, const Vector& applied) {
  Measurement m;
  m.header = {1000000000 + std::int64_t{10000000000} * step, 1, step};
  m.outputs = Eigen::Vector2d(T, Tw);
  m.disturbances = Vector(0);
  m.input_applied = applied;
  return m;
}

const Vector kShut = Eigen::Vector3d(0.0, 0.0, 1.0);

// One block of one sample from T = Tw = 40 with setpoint 40: eq. 45 by hand for each input vector.
TEST(HybridMpc, TheCostOfABlockIsThatOfEquation45) {
  HybridMpcParams params = test::batchReactorParams(45, BranchBound::kCost, 1);
  params.hold_samples = 1;
  params.weight_tracking[0] = 2.0;
  const auto mpc = test::batchReactorMpc(params);
  const Eigen::Vector2d at(39.0, 41.0);
  mpc->decide(at, Eigen::Vector3d(0.1, 0.0, 1.0), Vector(0), Eigen::Vector2d(40.0, 0.0));
  for (int choice = 0; choice < 7; ++choice) {
    const Vector u = test::batchReactorInputs().col(choice);
    Vector state = at;
    const double cost = mpc->problem().advance(0, -1, choice, state);
    const double error = 0.0033 * 41.0 + 0.9967 * 39.0 - 40.0;
    const double expected =
        2.0 * error * error + 15.0 * u[1] * 1.0 + 0.03 * std::abs(u[0] - 0.1) * 1.0;
    EXPECT_NEAR(cost, expected, 1e-12) << "choice " << choice;
  }
}

/// y(k+1) = y + u, but y + 5 (1 - u) in a band that no point of an even grid over 0 to 90 meets.
TsModel bandModel() {
  TsModel model;
  model.name = "band";
  model.sample_time_s = 1.0;
  model.outputs = {{"y", "", 0.0, 90.0}};
  model.inputs = {{"u", "", 0.0, 1.0}};
  const Regressor y{SignalKind::kOutput, 0, 0}, u{SignalKind::kInput, 0, 0};
  const auto rule = [](double from, double to, double gain, double offset) {
    Rule r;
    r.antecedents = {{MembershipShape::kTrapezoidal, {from, from, to, to}}};
    r.coefficients = Eigen::Vector2d(1.0, gain);
    r.offset = offset;
    return r;
  };
  model.submodels = {{{y}, {y, u}, {}}};
  model.submodels[0].rules = {rule(-1.0, 49.995, 1.0, 0.0), rule(49.995, 50.005, -5.0, 5.0),
                              rule(50.005, 200.0, 1.0, 0.0)};
  return model;
}

// From 49 the way leads through the band, where the input that raises y elsewhere lowers it.
TEST(HybridMpc, ABandBetweenTwoPointsOfAGridIsNotMissedByTheBound) {
  PlantInfo info;
  info.outputs = bandModel().outputs;
  info.inputs = bandModel().inputs;
  const InputLimits limits{Vector::Zero(1), Vector::Ones(1), Vector::Constant(1, kInfinity)};
  double cost[2];
  for (const BranchBound bound : {BranchBound::kCost, BranchBound::kReach}) {
    HybridMpcParams params;
    params.choices = (Matrix(1, 2) << 0.0, 1.0).finished();
    params.hold_samples = 1;
    params.horizon_blocks = 4;
    params.weight_tracking = Vector::Ones(1);
    params.bound = bound;
    HybridMpc mpc(params, limits, info);
    mpc.setModel(bandModel());
    const Matrix reference = Matrix::Constant(1, 4, 56.0);
    cost[bound == BranchBound::kReach] =
        mpc.decide(Vector::Constant(1, 49.0), Vector::Zero(1), Vector(0), reference).cost;
    EXPECT_FALSE(mpc.boundsByReach());
  }
  EXPECT_EQ(cost[0], 36.0 + 1.0 + 0.0 + 0.0);
  EXPECT_EQ(cost[1], cost[0]);
}

TEST(HybridMpc, AnInputIsHeldForItsBlockAndDecidedAtItsStart) {
  ControllerSession session = sessionOf(test::batchReactorParams(44, BranchBound::kReach));
  Vector applied = kShut;
  for (std::uint32_t k = 0; k < 31; ++k) {
    const double T = k < 10 ? 30.0 : 50.0;  // from far below to far above within the first block
    ASSERT_EQ(session.receive(measured(k, T, 40.0, applied)), Receipt::kAnswered);
    applied = session.answer().base.input;
    const bool heat = k < 15;
    EXPECT_EQ(applied, Vector(Eigen::Vector3d(1.0, heat ? 0.0 : 1.0, heat ? 1.0 : 0.0))) << k;
  }
}

TEST(HybridMpc, ForbiddenTransitionsAndMoveLimitsAreKept) {
  HybridMpcParams params = test::batchReactorParams(44, BranchBound::kReach, 3);
  const double any = std::nan("");
  params.forbidden_transitions = {{Eigen::Vector3d(any, any, 1.0), Eigen::Vector3d(any, 1.0, any)}};
  auto mpc = test::batchReactorMpc(params);
  const Matrix cold = Eigen::Vector2d(20.0, 0.0).replicate(1, 45);
  EXPECT_EQ(mpc->decide(Eigen::Vector2d(60, 60), kShut, Vector(0), cold).choices.front(), 0);
  const Vector from_cold = Eigen::Vector3d(1.0, 1.0, 0.0);
  EXPECT_EQ(mpc->decide(Eigen::Vector2d(60, 60), from_cold, Vector(0), cold).choices.front(), 6);

  InputLimits slow = test::batchReactorLimits();
  slow.move = Eigen::Vector3d(0.05, 1.0, 1.0);
  HybridMpc limited(test::batchReactorParams(44, BranchBound::kReach, 3), slow,
                    test::batchReactorInfo());
  limited.setModel(test::batchModel("batch_fuzzy"));
  const Matrix hot = Eigen::Vector2d(70.0, 0.0).replicate(1, 45);
  const TreeResult& r = limited.decide(Eigen::Vector2d(20, 20), kShut, Vector(0), hot);
  EXPECT_EQ(r.choices, (std::vector<int>{3, 4, 4}));  // 0.05, 0.1, and 1 is out of reach
}

TEST(HybridMpc, WhereNothingIsAllowedTheNearestAllowedInputIsSentAndSaid) {
  HybridMpcParams params = test::batchReactorParams(44, BranchBound::kReach, 2);
  const double any = std::nan("");
  params.forbidden_transitions = {{Eigen::Vector3d(0.3, any, any), Eigen::Vector3d(any, any, any)}};
  ControllerSession session = sessionOf(params);
  session.receive(measured(0, 30.0, 30.0, Eigen::Vector3d(0.3, 0.0, 1.0)));
  EXPECT_EQ(session.answer().base.input, Vector(Eigen::Vector3d(0.1, 0.0, 1.0)));
  EXPECT_TRUE(session.output().events.has(EventCode::kNoAllowedInput));
}

TEST(HybridMpc, ABudgetStillGivesAnAllowedInputAndSaysSo) {
  HybridMpcParams params = test::batchReactorParams(45, BranchBound::kCost);
  params.node_budget = 28;
  ControllerSession session = sessionOf(params, 30.5);
  session.receive(measured(0, 30.0, 31.0, kShut));
  EXPECT_EQ(session.answer().base.source, ActionSource::kBase);
  EXPECT_TRUE(session.output().events.has(EventCode::kSolverLimit));
  params.node_budget = 27;
  EXPECT_THROW(sessionOf(params), InputError);
}

TEST(HybridMpc, AStuckValveIsNamed) {
  ControllerSession session = sessionOf(test::batchReactorParams(44, BranchBound::kReach));
  session.receive(measured(0, 30.0, 30.0, kShut));
  EXPECT_FALSE(session.output().events.has(EventCode::kInputStuck));
  session.receive(measured(1, 30.0, 30.0, Eigen::Vector3d(0.02, 0.0, 1.0)));
  EXPECT_TRUE(session.output().events.has(EventCode::kInputStuck));
  session.receive(measured(2, 30.0, 30.0, session.answer().base.input));
  EXPECT_FALSE(session.output().events.has(EventCode::kInputStuck));
}

TEST(HybridMpc, WhatIsNotAllowedIsNeverSent) {
  ControllerSession session = sessionOf(test::batchReactorParams(44, BranchBound::kReach));
  session.receive(measured(0, 30.0, 30.0, kShut));
  session.receive(measured(1, std::nan(""), 30.0, Eigen::Vector3d(0.4, 0.0, 1.0)));
  EXPECT_EQ(session.answer().base.source, ActionSource::kHeld);
  EXPECT_EQ(session.answer().base.input, Vector(Eigen::Vector3d(0.1, 0.0, 1.0)));
  session.manual(true);
  session.receive(measured(2, 30.0, 30.0, Eigen::Vector3d(0.9, 0.1, 0.9)));
  EXPECT_EQ(session.answer().base.input, Vector(Eigen::Vector3d(1.0, 0.0, 1.0)));
  EXPECT_THROW(session.manualInput(Eigen::Vector3d(1.0, 1.0, 1.0)), InputError);
  session.manualInput(Eigen::Vector3d(0.05, 0.0, 1.0));
  session.receive(measured(3, 30.0, 30.0, Eigen::Vector3d(1.0, 0.0, 1.0)));
  EXPECT_EQ(session.answer().base.input, Vector(Eigen::Vector3d(0.05, 0.0, 1.0)));
}

TEST(HybridMpc, WithoutRangesInTheModelTheBoundIsThePublishedOne) {
  TsModel model = test::batchModel("batch_fuzzy");
  for (auto& output : model.outputs) {
    output.lower = -std::numeric_limits<double>::infinity();
    output.upper = std::numeric_limits<double>::infinity();
  }
  HybridMpc mpc(test::batchReactorParams(44, BranchBound::kReach), test::batchReactorLimits(),
                test::batchReactorInfo());
  mpc.setModel(model);
  EXPECT_FALSE(mpc.boundsByReach());
  const Matrix reference = Eigen::Vector2d(31.0, 0.0).replicate(1, 60);
  const auto exact = test::batchReactorMpc(test::batchReactorParams(44, BranchBound::kCost));
  const Eigen::Vector2d at(30.0, 33.0);
  EXPECT_EQ(mpc.decide(at, kShut, Vector(0), reference).nodes,
            exact->decide(at, kShut, Vector(0), reference).nodes);
}

TEST(HybridMpc, EachParameterIsChecked) {
  const auto refused = [](const auto& change) {
    HybridMpcParams params = test::batchReactorParams(45, BranchBound::kReach);
    change(params);
    EXPECT_THROW(params.validate(2, 3), InputError);
  };
  EXPECT_NO_THROW(test::batchReactorParams(45, BranchBound::kReach).validate(2, 3));
  refused([](HybridMpcParams& p) { p.choices.col(1) = p.choices.col(0); });
  refused([](HybridMpcParams& p) { p.choices = Matrix(3, 0); });
  refused([](HybridMpcParams& p) { p.choices(2, 2) = -1.0; });
  refused([](HybridMpcParams& p) { p.hold_samples = 0; });
  refused([](HybridMpcParams& p) { p.horizon_blocks = 0; });
  refused([](HybridMpcParams& p) { p.weight_tracking[0] = -1.0; });
  refused([](HybridMpcParams& p) { p.weight_tracking = Vector::Zero(3); });
  refused([](HybridMpcParams& p) { p.switching[0].weight = -1.0; });
  refused([](HybridMpcParams& p) { p.switching[0].after = 3; });
  refused([](HybridMpcParams& p) { p.travel[0].gate = 3; });
  refused([](HybridMpcParams& p) { p.forbidden_transitions.emplace_back(); });
}

}  // namespace control_hybrid_hybrid_mpc_test
}  // namespace fpc
