#include "runtime/model_inbox.hpp"

#include <gtest/gtest.h>

namespace fpc {
namespace loop_model_inbox_test {

StepHeader header(std::uint32_t step, std::uint64_t run = 7) { return {0, run, step}; }
TsModel model(const std::string& name) {
  TsModel m;
  m.name = name;
  return m;
}

TEST(ModelInbox, InStepAModelOfSampleKIsUsedAtSampleKPlusOneWhateverArrivesFirst) {
  for (const bool model_first : {true, false}) {
    ModelInbox inbox(true);
    inbox.announce(7);
    EXPECT_TRUE(inbox.complete(header(0)));
    EXPECT_FALSE(inbox.complete(header(1)));
    if (model_first) inbox.put(model("a"), header(0));
    inbox.hear({header(0), true});
    EXPECT_EQ(inbox.complete(header(1)), model_first);
    EXPECT_TRUE(inbox.take(header(0)).empty());  // not before its time
    if (!model_first) inbox.put(model("a"), header(0));
    ASSERT_TRUE(inbox.complete(header(1)));
    ASSERT_EQ(inbox.take(header(1)).size(), 1U);
    EXPECT_TRUE(inbox.take(header(1)).empty());
    EXPECT_FALSE(inbox.complete(header(2)));
    inbox.hear({header(1), false});
    EXPECT_TRUE(inbox.complete(header(2)));
  }
}

TEST(ModelInbox, AModelThatWasUsedBeforeItsWordCameIsNotOwed) {
  ModelInbox inbox(true);
  inbox.announce(7);
  inbox.put(model("a"), header(0));
  ASSERT_EQ(inbox.take(header(1)).size(), 1U);  // sample 0 was answered already
  inbox.hear({header(0), true});
  EXPECT_TRUE(inbox.complete(header(1)));
}

TEST(ModelInbox, ASecondModelOfASampleIsUsedTooButNotTheSameAgain) {
  ModelInbox inbox(true);
  inbox.announce(7);
  inbox.put(model("learned"), header(4));
  ASSERT_EQ(inbox.take(header(5)).size(), 1U);
  inbox.put(model("learned"), header(4));  // its identifier came back
  EXPECT_TRUE(inbox.take(header(5)).empty());
  TsModel asked = model("learned");
  asked.source = "identified on demand";
  inbox.put(asked, header(4));
  EXPECT_EQ(inbox.take(header(5)).size(), 1U);
}

TEST(ModelInbox, AModelOfNoSampleIsUsedAtOnce) {
  ModelInbox inbox(true);
  inbox.announce(7);
  inbox.put(model("file"), {});
  EXPECT_EQ(inbox.take({}).size(), 1U);
}

TEST(ModelInbox, OutOfStepModelsAreUsedWhenTheyCome) {
  ModelInbox inbox(false);
  inbox.announce(7);
  EXPECT_TRUE(inbox.complete(header(9)));
  inbox.put(model("a"), header(9));
  EXPECT_EQ(inbox.take(header(9)).size(), 1U);
}

TEST(ModelInbox, WordsOfOtherRunsDoNotCount) {
  ModelInbox inbox(true);
  inbox.announce(7);
  inbox.hear({header(4, 9), false});
  EXPECT_FALSE(inbox.complete(header(5)));
  inbox.hear({header(4), false});
  EXPECT_TRUE(inbox.complete(header(5)));
  inbox.announce(3);
  EXPECT_FALSE(inbox.complete(header(5, 3)));
}

TEST(ModelInbox, AnIdentifierThatCameBackLaterDoesNotStallTheLoop) {
  ModelInbox inbox(true);
  inbox.announce(7);
  inbox.hear({header(10), false});  // it died after sample 9, heard 10 first
  EXPECT_TRUE(inbox.complete(header(10)));
}

TEST(ModelInbox, ARemarkIsOfTheNextSampleAndIsNoWordThatTheSampleIsDoneWith) {
  ModelInbox inbox(true);
  inbox.announce(7);
  inbox.hear({header(4), false, "one"});
  inbox.hear({header(4), false, "two"});
  EXPECT_FALSE(inbox.complete(header(5)));
  inbox.hear({header(4), true});
  EXPECT_FALSE(inbox.complete(header(5)));  // a model is owed
  inbox.put(model("a"), header(4));
  EXPECT_TRUE(inbox.complete(header(5)));
  inbox.hear({header(5), false, "later"});  // the identifier may be ahead
  EXPECT_EQ(inbox.takeRemarks(header(4)), "");
  EXPECT_EQ(inbox.takeRemarks(header(5)), "one\ntwo");
  EXPECT_EQ(inbox.takeRemarks(header(5)), "");
  EXPECT_EQ(inbox.takeRemarks(header(6)), "later");
}

TEST(ModelInbox, RemarksOfOtherRunsAreNotToldAndOnlySoManyWait) {
  ModelInbox inbox(false);
  inbox.announce(7);
  inbox.hear({header(4, 6), false, "a stray"});
  inbox.hear({header(4), false, "before the reset"});
  inbox.announce(8);
  EXPECT_EQ(inbox.takeRemarks(header(0, 8)), "");
  for (int k = 0; k < 100; ++k) inbox.hear({header(1, 8), false, "r"});
  EXPECT_EQ(inbox.takeRemarks(header(1, 8)).size(), 2 * ModelInbox::kMostRemarks - 1);
}

}  // namespace loop_model_inbox_test
}  // namespace fpc
