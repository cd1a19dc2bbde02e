// The law must not touch the heap once it runs.
#include "allocation_counter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "control/steady_law.hpp"
#include "identification/multivariate_fixture.hpp"

namespace fpc {
namespace control_fmbpc_allocation_test {

using Steady = test::SteadyLaw<FmbpcLaw, FmbpcParams>;

TEST(FmbpcLawMemory, StepDoesNotAllocate) {
  if (!testing::AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  std::mt19937_64 generator(1);
  for (const FmbpcRealisation realisation :
       {FmbpcRealisation::kParallel, FmbpcRealisation::kRealigned})
    for (const bool preview : {false, true}) {
      FmbpcParams published = test::publishedParams();
      published.coincidence_steps = 180;
      published.prediction_steps = 42;
      published.realisation = realisation;
      published.preview = preview;
      EXPECT_EQ(Steady(published, test::shippedModel("fm_1")).allocations(200), 0U);

      FmbpcParams general = test::generalParams(3, 3, 20, 0.5, 0.1);
      general.prediction_steps = 42;
      general.realisation = realisation;
      general.preview = preview;
      const TsModel model = test::randomModel(generator, {3, 3, 2, 5, 3, 1, 3, 3});
      EXPECT_EQ(Steady(general, model).allocations(200), 0U);
      EXPECT_EQ(Steady(general, test::multivariate(model)).allocations(200), 0U);
    }
}

TEST(FmbpcLawMemory, PlanningAlongThePathDoesNotAllocate) {
  if (!testing::AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  std::mt19937_64 generator(1);
  FmbpcParams params = test::generalParams(2, 2, 20, 0.5, 0.1);
  params.law = FmbpcForm::kIterated;
  params.horizon_steps = 20;
  params.forecast_period_steps = 30;
  const TsModel model = test::randomModel(generator, {});
  EXPECT_EQ(Steady(params, model).allocations(100), 0U);
  params.preview = true;
  EXPECT_EQ(Steady(params, test::multivariate(model)).allocations(100), 0U);
}

TEST(FmbpcLawMemory, WithADelayTakenOutNothingIsAllocatedEither) {
  if (!testing::AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  for (const FmbpcRealisation realisation :
       {FmbpcRealisation::kParallel, FmbpcRealisation::kLiteral}) {
    FmbpcParams params;
    params.coincidence_steps = 9;
    params.reference_pole = Vector::Constant(1, 0.96);
    params.reference_lead_steps = 5;
    params.delay_steps = 5;
    params.prediction_steps = 42;
    params.realisation = realisation;
    Steady loop(params, test::shippedModel("cstr_a"));
    EXPECT_EQ(loop.allocations(200), 0U) << wordOf(realisation);
    testing::AllocationCounter counter;
    loop.law.reset(loop.now);
    EXPECT_EQ(counter.count(), 0U);
    EXPECT_EQ(loop.allocations(3), 0U);
  }
}

TEST(FmbpcLawMemory, TakingOverFromAnotherModelOfThisSizeDoesNotAllocate) {
  if (!testing::AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  for (const FmbpcRealisation realisation :
       {FmbpcRealisation::kParallel, FmbpcRealisation::kRealigned}) {
    FmbpcParams params = test::generalParams(1, 1, 5, 0.5, 0.0);
    params.realisation = realisation;
    Steady loop(params, test::firstOrder(0.9, 0.1, 0.2));
    for (int i = 0; i < 3; ++i) {
      loop.law.setModel(test::firstOrder(0.8, 0.2, 0.1 * i));
      EXPECT_EQ(loop.allocations(3), 0U);
    }
  }
}

TEST(FmbpcLawMemory, HoldingAndStartingAgainDoNotAllocateEither) {
  if (!testing::AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  Steady loop(test::generalParams(1, 1, 5, 0.5, 0.0), test::firstOrder(0.9, 0.1, 0.2));
  testing::AllocationCounter counter;
  loop.law.reset(loop.now);
  EXPECT_EQ(counter.count(), 0U);
  EXPECT_EQ(loop.allocations(3), 0U);
  loop.now.input_applied[0] = std::nan("");
  EXPECT_EQ(loop.allocations(3), 0U);
  EXPECT_FALSE(loop.output.ok);
}

}  // namespace control_fmbpc_allocation_test
}  // namespace fpc
