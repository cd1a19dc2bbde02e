#include "runtime/first_answers.hpp"

#include <gtest/gtest.h>

namespace fpc {
namespace loop_first_answers_test {

constexpr double kOver = Comeback::kConnecting;
StepHeader sample(std::uint32_t step, std::uint64_t run = 7) { return {0, run, step}; }

TEST(Comeback, CountsForSomeSecondsFromTheFirstAnswerOfANodeThatWasNotThereAtTheStart) {
  Comeback comeback;
  EXPECT_FALSE(comeback.lately(100.0));
  comeback.answered(sample(40), 100.0);
  EXPECT_TRUE(comeback.lately(100.0));
  comeback.answered(sample(41), 104.0);  // does not begin anew
  EXPECT_TRUE(comeback.lately(100.0 + 0.99 * kOver));
  EXPECT_FALSE(comeback.lately(100.0 + kOver));
  comeback.answered(sample(0, 8), 200.0);  // a reset
  comeback.answered(sample(1, 8), 200.0);
  EXPECT_FALSE(comeback.lately(200.0));
}

TEST(Comeback, IsNoneForANodeThatAnsweredSampleZero) {
  Comeback comeback;
  comeback.answered(sample(0), 100.0);
  comeback.answered(sample(1), 100.1);
  EXPECT_FALSE(comeback.lately(100.1));
}

TEST(FirstAnswers, AreKeptInOrderWhileTheyMayBeMissedAndNotLonger) {
  Comeback comeback;
  FirstAnswers<int> answers;
  answers.add(7, -1, comeback, 99.0);
  EXPECT_TRUE(answers.all().empty());  // it has not come back
  comeback.answered(sample(40), 100.0);
  for (int k = 40; k < 43; ++k) answers.add(7, k, comeback, 100.0 + 0.1 * (k - 40));
  EXPECT_EQ(answers.all(), (std::vector<int>{40, 41, 42}));
  answers.add(7, 43, comeback, 100.0 + kOver);
  EXPECT_TRUE(answers.all().empty());
}

TEST(FirstAnswers, OfAnotherRunTakeThePlaceOfThoseBefore) {
  Comeback comeback;
  FirstAnswers<int> answers;
  comeback.answered(sample(40), 100.0);
  answers.add(7, 40, comeback, 100.0);
  answers.add(8, 0, comeback, 101.0);
  answers.add(8, 1, comeback, 101.1);
  EXPECT_EQ(answers.all(), (std::vector<int>{0, 1}));
}

TEST(FirstAnswers, AreOnlySoMany) {
  Comeback comeback;
  FirstAnswers<int> answers;
  comeback.answered(sample(1), 0.0);
  for (int k = 0; k < 5000; ++k) answers.add(7, k, comeback, 0.1);
  ASSERT_EQ(answers.all().size(), FirstAnswers<int>::kMost);
  EXPECT_EQ(answers.all().front(), 0);  // without a hole from the first one on
  EXPECT_EQ(answers.all().back(), static_cast<int>(FirstAnswers<int>::kMost) - 1);
}

TEST(Audience, ThoseWhoActHearNothingOldAndWithAnUnknownPlantOnlyTheRecorderDoes) {
  const Audience known{{"/a/plant"}, {"/a/optimizer", "/a/controller"}, "/a/loop_recorder"};
  for (const char* name : {"/a/loop_recorder", "/record_1", "/b/plant"})
    EXPECT_TRUE(known.mayHearOld(name)) << name;
  for (const char* name : {"/a/plant", "/a/optimizer", "/a/controller"})
    EXPECT_FALSE(known.mayHearOld(name)) << name;
  const Audience unknown{{}, {"/a/controller"}, "/a/loop_recorder"};
  EXPECT_TRUE(unknown.mayHearOld("/a/loop_recorder"));
  for (const char* name : {"/a/controller", "/somebody", "/record_1"})
    EXPECT_FALSE(unknown.mayHearOld(name)) << name;
}

}  // namespace loop_first_answers_test
}  // namespace fpc
