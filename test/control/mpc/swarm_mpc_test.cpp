#include "control/mpc/swarm_mpc.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "control/mpc/fixture.hpp"

namespace fpc {
namespace control_horizon_swarm_mpc_test {

SwarmMpcParams swarmParams(std::uint64_t seed = 1, int particles = 12, int iterations = 15) {
  SwarmMpcParams params;
  params.horizon = test::horizonParams(1, 1, 5, 2, 0.05);
  params.swarm.particles = particles;
  params.swarm.iterations = iterations;
  params.swarm.seed = seed;
  return params;
}

const TsModel kModel = test::firstOrder(0.8, 0.3, 0.05);

struct Loop {
  explicit Loop(const SwarmMpcParams& params, double move = 0.5)
      : law(params,
            {Vector::Constant(1, -2.0), Vector::Constant(1, 2.0), Vector::Constant(1, move)},
            test::infoOf(kModel)),
        setpoint(test::setpointOf(test::infoOf(kModel), Vector::Ones(1))),
        plant(kModel, Vector::Zero(1), Vector::Zero(1), Vector(0)) {
    law.setModel(kModel);
  }
  template <typename Visit>
  void run(std::uint32_t samples, Visit visit) {
    law.reset(plant.measure(0));
    for (std::uint32_t k = 0; k < samples; ++k) {
      const Measurement now = plant.measure(k);
      setpoint.advance(k);
      law.step(now, setpoint, output);
      visit(now, output);
      plant.advance(output.input);
    }
  }
  std::vector<double> inputs(std::uint32_t samples) {
    std::vector<double> sent;
    run(samples,
        [&](const Measurement&, const ControllerOutput& o) { sent.push_back(o.input[0]); });
    return sent;
  }

  SwarmMpc law;
  SetpointSource setpoint;
  test::ModelPlant plant;
  ControllerOutput output;
};

TEST(SwarmMpc, ALargeSwarmFindsThePlanOfTheSolver) {
  Loop loop(swarmParams(1, 60, 150));
  NmpcParams exact;
  exact.horizon = swarmParams().horizon;
  Nmpc solver(exact,
              {Vector::Constant(1, -2.0), Vector::Constant(1, 2.0), Vector::Constant(1, 0.5)},
              test::infoOf(kModel), std::make_unique<FuzzySampleModel>(kModel));
  ControllerOutput expected;
  solver.reset(loop.plant.measure(0));
  loop.run(8, [&](const Measurement& now, const ControllerOutput& output) {
    solver.step(now, loop.setpoint, expected);
    EXPECT_NEAR(output.input[0], expected.input[0], 1e-3) << now.header.step;
  });
}

TEST(SwarmMpc, NoSampleIsWorseThanGoingOnWithThePlanBefore) {
  Loop loop(swarmParams(3, 2, 0));  // two random plans: the one before wins most of the time
  Vector before = Vector::Zero(2);
  int kept = 0;
  loop.run(40, [&](const Measurement& now, const ControllerOutput&) {
    const Vector shifted = (Vector(2) << before[1], before[1]).finished();
    kept += now.header.step > 0 && loop.law.plan() == shifted ? 1 : 0;
    before = loop.law.plan();
  });
  EXPECT_GT(kept, 10);
}

TEST(SwarmMpc, SameSeedSameBitsAnotherSeedOtherInputs) {
  const auto first = Loop(swarmParams(7)).inputs(30), second = Loop(swarmParams(7)).inputs(30);
  EXPECT_EQ(first, second);
  EXPECT_NE(first, Loop(swarmParams(8)).inputs(30));
}

TEST(SwarmMpc, ASampleDoesNotDependOnTheRandomNumbersOfEarlierOnes) {
  // The swarm of a sample comes from seed and step: after a restart it is the same again.
  Loop all(swarmParams(5)), late(swarmParams(5));
  const Measurement at = all.plant.measure(0);
  Measurement now = at;
  now.header.step = 9;
  all.inputs(4);
  all.setpoint.reset();
  for (Loop* loop : {&all, &late}) {
    loop->law.reset(now);
    loop->setpoint.advance(9);
    loop->law.step(now, loop->setpoint, loop->output);
  }
  EXPECT_EQ(all.output.input[0], late.output.input[0]);
}

TEST(SwarmMpc, LimitsOfInputsAndMovesHoldAtEverySample) {
  Loop loop(swarmParams(), 0.1);
  bool at_move = false;
  loop.run(40, [&](const Measurement& now, const ControllerOutput& output) {
    const double move = std::abs(output.input[0] - now.input_applied[0]);
    EXPECT_LE(move, 0.1 * (1.0 + 1e-12));
    EXPECT_LE(std::abs(output.input[0]), 2.0);
    at_move = at_move || move > 0.0999;
  });
  EXPECT_TRUE(at_move);
}

TEST(SwarmMpc, NeedsAModel) { EXPECT_TRUE(Loop(swarmParams()).law.needsModel()); }

TEST(SwarmMpc, AHorizonWithinWhichTheInputDoesNotActIsSaidOnce) {
  TsModel late = kModel;
  late.submodels[0].regressors.back().lag = 1;
  for (const int steps : {1, 2}) {
    SwarmMpcParams params = swarmParams();
    params.horizon = test::horizonParams(1, 1, steps, 1, 0.05);
    Loop loop(params);
    loop.law.setModel(late);
    int said = 0;
    loop.run(3, [&](const Measurement&, const ControllerOutput& o) {
      said += o.events.has(EventCode::kHorizonTooShort);
    });
    EXPECT_EQ(said, steps == 1 ? 1 : 0) << "where the plan begins anew";
  }
}

}  // namespace control_horizon_swarm_mpc_test
}  // namespace fpc
