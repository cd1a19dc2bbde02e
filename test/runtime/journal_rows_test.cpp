#include "runtime/journal_rows.hpp"

#include <gtest/gtest.h>

#include "runtime/loop_fixture.hpp"
#include "runtime/record_journal.hpp"
#include "runtime/run.hpp"
#include "runtime/trajectory.hpp"

namespace fpc {
namespace loop_journal_rows_test {

using Cells = std::vector<double>;

class JournalRowsTest : public LoopFolder {
 protected:
  JournalRowsTest()
      : loop_(readLoop("asp_case1_clp", {{"sampling.duration_h", "4"}})),
        layout_(recordLayout(loop_)),
        record_(runLoop(loop_)) {
    Trajectory table(loop_, layout_, [this](const Cells& row) { rows_.push_back(row); });
    names_ = table.names();
    for (const SampleRecord& sample : record_.samples) table.add(sample);
  }

  void append(RecordJournal& journal, std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k)
      journal.put(static_cast<std::uint32_t>(k), record_.samples[k]);
    journal.flush();
  }
  // The rows of trajectory.csv from one sample on, before another one.
  Cells expected(std::size_t from, std::size_t to) const {
    Cells cells;
    for (std::size_t k = from; k < to; ++k)
      cells.insert(cells.end(), rows_[k].begin(), rows_[k].end());
    return cells;
  }
  // Bit for bit: a missing value is no number, which equals nothing.
  static void expectSame(const Cells& got, const Cells& expected) {
    ASSERT_EQ(got.size(), expected.size());
    for (std::size_t i = 0; i < got.size(); ++i)
      EXPECT_TRUE(got[i] == expected[i] || (got[i] != got[i] && expected[i] != expected[i]))
          << i << ": " << got[i] << " " << expected[i];
  }

  LoopFile loop_;
  RecordLayout layout_;
  RunRecord record_;
  std::vector<Cells> rows_;
  std::vector<std::string> names_;
};

TEST_F(JournalRowsTest, WhoReadsWhileItIsWrittenGetsTheRowsOfTheTrajectory) {
  RecordJournal journal;
  journal.open(path("journal"), layout_, 7);
  append(journal, 0, 9);
  const JournalRows reader(path("journal"));
  EXPECT_EQ(reader.runId(), 7U);
  EXPECT_EQ(reader.names(), names_);
  const JournalRows::Rows first = reader.read(0, 1000);
  EXPECT_EQ(first.first, 0U);
  const std::size_t there = first.cells.size() / names_.size();
  EXPECT_EQ(there, 8U);  // the ninth lacks the input that acts after it
  expectSame(first.cells, expected(0, there));
  append(journal, 9, record_.samples.size());
  const JournalRows::Rows rest = reader.read(8, 1000);
  EXPECT_EQ(rest.first, 8U);
  expectSame(rest.cells, expected(8, rows_.size()));
}

TEST_F(JournalRowsTest, OfVeryManyAsManyAsAreAskedFor) {
  RecordJournal journal;
  journal.open(path("journal"), layout_, 7);
  append(journal, 0, record_.samples.size());
  const JournalRows reader(path("journal"));
  expectSame(reader.read(3, 4).cells, expected(3, 7));
  EXPECT_TRUE(reader.read(1000, 4).cells.empty());
}

TEST_F(JournalRowsTest, RowsEndBeforeASampleOfWhichMoreMayCome) {
  SampleRecord part = record_.samples[2];
  part.has_action = false;
  RecordJournal journal;
  journal.open(path("journal"), layout_, 1);
  append(journal, 0, 2);
  journal.put(2, part);
  const JournalRows rows(path("journal"));
  const auto count = [&] { return rows.read(0, 100).cells.size() / rows.names().size(); };
  EXPECT_EQ(count(), 1U);  // the input of the newest is not known yet
  append(journal, 3, 4);
  EXPECT_EQ(count(), 3U);
  for (std::uint32_t k = 4; k < 4 + JournalRows::kSettled; ++k) journal.put(k, part);
  EXPECT_EQ(count(), 3U);
  journal.put(4 + JournalRows::kSettled, part);
  EXPECT_EQ(count(), 4U);
  EXPECT_EQ(rows.read(0, 2).cells.size(), 2 * rows.names().size());
}

TEST_F(JournalRowsTest, APartOfAnEndlessRunBeginsWhereItBegins) {
  loop_ = readLoop("asp_case1_clp", {{"sampling.duration_h", "0"},
                                     {"disturbance.source", "constant"},
                                     {"setpoint.schedule", "[]"}});
  layout_ = recordLayout(loop_);
  RecordJournal journal;
  journal.open(path("journal"), layout_, 7);
  append(journal, 0, 9);
  journal.beginNextPart();
  append(journal, 9, 15);
  const JournalRows::Rows rows = JournalRows(path("journal")).read(2, 1000);
  EXPECT_EQ(rows.first, 9U);
  EXPECT_EQ(rows.cells.size(), 5 * names_.size());
}

TEST_F(JournalRowsTest, WhatIsNoJournalAndAnotherRunAreErrors) {
  write("letter", std::string(500, 'a'));
  expectWords(errorOf([&] { JournalRows(path("letter")); }), {"letter", "a journal"});
  expectWords(errorOf([&] { JournalRows(path("nothing")); }), {"nothing", "a journal"});
  {
    RecordJournal journal;
    journal.open(path("journal"), layout_, 7);
    append(journal, 0, 3);
  }
  const JournalRows reader(path("journal"));
  std::filesystem::remove(path("journal"));
  RecordJournal journal;
  journal.open(path("journal"), layout_, 8);
  append(journal, 0, 3);
  expectWords(errorOf([&] { reader.read(0, 10); }), {"journal", "the run that it held before"});
}

}  // namespace loop_journal_rows_test
}  // namespace fpc
