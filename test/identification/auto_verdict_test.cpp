#include "identification/auto_verdict.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace fpc {
namespace fuzzy_auto_verdict_test {

AutoFigures figures(double free_run, double one_step) {
  AutoFigures made;
  made.mean = made.free_run = made.confirmed = free_run;
  made.one_step = one_step;
  made.fit = 90.0;
  made.blocks.assign(4, free_run);
  made.pieces.assign(12, free_run);
  return made;
}

std::string verdict(double one_step_of_fuzzy) {
  AutoOutput found;
  found.linear = figures(1.0, 0.10);
  found.regressors = figures(0.5, one_step_of_fuzzy);
  found.fuzzy_model = true;
  decide(found);
  EXPECT_EQ(found.best, ModelKind::kRegressors);
  return found.verdict;
}

TEST(AutoVerdict, ABetterFreeRunThatIsWorseOneSampleAheadIsSaidWithBothFigures) {
  EXPECT_EQ(verdict(0.105).find("one sample ahead"), std::string::npos);
  EXPECT_NE(verdict(0.12).find("one sample ahead it is worse than linear: 0.12 beside 0.1"),
            std::string::npos);
}

ModelKind chosen(double regressors, double state, double blend, bool fuzzy_model = true) {
  AutoOutput found;
  found.linear = figures(1.0, 0.1);
  found.regressors = figures(regressors, 0.1);
  found.state = figures(state, 0.1);
  if (blend > 0.0) found.blend = figures(blend, 0.1);
  found.fuzzy_model = fuzzy_model;
  decide(found);
  return found.best;
}

TEST(AutoVerdict, TheMeanOfBothIsChosenWhereItIsLowerThanEachByThreePercent) {
  EXPECT_EQ(chosen(0.40, 0.46, 0.36), ModelKind::kBlend);
  EXPECT_EQ(chosen(0.40, 0.46, 0.39), ModelKind::kRegressors);  // 2.5 %
  EXPECT_EQ(chosen(0.40, 0.30, 0.295), ModelKind::kState);      // 1.7 % below the lower one
  EXPECT_EQ(chosen(0.40, 0.46, 0.0), ModelKind::kRegressors);   // there is none
}

TEST(AutoVerdict, AMeanThatDoesNotBeatLinearIsNotChosen) {
  EXPECT_EQ(chosen(1.2, 1.3, 0.98, false), ModelKind::kLinear);
}

TEST(AutoVerdict, ALinearModelThatBecameBetterTakesTheVerdictBack) {
  AutoOutput found;
  found.linear = figures(1.0, 0.1);
  found.regressors = figures(0.8, 0.1);
  found.fuzzy_model = true;
  decide(found);
  ASSERT_TRUE(found.beats_linear);
  found.linear = figures(0.56, 0.1);  // with other outputs among its regressors
  decide(found);
  EXPECT_FALSE(found.beats_linear);
  EXPECT_FALSE(found.fuzzy_model);
  EXPECT_EQ(found.best, ModelKind::kLinear);
}

}  // namespace fuzzy_auto_verdict_test
}  // namespace fpc
