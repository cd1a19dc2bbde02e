#include "runtime/health.hpp"

#include <gtest/gtest.h>

#include "runtime/optimizer_watch.hpp"

namespace fpc {
namespace loop_health_test {

const std::vector<std::string> kNobody;
Health health(LoopMode mode, const std::string& words = "") {
  return {mode, EventCode::kNone, words, {}};
}

TEST(Health, OnlyAutomaticAndFinishedAreInOrder) {
  for (int mode = 1; mode <= 9; ++mode) {
    const auto m = static_cast<LoopMode>(mode);
    const bool fine = m == LoopMode::kAutomatic || m == LoopMode::kFinished;
    EXPECT_EQ(levelOf(m) == 0, fine) << wordOf(m);
    EXPECT_STRNE(wordOf(m), "unknown");
  }
}

TEST(Health, ASentenceNamesStateReasonAndWhoIsMissing) {
  EXPECT_EQ(sentence({LoopMode::kStalled,
                      EventCode::kNoAction,
                      "no action for sample 17",
                      {"/clp_optimizer"}}),
            "stalled: no action for sample 17 (missing: /clp_optimizer)");
}

TEST(Hysteresis, AChangeForTheWorseShowsAtOnceAndOneForTheBetterOnlyIfItLasts) {
  Hysteresis shown(1.0);
  EXPECT_EQ(shown.show(health(LoopMode::kAutomatic), 0.0).mode, LoopMode::kAutomatic);
  EXPECT_EQ(shown.show(health(LoopMode::kStalled), 0.1).mode, LoopMode::kStalled);
  EXPECT_EQ(shown.show(health(LoopMode::kAutomatic), 0.2).mode, LoopMode::kStalled);
  EXPECT_EQ(shown.show(health(LoopMode::kStalled), 0.9).mode, LoopMode::kStalled);
  EXPECT_EQ(shown.show(health(LoopMode::kAutomatic), 1.0).mode, LoopMode::kStalled);
  EXPECT_EQ(shown.show(health(LoopMode::kAutomatic), 1.9).mode, LoopMode::kStalled);
  EXPECT_EQ(shown.show(health(LoopMode::kAutomatic), 2.0).mode, LoopMode::kAutomatic);
  EXPECT_EQ(shown.show(health(LoopMode::kHeld), 2.1).mode, LoopMode::kHeld);
  EXPECT_EQ(shown.show(health(LoopMode::kFinished), 2.2).mode, LoopMode::kFinished);
}

TEST(RingWatch, WhoIsSilentForLongerThanABeatIsMissing) {
  RingWatch watch({"/a", "/b"});
  EXPECT_EQ(watch.silent(0.0), (std::vector<std::string>{"/a", "/b"}));
  watch.hear("/a", health(LoopMode::kAutomatic), 10.0);
  watch.hear("/b", health(LoopMode::kAutomatic), 10.0);
  watch.hear("/stranger", health(LoopMode::kFailed), 10.0);
  EXPECT_EQ(watch.silent(11.0), kNobody);
  EXPECT_EQ(watch.worst(11.0).mode, LoopMode::kAutomatic);
  watch.hear("/b", health(LoopMode::kAutomatic), 11.5);
  EXPECT_EQ(watch.silent(11.5), (std::vector<std::string>{"/a"}));
}

TEST(RingWatch, SaysWhoIsWorstAndWhy) {
  RingWatch watch({"/a", "/b", "/c"});
  watch.hear("/a", health(LoopMode::kManual, "manual"), 0.0);
  EXPECT_EQ(watch.worst(0.1).mode, LoopMode::kManual);
  watch.hear("/b", {LoopMode::kStalled, EventCode::kNoAction, "no answer", {"/c"}}, 0.0);
  watch.hear("/c", health(LoopMode::kFinished), 0.0);
  const Health worst = watch.worst(0.1);
  EXPECT_EQ(worst.words, "/b: no answer");
  EXPECT_EQ(worst.missing, (std::vector<std::string>{"/c"}));
}

TEST(RingWatch, WhoIsStartingWhileTheRunGoesOnDoesNotDoItsPart) {
  RingWatch watch({"/a", "/b", "/c"});
  watch.begin(10.0);
  watch.hear("/a", health(LoopMode::kManual, "manual"), 11.6);
  watch.hear(
      "/b",
      {LoopMode::kStarting, EventCode::kWaiting, "waiting for the first measurement", {"/plant"}},
      11.5);
  EXPECT_EQ(watch.worst(12.4).mode, LoopMode::kManual);  // it may not have said yet that it began
  watch.hear(
      "/b",
      {LoopMode::kStarting, EventCode::kWaiting, "waiting for the first measurement", {"/plant"}},
      12.6);
  const Health worst = watch.worst(12.6);
  EXPECT_EQ(worst.mode, LoopMode::kStarting);
  EXPECT_EQ(worst.words, "/b: starting: waiting for the first measurement");
  EXPECT_EQ(worst.missing, (std::vector<std::string>{"/plant"}));
  watch.hear("/c", health(LoopMode::kHeld, "held"), 12.6);
  EXPECT_EQ(watch.worst(12.6).mode, LoopMode::kStarting);  // worse than one that is held
  watch.hear("/c", health(LoopMode::kStalled, "no answer"), 12.7);
  EXPECT_EQ(watch.worst(12.7).mode, LoopMode::kStalled);
}

StepHeader sample(std::uint32_t step) { return {0, 7, step}; }

TEST(OptimizerWatch, RealtimeTakesOverWithinTheSampleAndTrustsTheOptimizerAgainOnceItAnswers) {
  OptimizerWatch watch(Pace::kRealtime, 0.2, 1.0);
  EXPECT_FALSE(watch.asked(sample(0), 0.0));
  watch.answered(sample(0));
  EXPECT_FALSE(watch.mustTakeOver(0.19));
  EXPECT_FALSE(watch.asked(sample(1), 0.2));
  EXPECT_FALSE(watch.mustTakeOver(0.29));
  EXPECT_TRUE(watch.mustTakeOver(0.31));
  EXPECT_FALSE(watch.mustTakeOver(0.35));  // once per sample
  EXPECT_TRUE(watch.degraded());
  EXPECT_TRUE(watch.asked(sample(2), 0.4));  // at once from now on
  watch.answered(sample(1));                 // too late: not for this sample
  EXPECT_TRUE(watch.asked(sample(3), 0.6));
  watch.answered(sample(3));
  EXPECT_TRUE(watch.degraded());
  EXPECT_FALSE(watch.asked(sample(4), 0.8));
  EXPECT_FALSE(watch.degraded());
  EXPECT_EQ(watch.takenOver(), 3U);
}

TEST(OptimizerWatch, PacedWaitsForTheStatedTimeAndLockstepForEver) {
  OptimizerWatch paced(Pace::kPaced, 0.2, 1.0), lockstep(Pace::kLockstep, 0.0, 1.0);
  paced.asked(sample(0), 0.0);
  lockstep.asked(sample(0), 0.0);
  double now = 0.0;
  for (int look = 1; look < 10; ++look) EXPECT_FALSE(paced.mustTakeOver(now = paced.deadline()));
  EXPECT_FALSE(paced.mustTakeOver(0.99));
  EXPECT_NEAR(paced.deadline(), 1.0, 1e-9);
  EXPECT_TRUE(paced.mustTakeOver(paced.deadline()));
  EXPECT_FALSE(lockstep.mustTakeOver(1e9));
  EXPECT_FALSE(lockstep.waitsInVain(0.9));
  EXPECT_TRUE(lockstep.waitsInVain(1.1));  // and says so
}

// What held this process up for a minute held the optimizer up too: its answer is still to come.
TEST(OptimizerWatch, PacedCountsTheTimeInWhichItRunsItself) {
  OptimizerWatch paced(Pace::kPaced, 0.2, 1.0);
  paced.asked(sample(0), 0.0);
  EXPECT_FALSE(paced.mustTakeOver(60.0));
  EXPECT_NEAR(paced.deadline(), 60.1, 1e-9);
  paced.answered(sample(0));
  EXPECT_FALSE(paced.mustTakeOver(120.0));
  EXPECT_FALSE(paced.asked(sample(1), 121.0)) << "trusted as before";
}

}  // namespace loop_health_test
}  // namespace fpc
