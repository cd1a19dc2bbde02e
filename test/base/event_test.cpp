#include "fmbpc/base/event.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "fmbpc/base/input_error.hpp"
#include "paths.hpp"

namespace fpc {
namespace base_event_test {

TEST(Events, EveryCodeHasOneNameAndTellsWhatToDo) {
  std::set<std::string> names;
  for (const EventKind& kind : eventKinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_EQ(eventCode(kind.name), kind.code);
    for (const char* words : {kind.name, kind.cause, kind.consequence, kind.remedy})
      EXPECT_STRNE(words, "") << kind.name;
  }
  EXPECT_THROW(eventCode("signal_lost"), InputError);
  EXPECT_EQ(eventCodeOr("signal_lost", EventCode::kNote), EventCode::kNote);
}

TEST(Events, ThePageIsWrittenByTheTool) {
  std::ifstream file(sourceDir() + "/docs/events.md");
  std::ostringstream page;
  page << file.rdbuf();
  EXPECT_EQ(page.str(), eventsPage()) << "fmbpc events > docs/events.md";
}

TEST(Events, AListCountsByCodeSignalAndText) {
  EventList list;
  for (std::uint32_t k : {3U, 5U, 9U})
    list.add(eventOf({EventCode::kSignalFrozen, "is frozen", "x"}, k));
  EXPECT_FALSE(list.add(eventOf({EventCode::kSignalFrozen, "is frozen", "x"}, 12)));
  EXPECT_TRUE(list.add(eventOf({EventCode::kSignalFrozen, "is frozen", "s"}, 12)));
  ASSERT_EQ(list.all().size(), 2U);
  const Event& x = list.all()[0];
  EXPECT_EQ(x.first, 3U);
  EXPECT_EQ(x.last, 12U);
  EXPECT_EQ(x.count, 4U);
  EXPECT_EQ(x.severity(), Severity::kWarning);
}

TEST(Events, AFloodOfTextsIsBounded) {
  EventList list;
  list.add(eventOf(Notice{EventCode::kInputHeld}, 0));
  for (std::uint32_t k = 0; k < 1000; ++k)
    list.add(eventOf({EventCode::kCommandRefused, std::to_string(k).c_str()}, k));
  EXPECT_EQ(list.all().size(), 1 + EventList::kMostTexts);
  EXPECT_EQ(list.all().back().count, 1000 - EventList::kMostTexts + 1);
  EXPECT_EQ(list.all().back().last, 999U);
}

TEST(Events, WhatIsSaidOfASampleIsBoundedAndHasTheCausesWords) {
  Notices said;
  for (std::size_t i = 0; i < 2 * Notices::kMost; ++i) said.add({EventCode::kLawFailed});
  EXPECT_EQ(said.end() - said.begin(), static_cast<std::ptrdiff_t>(Notices::kMost));
  const Event event = eventOf(*said.begin(), 7);
  EXPECT_EQ(event.text, kindOf(EventCode::kLawFailed).cause);
  EXPECT_EQ(event.first, 7U);
  EXPECT_EQ(eventOf(EventCode::kNote, "two\nlines").text, "two lines");
  EXPECT_EQ(worstOf({eventOf(EventCode::kNote), event}).code, EventCode::kLawFailed);
  EXPECT_EQ(worstOf({}).code, EventCode::kNone);
}

}  // namespace base_event_test
}  // namespace fpc
