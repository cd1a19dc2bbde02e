#include "runtime/model_inbox.hpp"

#include <gtest/gtest.h>

#include "fmbpc/base/text.hpp"

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

IdentifierWord saying(const StepHeader& header, const std::string& text) {
  Event event;
  event.code = EventCode::kIdentificationFailed;
  event.text = text;
  return {header, false, {event}};
}

std::string textsOf(const std::vector<Event>& events) {
  std::vector<std::string> texts;
  for (const Event& event : events) texts.push_back(event.text);
  return join(texts, "\n");
}

TEST(ModelInbox, AnEventIsOfTheNextSampleAndIsNoWordThatTheSampleIsDoneWith) {
  ModelInbox inbox(true);
  inbox.announce(7);
  inbox.hear(saying(header(4), "one"));
  inbox.hear(saying(header(4), "two"));
  EXPECT_FALSE(inbox.complete(header(5)));
  inbox.hear({header(4), true});
  EXPECT_FALSE(inbox.complete(header(5)));  // a model is owed
  inbox.put(model("a"), header(4));
  EXPECT_TRUE(inbox.complete(header(5)));
  inbox.hear(saying(header(5), "later"));  // the identifier may be ahead
  EXPECT_EQ(textsOf(inbox.takeEvents(header(4))), "");
  EXPECT_EQ(textsOf(inbox.takeEvents(header(5))), "one\ntwo");
  EXPECT_EQ(textsOf(inbox.takeEvents(header(5))), "");
  EXPECT_EQ(textsOf(inbox.takeEvents(header(6))), "later");
}

TEST(ModelInbox, EventsOfOtherRunsAreDroppedAndOnlySoManyWait) {
  ModelInbox inbox(false);
  inbox.announce(7);
  inbox.hear(saying(header(4, 6), "a stray"));
  inbox.hear(saying(header(4), "before the reset"));
  inbox.announce(8);
  EXPECT_EQ(textsOf(inbox.takeEvents(header(0, 8))), "");
  for (int k = 0; k < 100; ++k) inbox.hear(saying(header(1, 8), "r"));
  EXPECT_EQ(inbox.takeEvents(header(1, 8)).size(), ModelInbox::kMostEvents);
}

}  // namespace loop_model_inbox_test
}  // namespace fpc
