#include "runtime/identifier_duty.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace fpc {
namespace loop_identifier_duty_test {

StepHeader header(std::uint32_t step, std::uint64_t run = 7) { return {0, run, step}; }

IdentificationJob job(const std::string& source) {
  IdentificationJob made;
  made.source = source;
  return made;
}

/// "5" and "5 with a model", of run 7.
std::vector<std::string> text(const IdentifierDuty::Words& words) {
  std::vector<std::string> all;
  for (const IdentifierWord& word : words)
    all.push_back((word.header.run_id == 7 ? "" : "other run, ") +
                  std::to_string(word.header.step) + (word.model ? " with a model" : ""));
  return all;
}

using Texts = std::vector<std::string>;

TEST(IdentifierDuty, NothingIsSaidBeforeTheFirstSample) {
  EXPECT_TRUE(IdentifierDuty(true).again().empty());
  EXPECT_FALSE(IdentifierDuty(true).next());
}

TEST(IdentifierDuty, ASampleThatAsksForNothingIsDoneWithAtOnceAndSaidAgainWhenItComesAgain) {
  for (const bool in_step : {true, false}) {
    IdentifierDuty duty(in_step);
    duty.take(header(0), {});
    EXPECT_TRUE(duty.again().empty());
    EXPECT_EQ(text(duty.settle()), Texts{"0"});
    EXPECT_EQ(text(duty.again()), Texts{"0"});
    duty.take(header(1), {});
    duty.handOver(header(1));  // learned online
    EXPECT_EQ(text(duty.settle()), Texts{"1 with a model"});
    EXPECT_EQ(text(duty.again()), Texts{"1 with a model"});
    duty.take(header(2), {});
    EXPECT_EQ(text(duty.settle()), Texts{"2"});
  }
}

TEST(IdentifierDuty, AModelOfNoSampleOrOfAnEarlierOneIsNoMatterOfAWord) {
  IdentifierDuty duty(true);
  duty.handOver({});
  duty.take(header(3), {});
  duty.handOver({});
  duty.handOver(header(2));
  duty.handOver(header(3, 6));
  EXPECT_EQ(text(duty.settle()), Texts{"3"});
}

TEST(IdentifierDuty, InStepASampleWaitsForItsJobOtherwiseNot) {
  for (const bool in_step : {true, false}) {
    IdentifierDuty duty(in_step);
    duty.take(header(4), job("a"));
    ASSERT_TRUE(duty.next());
    EXPECT_FALSE(duty.next());  // once
    duty.begin();
    EXPECT_TRUE(duty.working());
    EXPECT_EQ(duty.jobFrom().step, 4U);
    EXPECT_EQ(text(duty.settle()), in_step ? Texts{} : Texts{"4"});
    EXPECT_EQ(text(duty.again()), in_step ? Texts{} : Texts{"4"});
    duty.handOver(header(4));
    EXPECT_EQ(text(duty.finish()), Texts{"4 with a model"});
    EXPECT_FALSE(duty.working());
    EXPECT_EQ(text(duty.again()), Texts{"4 with a model"});
  }
}

TEST(IdentifierDuty, OutOfStepTheWordOfAJobIsThatOfItsSampleAndThatOfThePresentFollows) {
  IdentifierDuty duty(false);
  duty.take(header(4), job("a"));
  duty.next();
  duty.begin();
  duty.settle();
  duty.take(header(5), {});
  EXPECT_EQ(text(duty.settle()), Texts{"5"});
  duty.handOver(header(4));
  EXPECT_EQ(text(duty.finish()), (Texts{"4 with a model", "5"}));
}

// A goal comes between two samples; the next one learns online while the job is at work.
TEST(IdentifierDuty, AJobThatFailsDoesNotTakeTheModelOfTheSampleAfterIt) {
  IdentifierDuty duty(true);
  duty.take(header(4), {});
  duty.settle();
  duty.begin();
  duty.take(header(5), {});
  duty.handOver(header(5));
  EXPECT_TRUE(duty.settle().empty());
  EXPECT_EQ(text(duty.finish()), (Texts{"4", "5 with a model"}));
}

TEST(IdentifierDuty, AJobAndOnlineLearningOfOneSampleAreOneWord) {
  IdentifierDuty duty(true);
  duty.take(header(4), job("a"));
  duty.handOver(header(4));
  duty.next();
  duty.begin();
  duty.settle();
  EXPECT_EQ(text(duty.finish()), Texts{"4 with a model"});  // though the job failed
}

TEST(IdentifierDuty, AModelThatWasAnnouncedIsNotAnnouncedAgainWithTheJob) {
  IdentifierDuty duty(true);
  duty.take(header(4), {});
  duty.handOver(header(4));
  duty.settle();
  duty.begin();
  EXPECT_EQ(text(duty.finish()), Texts{"4"});
}

TEST(IdentifierDuty, AJobThatCannotBeginWaitsForTheNextSampleAndALaterOneTakesItsPlace) {
  IdentifierDuty duty(false);
  duty.take(header(0), {});
  duty.begin();  // a goal
  duty.take(header(1), job("a"));
  EXPECT_FALSE(duty.next());
  duty.take(header(2), {});
  EXPECT_FALSE(duty.next());
  duty.take(header(3), job("b"));
  EXPECT_FALSE(duty.next());
  duty.finish();
  duty.take(header(4), {});
  const auto due = duty.next();
  ASSERT_TRUE(due);
  EXPECT_EQ(due->source, "b");
  duty.begin();
  EXPECT_EQ(duty.jobFrom().step, 4U);
}

TEST(IdentifierDuty, AJobOfARunBeforeIsNoWordOfTheSampleOfTheSameNumber) {
  IdentifierDuty duty(true);
  duty.take(header(0, 6), job("a"));
  duty.next();
  duty.begin();
  duty.take(header(0), {});
  EXPECT_TRUE(duty.settle().empty());
  duty.handOver(header(0, 6));
  EXPECT_EQ(text(duty.finish()), (Texts{"other run, 0 with a model", "0"}));
}

/// What a controller in step asks: after each end of waiting every sample up to the present one has
/// had a word, and every model that a word announces was handed over.
TEST(IdentifierDuty, InStepARingNeverWaitsForAModelThatDoesNotCome) {
  std::mt19937 dice(12);
  const auto toss = [&] { return dice() % 3 == 0; };
  for (int round = 0; round < 200; ++round) {
    IdentifierDuty duty(true);
    ModelInbox inbox(true);
    inbox.announce(7);
    const auto hear = [&](const IdentifierDuty::Words& words) {
      for (const IdentifierWord& word : words) inbox.hear(word);
    };
    const auto give = [&](const StepHeader& from) {
      inbox.put({}, from);
      duty.handOver(from);
    };
    for (std::uint32_t k = 0; k < 20; ++k) {
      ASSERT_TRUE(inbox.complete(header(k))) << "round " << round << ", sample " << k;
      inbox.take(header(k));
      duty.take(header(k), toss() ? std::optional(job("a")) : std::nullopt);
      if (toss()) give(header(k));
      if (duty.next()) duty.begin();
      hear(duty.settle());
      if (duty.working()) {
        if (toss()) give(duty.jobFrom());
        hear(duty.finish());
      }
      if (toss()) duty.begin();  // somebody's goal, at work when the next sample comes
    }
  }
}

}  // namespace loop_identifier_duty_test
}  // namespace fpc
