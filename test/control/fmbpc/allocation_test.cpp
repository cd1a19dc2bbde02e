// The law must not touch the heap once it runs.
#include "allocation_counter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "control/fmbpc/law_fixture.hpp"
#include "fuzzy/multivariate_fixture.hpp"

namespace fpc {
namespace control_fmbpc_allocation_test {

struct Steady {
  Steady(FmbpcParams params, const TsModel& model)
      : info(test::infoOf(model)),
        plant(model, Vector::Zero(count(info.outputs)), Vector::Zero(count(info.inputs)),
              Vector::Zero(count(info.disturbances))),
        setpoint(test::setpointOf(info, Vector::Ones(count(info.outputs)))),
        law(std::move(params), test::wideLimits(count(info.inputs), 5.0), info) {
    law.setModel(model);
    test::start(law, plant, setpoint, 2);
    setpoint.advance(2);
    now = plant.measure(2);
    law.step(now, setpoint, output);  // sizes the output
  }
  static Eigen::Index count(const std::vector<SignalInfo>& signals) {
    return static_cast<Eigen::Index>(signals.size());
  }

  /// Allocations of the next n steps.
  std::size_t allocations(int n) {
    testing::AllocationCounter counter;
    for (int i = 0; i < n; ++i) {
      ++now.header.step;
      now.outputs[0] = std::sin(0.1 * i);
      law.step(now, setpoint, output);
    }
    return counter.count();
  }

  PlantInfo info;
  test::ModelPlant plant;
  SetpointSource setpoint;
  FmbpcLaw law;
  Measurement now;
  ControllerOutput output;
};

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
       {FmbpcRealisation::kParallel, FmbpcRealisation::kLiteral})
    for (const FmbpcAntecedent antecedent : {FmbpcAntecedent::kModel, FmbpcAntecedent::kMeasured}) {
      if (realisation == FmbpcRealisation::kLiteral && antecedent == FmbpcAntecedent::kModel)
        continue;
      FmbpcParams params;
      params.coincidence_steps = 9;
      params.reference_pole = Vector::Constant(1, 0.96);
      params.reference_lead_steps = 5;
      params.delay_steps = 5;
      params.prediction_steps = 42;
      params.realisation = realisation;
      params.antecedent = antecedent;
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
