// The adaptive loops must not touch the heap once they run.
#include "allocation_counter.hpp"

#include <gtest/gtest.h>

#include "control/pi/adaptive_fixture.hpp"

namespace fpc {
namespace control_pi_adaptive_pi_allocation_test {

TEST(AdaptivePiMemory, StepDoesNotAllocate) {
  if (!testing::AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  test::AdaptiveColumn column(test::adaptiveParams());
  column.wander(200);  // past the start: it learns and retunes
  Measurement now = column.measure();
  now.input_applied = column.output.input;
  std::size_t count = 0;
  {
    testing::AllocationCounter counter;
    for (int k = 0; k < 200; ++k) {
      ++now.header.step;
      now.outputs[0] = 0.01 * (k % 7);
      column.law.step(now, column.setpoint, column.output);
    }
    count = counter.count();
  }
  EXPECT_EQ(count, 0U);
}

}  // namespace control_pi_adaptive_pi_allocation_test
}  // namespace fpc
