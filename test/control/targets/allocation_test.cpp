// The target layer does not allocate after its first step, whatever it decides. Prints how long
// twenty inputs with forty outputs take. The allocation counter replaces malloc: this file is a
// test program of its own.
#include "allocation_counter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "control/targets/layer_fixture.hpp"
#include "random/dice.hpp"

namespace fpc {
namespace control_targets_allocation_test {

using testing::AllocationCounter;

double processorSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Forty outputs of five ranks with zones of this width, twenty priced inputs, noise.
void countSteps(double width) {
  Dice dice(7);
  Matrix b(40, 20);
  for (Eigen::Index i = 0; i < b.size(); ++i)
    b.data()[i] = dice.chance(0.5) ? dice.between(-0.2, 0.2) : 0.0;
  const TsModel model = targets_test::linear(std::vector<double>(40, 0.8), b);
  TargetParams params = targets_test::paramsOf(model);
  for (std::size_t i = 0; i < params.outputs.size(); ++i) {
    params.outputs[i].lower = -width;
    params.outputs[i].upper = width;
    params.outputs[i].rank = 1 + static_cast<int>(i % 5);
  }
  for (TargetInput& input : params.inputs) input.price = dice.between(-1.0, 1.0);
  params.observer.noise_std.setConstant(0.1);
  params.observer.disturbance_std.setConstant(0.05);
  TargetLayer layer(params, targets_test::limitsOf(model), targets_test::plantOf(model));
  layer.setModel(model);
  Targets targets;
  const Vector setpoint = Vector::Zero(40);
  std::size_t allocations = 0;
  std::vector<double> seconds;
  for (std::uint32_t k = 0; k < 200; ++k) {
    Vector y(40);
    for (double& value : y) value = dice.between(-3.0, 3.0);
    const Measurement now = targets_test::measured(y, Vector::Zero(20), k);
    const double start = processorSeconds();
    const AllocationCounter counter;
    layer.step(now, setpoint, targets);
    if (k > 0) allocations += counter.count();
    if (k > 0) seconds.push_back(processorSeconds() - start);
    ASSERT_TRUE(targets.found) << k;
  }
  std::sort(seconds.begin(), seconds.end());
  std::printf("width %g: median %.0f us, slowest %.0f us of processor\n", width, seconds[100] * 1e6,
              seconds.back() * 1e6);
  if (AllocationCounter::works()) EXPECT_EQ(allocations, 0U);
}

TEST(TargetLayer, DoesNotAllocateWhereAllIsKept) { countSteps(60.0); }
TEST(TargetLayer, DoesNotAllocateWhereMuchIsGivenUp) { countSteps(1.0); }

}  // namespace control_targets_allocation_test
}  // namespace fpc
