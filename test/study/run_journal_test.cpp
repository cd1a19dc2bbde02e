#include "study/run_journal.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "runtime/loop_fixture.hpp"

namespace fpc {
namespace study_run_journal_test {

using RunJournalFile = LoopFolder;

TEST_F(RunJournalFile, HoldsEveryWholeLine) {
  RunJournal journal(path("state.json"), "study 1");
  EXPECT_FALSE(journal.exists());
  EXPECT_TRUE(journal.read().empty());
  journal.begin();
  journal.add(3, "{\"cost\":1.5}");
  journal.add(0, "b c");
  const std::map<std::size_t, std::string> two{{0, "b c"}, {3, "{\"cost\":1.5}"}};
  EXPECT_EQ(RunJournal(path("state.json"), "study 1").read(), two);
  std::ofstream(path("state.json.runs"), std::ios::app) << "12 {\"co";  // a crash in the middle
  EXPECT_EQ(RunJournal(path("state.json"), "study 1").read(), two);
  journal.begin();
  EXPECT_TRUE(journal.exists());
  EXPECT_TRUE(journal.read().empty());
  journal.remove();
  EXPECT_FALSE(journal.exists());
}

TEST_F(RunJournalFile, OfAnotherStudyIsRefused) {
  RunJournal(path("state.json"), "study 1").begin();
  expectWords(errorOf([&] { RunJournal(path("state.json"), "study 2").read(); }),
              {"state.json.runs", "of this study"});
}

TEST_F(RunJournalFile, WithoutAStateFileNothingIsKept) {
  RunJournal none("", "study 1");
  none.begin();
  none.add(1, "text");
  EXPECT_TRUE(none.read().empty());
  EXPECT_FALSE(none.exists());
}

}  // namespace study_run_journal_test
}  // namespace fpc
