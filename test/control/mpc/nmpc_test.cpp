#include "control/mpc/nmpc.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "control/mpc/fixture.hpp"
#include "fmbpc/base/input_error.hpp"
#include "optim/qp.hpp"
#include "runtime/session.hpp"

namespace fpc {
namespace control_horizon_nmpc_test {

using Eigen::Index;

const auto kNothing = [](std::uint32_t, double, double, const ControllerOutput&) {};

/// The plan of the linear case as a quadratic programme in absolute inputs, from y and u(k-1).
QpProblem linearProgramme(const Matrix& A, const Matrix& B, const Vector& c, const Vector& y,
                          const Vector& before, const Vector& setpoint, const HorizonParams& params,
                          const InputLimits& limits) {
  const Index P = params.horizon_steps, M = params.move_steps, n = 2 * M;
  Matrix effect = Matrix::Zero(2 * P, n);
  Vector free(2 * P);
  Vector state = y;
  Matrix power = Matrix::Zero(2, n);  // d y(k+i) / d plan
  for (Index i = 0; i < P; ++i) {
    state = (A * state + c).eval();
    power = (A * power).eval();
    power.middleCols(2 * std::min(i, M - 1), 2) += B;
    free.segment(2 * i, 2) = state - setpoint;
    effect.middleRows(2 * i, 2) = power;
  }
  QpProblem qp(n, 2 * (M - 1));
  Matrix moves = Matrix::Identity(n, n);
  for (Index j = 2; j < n; ++j) moves(j, j - 2) = -1.0;
  Vector first = Vector::Zero(n);
  first.head(2) = before;
  const double weight = params.weight_move[0];
  qp.H = effect.transpose() * effect + weight * moves.transpose() * moves;
  qp.g = effect.transpose() * free - weight * moves.transpose() * first;
  qp.x_lower = limits.lower.replicate(M, 1);
  qp.x_upper = limits.upper.replicate(M, 1);
  qp.x_lower.head(2) = qp.x_lower.head(2).cwiseMax(before - limits.move);
  qp.x_upper.head(2) = qp.x_upper.head(2).cwiseMin(before + limits.move);
  qp.A = moves.bottomRows(n - 2);
  qp.a_upper = limits.move.replicate(M - 1, 1);
  qp.a_lower = -qp.a_upper;
  return qp;
}

TEST(Nmpc, OnALinearPlantThePlanIsThatOfTheQuadraticProgramme) {
  int limited = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 generator(seed);
    std::uniform_real_distribution<double> draw(-1.0, 1.0);
    const auto vector = [&] {
      return Vector(Vector::NullaryExpr(2, [&] { return draw(generator); }));
    };
    const Matrix A = 0.45 * Matrix::NullaryExpr(2, 2, [&] { return draw(generator); });
    const Matrix B = Matrix::NullaryExpr(2, 2, [&] { return draw(generator); });
    const Vector c = 0.1 * vector(), y = vector(), setpoint = 2.0 * vector();
    const Vector before = vector();
    NmpcParams params;
    params.horizon = test::horizonParams(2, 2, 1 + static_cast<int>(seed % 6) + 2, 3, 0.1);
    const InputLimits limits{Vector::Constant(2, -1.5), Vector::Constant(2, 1.5),
                             Vector::Constant(2, seed % 2 == 0 ? 0.4 : kInfinity)};
    const TsModel model = test::twoByTwo(A, B, c);
    const PlantInfo info = test::infoOf(model);
    Nmpc law(params, limits, info, std::make_unique<FuzzySampleModel>(model));
    SetpointSource source = test::setpointOf(info, setpoint);
    Measurement now;
    now.outputs = y;
    now.disturbances = Vector(0);
    now.input_applied = before;
    ControllerOutput output;
    source.advance(0);
    law.reset(now);
    law.step(now, source, output);
    ASSERT_TRUE(output.ok);
    const QpProblem qp = linearProgramme(A, B, c, y, before, setpoint, params.horizon, limits);
    QpSolver solver(qp.g.size(), qp.a_lower.size());
    const QpResult& expected = solver.solve(qp);
    ASSERT_TRUE(expected.usable());
    limited += expected.active > 0 ? 1 : 0;
    EXPECT_LE((law.plan() - expected.x).lpNorm<Eigen::Infinity>(), 1e-6);
    EXPECT_EQ(output.input, Vector(law.plan().head(2)));
  }
  EXPECT_GE(limited, 10);  // limits were in the way
}

TEST(Nmpc, ReachesALevelWithoutOffsetUnderALeakItDoesNotKnow) {
  for (const int steps : {1, 3, 10}) {
    SCOPED_TRACE(steps);
    Nmpc law(test::tankParams(steps, 1), test::tankLimits(), test::tankInfo(),
             std::make_unique<test::Tank>());
    EXPECT_NEAR(test::runTank(law, test::Tank(0.4), 1.0, 2.0, 200, kNothing), 2.0, 1e-9);
  }
}

// A horizon of one sample meets y_r(k + 1 + lead) = w - 0.8^(1 + lead) (w - y) exactly.
TEST(Nmpc, AimsAtALaterReferenceWithALead) {
  for (const int lead : {0, 3}) {
    NmpcParams params = test::tankParams(1, 1, 0.0);
    params.horizon.reference_pole = Vector::Constant(1, 0.8);
    params.horizon.reference_lead_steps = lead;
    Nmpc law(params, test::tankLimits(), test::tankInfo(), std::make_unique<test::Tank>());
    const double level = test::runTank(law, test::Tank(), 1.0, 1.1, 1, kNothing);
    EXPECT_NEAR(level, 1.1 - 0.1 * std::pow(0.8, 1 + lead), 1e-7) << lead;
  }
}

// With the input held at 0 the tank would run empty, where its model ends.
TEST(Nmpc, AnInputThatLeadsOutOfTheModelIsNoTrap) {
  Nmpc law(test::tankParams(10, 2), test::tankLimits(), test::tankInfo(),
           std::make_unique<test::Tank>());
  const auto solved = [](std::uint32_t, double, double, const ControllerOutput& output) {
    EXPECT_TRUE(output.ok);
  };
  EXPECT_NEAR(test::runTank(law, test::Tank(), 1.0, 2.0, 200, solved, 0.0), 2.0, 1e-9);
}

TEST(Nmpc, LimitsOfInputsAndMovesHoldAtEverySample) {
  Nmpc law(test::tankParams(8, 3, 0.0), test::tankLimits(0.2), test::tankInfo(),
           std::make_unique<test::Tank>());
  bool at_bound = false, at_move = false;
  test::runTank(law, test::Tank(), 1.0, 5.0, 60,
                [&](std::uint32_t, double, double before, const ControllerOutput& output) {
                  const double u = output.input[0];
                  EXPECT_GE(u, 0.0);
                  EXPECT_LE(u, 3.0);
                  EXPECT_LE(std::abs(u - before), 0.2 * (1.0 + 1e-12));
                  at_bound = at_bound || u == 3.0;
                  at_move = at_move || std::abs(u - before) > 0.2 * (1.0 - 1e-12);
                });
  EXPECT_TRUE(at_bound);
  EXPECT_TRUE(at_move);
}

TEST(Nmpc, BoundWinsWhereItConflictsWithTheMoveLimit) {
  Nmpc law(test::tankParams(), test::tankLimits(0.2), test::tankInfo(),
           std::make_unique<test::Tank>());
  test::runTank(
      law, test::Tank(), 1.0, 5.0, 1,
      [](std::uint32_t, double, double, const ControllerOutput& output) {
        EXPECT_EQ(output.input[0], 3.0);
      },
      7.0);
}

/// Refuses to predict from a given sample on.
class Failing final : public SampleModel {
 public:
  explicit Failing(const bool& fails) : fails_(fails) {}
  Index stateSize() const override { return 1; }
  Index outputState(Index) const override { return 0; }
  void rest(VectorRef outputs, VectorRef, VectorRef, Eigen::Ref<Vector> state) override {
    state = outputs;
  }
  bool step(VectorRef input, VectorRef disturbances, Eigen::Ref<Vector> state) override {
    return !fails_ && tank_.step(input, disturbances, state);
  }

