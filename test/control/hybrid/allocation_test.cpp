// The search of the hybrid law does not allocate, nor does a sample within a block.
// The allocation counter replaces malloc: this file is a test program of its own.
#include "allocation_counter.hpp"

#include <gtest/gtest.h>

#include <random>

#include "control/hybrid/fixture.hpp"
#include "fmbpc/base/option.hpp"

namespace fpc {
namespace control_hybrid_allocation_test {

TEST(HybridAllocation, DecisionsAndSamplesAllocateNothing) {
  if (!testing::AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> T(15.0, 66.0);
  for (const BranchBound bound : {BranchBound::kCost, BranchBound::kReach}) {
    const auto mpc = test::batchReactorMpc(test::batchReactorParams(45, bound));
    PlantInfo info = test::batchReactorInfo();
    SetpointParams asked;
    asked.initial = Eigen::Vector2d(40.0, 20.0);
    SetpointSource setpoint(asked, {"T", "Tw"}, SampleClock(10.0, 1.0));
    Measurement now;
    now.outputs = Eigen::Vector2d(20.0, 20.0);
    now.disturbances = Vector(0);
    now.input_applied = Eigen::Vector3d(0.0, 0.0, 1.0);
    ControllerOutput output;
    setpoint.advance(0);
    mpc->reset(now);
    mpc->step(now, setpoint, output);
    for (std::uint32_t k = 1; k < 200; ++k) {
      now.outputs[0] = T(generator);
      now.header.step = k;
      setpoint.advance(k);
      const testing::AllocationCounter counter;
      if (k % 50 == 0) mpc->reset(now);
      mpc->step(now, setpoint, output);
      mpc->makeSendable(output.input);
      ASSERT_EQ(counter.count(), 0U) << wordOf(bound) << ", sample " << k;
      now.input_applied = output.input;
    }
  }
}

}  // namespace control_hybrid_allocation_test
}  // namespace fpc
