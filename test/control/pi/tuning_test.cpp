#include "control/pi/tuning.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "model/column_model.hpp"

namespace fpc {
namespace control_pi_tuning_test {

TEST(PiTuning, ByTheRuleIsThatOnPaper) {
  const PiTuning pi = imcTuning({2.0, 10.0, 4.0}, 6.0);
  EXPECT_DOUBLE_EQ(pi.kp, 12.0 / (2.0 * 8.0));
  EXPECT_DOUBLE_EQ(pi.integral_time_min, 12.0);
  EXPECT_THROW(imcTuning({2.0, 10.0, 4.0}, 0.0), InputError);
}

TEST(PiTuning, ByTheRuleComesNearThePrintedSettingsOfTheColumn) {
  const auto m = test::columnMatrix();
  const PiTuning top = imcTuning(m[0][0], 3.9), bottom = imcTuning(m[1][1], 8.0);
  EXPECT_NEAR(top.kp, 0.3054, 0.0005);
  EXPECT_NEAR(top.integral_time_min, 17.25, 0.06);
  EXPECT_NEAR(bottom.kp, -0.0863, 0.0005);
  EXPECT_NEAR(bottom.integral_time_min, 15.98, 0.1);
}

TEST(StepExperiment, MeasuresAFirstOrderAnswerAsOnPaper) {
  // Ti = tau cancels the lag: the loop is a lag of tau / (K kp) = 2 min
  StepExperiment experiment({1.0, 10.0, 0.0}, {60.0, 0.01});
  const StepQuality quality = experiment.run({5.0, 10.0});
  EXPECT_NEAR(quality.rise_time, 2.0 * std::log(9.0), 0.03);
  EXPECT_NEAR(quality.settling_time, 2.0 * std::log(50.0), 0.05);
  EXPECT_NEAR(quality.iae, 2.0, 0.02);
  EXPECT_LT(quality.overshoot, 1e-3);
}

TEST(StepExperiment, CallsARunawayInfinite) {
  StepExperiment experiment({12.8, 16.7, 1.0}, {});
  EXPECT_EQ(experiment.run({100.0, 1.0}).cost(), std::numeric_limits<double>::infinity());
}

/// Best of a fine grid around a point: kp and Ti by 0.25 % and 0.5 % steps.
double gridOptimum(const Fopdt& element, TuningCost cost, const PiTuning& centre) {
  StepExperiment experiment(element, {});
  double best = std::numeric_limits<double>::infinity();
  for (int i = -20; i <= 20; ++i)
    for (int j = -16; j <= 16; ++j) {
      const StepQuality q =
          experiment.run({centre.kp * (1 + 0.0025 * i), centre.integral_time_min * (1 + 0.01 * j)});
      best = std::min(best, cost == TuningCost::kIae ? q.iae : q.cost());
    }
  return best;
}

TEST(SwarmTuning, ComesWithinOnePercentOfAGridOptimumForBothLoopsAndCosts) {
  const auto m = test::columnMatrix();
  const auto check = [&](std::size_t i, TuningCost cost, const PiTuning& known) {
    StepExperiment experiment(m[i][i], {});
    const PiTuning found = swarmTuning(m[i][i], cost);
    const StepQuality quality = experiment.run(found);
    const double reached = cost == TuningCost::kIae ? quality.iae : quality.cost();
    const double grid = gridOptimum(m[i][i], cost, known);
    std::cout << "loop " << i + 1 << (cost == TuningCost::kIae ? " IAE " : " J ") << reached
              << " at (" << found.kp << ", " << found.integral_time_min << "), grid " << grid
              << " near (" << known.kp << ", " << known.integral_time_min << ")\n";
    EXPECT_LT(reached, 1.01 * grid);
  };
  check(0, TuningCost::kStepTimes, {0.6345, 20.9});
  check(1, TuningCost::kStepTimes, {-0.1267, 16.2});
  check(0, TuningCost::kIae, {0.758, 16.7});
  check(1, TuningCost::kIae, {-0.148, 14.8});
}

}  // namespace control_pi_tuning_test
}  // namespace fpc
