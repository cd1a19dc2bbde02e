// The fuzzy optimal law must not touch the heap once it runs.
#include "allocation_counter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "control/fuzzy_lq/fixture.hpp"
#include "control/steady_law.hpp"

namespace fpc {
namespace control_optimal_allocation_test {

using Steady = test::SteadyLaw<FuzzyOptimalLaw, FuzzyOptimalParams>;

TEST(FuzzyOptimalMemory, StepDoesNotAllocate) {
  if (!testing::AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  std::mt19937_64 generator(1);
  const TsModel model = test::sharedRandomModel(generator, {3, 3, 2, 5, 3, 1, 3, 3});
  for (const FuzzyOptimalDisturbance disturbance :
       {FuzzyOptimalDisturbance::kInside, FuzzyOptimalDisturbance::kOutside,
        FuzzyOptimalDisturbance::kNone})
    for (const bool preview : {false, true}) {
      FuzzyOptimalParams params = test::optimalParams(3, 3, 20, 3, 0.1);
      params.disturbance = disturbance;
      params.preview = preview;
      params.prediction_steps = 42;
      EXPECT_EQ(Steady(params, model).allocations(200), 0U);
    }
}

TEST(FuzzyOptimalMemory, TakingOverHoldingAndStartingAgainDoNotAllocate) {
  if (!testing::AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  std::mt19937_64 generator(2);
  const TsModel model = test::dominantModel(generator, 2);
  Steady loop(test::optimalParams(2, 2, 5, 1, 0.1), model);
  for (int i = 0; i < 3; ++i) {
    FuzzyOptimalTuning tuning = loop.law.tuning();
    tuning.horizon_steps += 3;
    loop.law.retune(tuning);
    EXPECT_EQ(loop.allocations(3), 0U);
    loop.law.setModel(test::mistaken(model, generator, 0.1));
    EXPECT_EQ(loop.allocations(3), 0U);
  }
  testing::AllocationCounter counter;
  loop.law.reset(loop.now);
  EXPECT_EQ(counter.count(), 0U);
  EXPECT_EQ(loop.allocations(3), 0U);
  loop.now.input_applied[0] = std::nan("");
  EXPECT_EQ(loop.allocations(3), 0U);
  EXPECT_FALSE(loop.output.ok);
}

}  // namespace control_optimal_allocation_test
}  // namespace fpc
