// Advice on a first-order model, where every figure is known on paper.
#include "analysis/horizon_advisor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace analysis_horizon_advisor_test {

/// y(k+1) = 0.9 y(k) + 0.1 u(k)
LinearModel lag() {
  LinearModel model{AffineModel(1, 1, 1), Matrix::Zero(1, 1)};
  model.affine.A << 0.9;
  model.affine.B << 0.1;
  model.affine.C << 1.0;
  return model;
}

TEST(HorizonFigures, OfDeadbeatControlAreKnownOnPaper) {
  LoopLaw law;
  law.coincidence_steps = 1;
  const HorizonFigures figures = horizonFigures(lag(), law);
  EXPECT_TRUE(figures.stable);
  EXPECT_NEAR(figures.radius, 0.0, 1e-15);
  // u = -10 n - 9 xi, xi(k+1) = -n(k): std 10 and 9 together
  EXPECT_NEAR(figures.noise_gain, std::sqrt(181.0), 1e-12);
  EXPECT_EQ(figures.settling, 1);
}

TEST(HorizonAdvice, TakesTheShortestHorizonThatIsQuietAndTheSlowestReferenceInTime) {
  LoopLaw law;
  const HorizonLimits limits{3.0, 60};
  const HorizonAdvice advice = adviseHorizon(lag(), law, limits);
  ASSERT_TRUE(advice.found);
  EXPECT_LE(advice.figures.noise_gain, 3.0);
  law.coincidence_steps = advice.coincidence_steps - 1;
  EXPECT_GT(horizonFigures(lag(), law).noise_gain, 3.0);
  law.coincidence_steps = advice.coincidence_steps;
  EXPECT_LE(settlingSamples(lag(), law, advice.reference_pole), 60);
  EXPECT_GT(settlingSamples(lag(), law, advice.reference_pole + 0.01), 60);
  EXPECT_GE(advice.reasons.size(), 3U);
}

TEST(HorizonAdvice, SaysWhyThereIsNone) {
  const HorizonAdvice loud = adviseHorizon(lag(), {}, {0.1, 60});
  EXPECT_FALSE(loud.found);
  EXPECT_NE(loud.reasons.back().find("noise"), std::string::npos);
  const HorizonAdvice slow = adviseHorizon(lag(), {}, {2.0, 2});
  EXPECT_FALSE(slow.found);
  EXPECT_NE(slow.reasons.back().find("settles"), std::string::npos);
  EXPECT_THROW(adviseHorizon(lag(), {}, {0.0, 2}), InputError);
}

}  // namespace analysis_horizon_advisor_test
}  // namespace fpc
