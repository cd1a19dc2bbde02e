// The controllers that plan by simulation do not allocate once they run.
// The allocation counter replaces malloc: this file is a test program of its own.
#include "allocation_counter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "control/mpc/fixture.hpp"

namespace fpc {
namespace control_horizon_allocation_test {

std::size_t allocations(Controller& law, const PlantInfo& info) {
  SetpointSource setpoint = test::setpointOf(info, Vector::Ones(1));
  ControllerOutput output;
  Measurement now = test::tankSample(0, 1.0, 1.0);
  setpoint.advance(0);
  law.reset(now);
  law.step(now, setpoint, output);
  std::size_t total = 0;
  for (std::uint32_t k = 1; k < 60; ++k) {
    now.header.step = k;
    now.outputs[0] = 1.5 + std::sin(0.3 * k);
    now.input_applied = output.input;
    setpoint.advance(k);
    const testing::AllocationCounter counter;
    if (k % 20 == 0) law.reset(now);
    law.step(now, setpoint, output);
    total += counter.count();
  }
  return total;
}

TEST(HorizonAllocation, NonlinearPlansAllocateNothing) {
  if (!testing::AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  for (const int moves : {1, 3}) {
    Nmpc law(test::tankParams(8, moves), test::tankLimits(0.3), test::tankInfo(),
             std::make_unique<test::Tank>());
    EXPECT_EQ(allocations(law, test::tankInfo()), 0U) << moves;
  }
}

TEST(HorizonAllocation, AnObserverAllocatesNothing) {
  if (!testing::AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  for (const bool at_inputs : {false, true}) {
    NmpcParams params = test::tankParams(8, 2);
    params.horizon.observe = true;
    params.horizon.observer.noise_std = params.horizon.observer.disturbance_std =
        Vector::Constant(1, 0.1);
    if (at_inputs) params.horizon.observer.input_std = Vector::Constant(1, 0.1);
    Nmpc law(params, test::tankLimits(0.3), test::tankInfo(), std::make_unique<test::Tank>());
    EXPECT_EQ(allocations(law, test::tankInfo()), 0U) << at_inputs;
  }
}

TEST(HorizonAllocation, SwarmsAllocateNothing) {
  if (!testing::AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  const TsModel model = test::firstOrder(0.8, 0.3, 0.05);
  SwarmMpcParams params;
  params.horizon = test::horizonParams(1, 1, 5, 2, 0.05);
  params.swarm.particles = params.swarm.iterations = 10;
  SwarmMpc law(params, test::tankLimits(0.3), test::infoOf(model));
  law.setModel(model);
  EXPECT_EQ(allocations(law, test::infoOf(model)), 0U);
}

}  // namespace control_horizon_allocation_test
}  // namespace fpc
