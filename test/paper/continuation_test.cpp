// What continuation finds on the shipped plants without being told where: the folds and the Hopf
// point of the stirred tank (blazic2007, section 2) with and without its sampled
// compensator, the hump of the biomass in the activated-sludge plant.
#include "analysis/continuation.hpp"

#include <gtest/gtest.h>

#include "runtime/plant_continuation.hpp"

namespace fpc {
namespace paper_continuation_test {

std::vector<SpecialPoint> allOf(const std::vector<Branch>& branches, SpecialKind kind) {
  std::vector<SpecialPoint> found;
  for (const auto& branch : branches)
    for (const auto& point : branch.special)
      if (point.kind == kind) found.push_back(point);
  return found;
}

std::vector<Branch> trace(const std::string& name, const PlantParameters& parameters,
                          double sample_time_s) {
  const std::shared_ptr<Plant> plant = makePlant(name, parameters);
  const PlantContinuation set = plantContinuation(plant, 0, sample_time_s, -1.0, -1.0);
  return continueBranches(set.problem, set.params);
}

TEST(CstrContinuation, FindsBothFoldsAndTheHopfPoint) {
  const auto branches = trace("cstr", {}, 6.0);
  ASSERT_EQ(branches.size(), 1U);
  const auto folds = allOf(branches, SpecialKind::kFold);
  ASSERT_EQ(folds.size(), 2U);
  const auto& high = folds[folds[0].parameter > folds[1].parameter ? 0 : 1];
  const auto& low = folds[folds[0].parameter > folds[1].parameter ? 1 : 0];
  EXPECT_NEAR(high.parameter, 119.713, 0.005);
  EXPECT_NEAR(high.state[0], 0.2578, 1e-4);
  EXPECT_NEAR(low.parameter, 11.101, 0.005);
  EXPECT_NEAR(low.state[0], 0.9198, 1e-4);
  const auto hopf = allOf(branches, SpecialKind::kHopf);
  ASSERT_GE(hopf.size(), 1U);
  bool found = false;
  for (const auto& point : hopf)
    found = found || (std::abs(point.parameter - 111.77) <= 0.02 &&
                      std::abs(point.state[0] - 0.1403) <= 0.0003);
  EXPECT_TRUE(found);
}

TEST(CstrContinuation, TheSampledCompensatorMovesTheHopfPoint) {
  const auto hopf = allOf(trace("cstr", {{"compensator_gain", 3.0}}, 6.0), SpecialKind::kHopf);
  bool found = false;
  for (const auto& point : hopf)
    found = found || (std::abs(point.parameter - 116.45) <= 0.03 &&
                      std::abs(point.state[0] - 0.1787) <= 0.0005);
  EXPECT_TRUE(found);
}

TEST(SludgeContinuation, FindsTheHumpOfTheBiomass) {
  const auto branches = trace("activated_sludge", {}, 720.0);
  std::vector<SpecialPoint> humps;
  for (const auto& point : allOf(branches, SpecialKind::kTurningPoint))
    if (point.turning_state == 1 && point.parameter > 200.0) humps.push_back(point);
  ASSERT_EQ(humps.size(), 1U);
  EXPECT_GT(humps[0].parameter, 800.0);
  EXPECT_LT(humps[0].parameter, 1300.0);
  EXPECT_NEAR(humps[0].state[1], 2128.0, 1.0);
}

}  // namespace paper_continuation_test
}  // namespace fpc