 private:
  const bool& fails_;
  test::Tank tank_;
};

TEST(Nmpc, WhereThePredictionFailsTheLastPlanGoesOnInsideTheLimits) {
  bool fails = false;
  Nmpc law(test::tankParams(8, 3, 0.1), test::tankLimits(0.2), test::tankInfo(),
           std::make_unique<Failing>(fails));
  test::runTank(law, test::Tank(), 1.0, 2.0, 12,
                [&](std::uint32_t k, double, double before, const ControllerOutput& output) {
                  EXPECT_EQ(output.ok, k < 3 || k > 5);
                  EXPECT_TRUE(output.input.allFinite());
                  EXPECT_LE(std::abs(output.input[0] - before), 0.2 * (1.0 + 1e-12));
                  if (!output.ok) {
                    EXPECT_EQ(output.source, ActionSource::kClipped);
                    EXPECT_TRUE(output.events.has(EventCode::kPlanNotFound));
                  }
                  fails = k >= 2 && k < 5;
                });
}

TEST(Nmpc, ASampleThatIsNotFiniteHoldsTheInputAndTheNextOneStartsAnew) {
  ControllerSession session(
      std::make_unique<Nmpc>(test::tankParams(), test::tankLimits(), test::tankInfo(),
                             std::make_unique<test::Tank>()),
      SetpointParams{Vector::Constant(1, 2.0), {}, {}, {}, {}, {}}, test::tankLimits(),
      Vector::Ones(1), [] {
        PlantInfo info = test::tankInfo();
        info.header.time_ns = 1000000000;
        return info;
      }());
  const auto sample = [](std::uint32_t step, double level, double input) {
    Measurement m = test::tankSample(step, level, input);
    m.header = {1000000000 + std::int64_t{1000000000} * step, 1, step};
    return m;
  };
  ASSERT_EQ(session.receive(sample(0, 1.0, 1.0)), Receipt::kAnswered);
  const double sent = session.answer().base.input[0];
  session.receive(sample(1, std::nan(""), sent));
  EXPECT_EQ(session.answer().base.input[0], sent);
  EXPECT_EQ(session.answer().base.source, ActionSource::kHeld);
  session.receive(sample(2, 1.3, sent));
  EXPECT_EQ(session.answer().base.source, ActionSource::kBase);
  EXPECT_EQ(session.controller().signals()[0].second, 0.0);  // h_correction
}

TEST(Nmpc, TheSameSamplesGiveTheSameBits) {
  std::vector<double> first, second;
  for (auto* inputs : {&first, &second}) {
    Nmpc law(test::tankParams(), test::tankLimits(), test::tankInfo(),
             std::make_unique<test::Tank>());
    test::runTank(law, test::Tank(0.2), 1.0, 2.0, 50,
                  [&](std::uint32_t, double, double, const ControllerOutput& output) {
                    inputs->push_back(output.input[0]);
                  });
  }
  EXPECT_EQ(first, second);
}

/// y(k+1) = 0.8 y(k) + b2 u(k-1) + b1 u(k): with b1 = 0 an input moves nothing within one sample.
TsModel lateModel(double b1) {
  TsModel model = test::firstOrder(0.8, 0.3, 0.0);
  OutputModel& output = model.submodels[0];
  output.regressors = {
      {SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, 0}, {SignalKind::kInput, 0, 1}};
  output.rules[0].coefficients = (Vector(3) << 0.8, b1, 0.3).finished();
  return model;
}

bool isTooShort(const TsModel& model, int steps, const InputLimits& limits) {
  NmpcParams params = test::tankParams(steps, 1);
  const PlantInfo info = test::infoOf(model);
  Nmpc law(params, limits, info, std::make_unique<FuzzySampleModel>(model));
  SetpointSource source = test::setpointOf(info, Vector::Ones(1));
  ControllerOutput output;
  const Measurement now = test::tankSample(0, 0.5, 1.0);
  source.advance(0);
  law.reset(now);
  law.step(now, source, output);
  EXPECT_TRUE(output.ok);
  return output.events.has(EventCode::kHorizonTooShort);
}

TEST(Nmpc, AHorizonWithinWhichAnInputHardlyActsIsSaid) {
  const InputLimits limits = test::tankLimits();
  EXPECT_TRUE(isTooShort(lateModel(0.0), 1, limits));
  EXPECT_TRUE(isTooShort(lateModel(0.01), 1, limits)) << "a thirtieth of the whole";
  EXPECT_FALSE(isTooShort(lateModel(0.1), 1, limits));
  EXPECT_FALSE(isTooShort(lateModel(0.0), 2, limits));
  const InputLimits fixed{Vector::Ones(1), Vector::Ones(1), Vector::Ones(1)};
  EXPECT_FALSE(isTooShort(lateModel(0.0), 1, fixed)) << "an input that cannot move anyway";
}

TEST(Nmpc, ParametersAreCheckedByName) {
  const auto refuses = [](const NmpcParams& params, const std::string& field) {
    try {
      params.validate(1, 1);
      ADD_FAILURE() << field;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(field), std::string::npos) << e.what();
    }
  };
  NmpcParams steps = test::tankParams(), moves = steps, output = steps, move = steps, pole = steps;
  steps.horizon.horizon_steps = 0;
  moves.horizon.move_steps = 9;
  output.horizon.weight_output[0] = 0.0;
  move.horizon.weight_move[0] = -1.0;
  pole.horizon.reference_pole[0] = 1.0;
  refuses(steps, "horizon_steps");
  refuses(moves, "move_steps");
  refuses(output, "weight_output");
  refuses(move, "weight_move");
  refuses(pole, "reference_pole");
}

}  // namespace control_horizon_nmpc_test
}  // namespace fpc
