#include "runtime/record_journal.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "runtime/full_disk.hpp"
#include "runtime/journal_reader.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace loop_record_journal_test {

class RecordJournalTest : public LoopFolder {
 protected:
  RecordJournalTest()
      : loop_(readLoop("asp_case1_clp", {{"sampling.duration_h", "4"}})),
        layout_(recordLayout(loop_)),
        record_(runLoop(loop_)) {}

  void append(RecordJournal& journal, std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k)
      journal.put(static_cast<std::uint32_t>(k), record_.samples[k]);
  }
  std::string textOf(const RunRecord& record) {
    const std::string folder = path("files");
    writeRun(loop_, record, summarize(loop_, record, 1.0), folder);
    std::ifstream csv(folder + "/trajectory.csv"), summary(folder + "/summary.json");
    std::ostringstream all;
    all << csv.rdbuf() << summary.rdbuf();
    return all.str();
  }

  LoopFile loop_;
  RecordLayout layout_;
  RunRecord record_;
};

TEST_F(RecordJournalTest, TheFilesOfAJournalAreThoseOfTheRunToTheLastBit) {
  RecordJournal journal;
  EXPECT_EQ(journal.open(path("journal"), layout_, 1), 0U);
  append(journal, 0, record_.samples.size());
  journal.close();
  const RunRecord back = readJournal(path("journal"), layout_);
  EXPECT_TRUE(back.complete);
  ASSERT_EQ(back.samples.size(), 21U);
  EXPECT_EQ(textOf(back), textOf(record_));
}

TEST_F(RecordJournalTest, AProcessThatCameBackGoesOnWhereItWas) {
  {
    RecordJournal journal;
    journal.open(path("journal"), layout_, 1);
    append(journal, 0, 9);
  }
  std::ofstream(path("journal"), std::ios::app | std::ios::binary) << "half an ent";  // kill -9
  RecordJournal journal;
  ASSERT_EQ(journal.open(path("journal"), layout_, 1), 9U);
  EXPECT_EQ(journalRun(path("journal"), layout_), 1U);
  append(journal, 9, record_.samples.size());
  journal.close();
  EXPECT_EQ(textOf(readJournal(path("journal"), layout_)), textOf(record_));
}

TEST_F(RecordJournalTest, WhatAnotherRunHasWrittenIsNeverOverwritten) {
  RecordJournal journal;
  journal.open(path("journal"), layout_, 1);
  append(journal, 0, 3);
  expectWords(errorOf([&] { journal.open(path("journal"), layout_, 2); }),
              {"journal", "an empty one"});
  LoopFile other = loop_;
  other.resolved += "# changed\n";
  expectWords(errorOf([&] { journal.open(path("journal"), recordLayout(other), 1); }),
              {"journal", "an empty one"});
  write("letter", std::string(500, 'a'));
  expectWords(errorOf([&] { journal.open(path("letter"), layout_, 1); }), {"letter"});
  EXPECT_EQ(std::filesystem::file_size(path("letter")), 500U);
  EXPECT_EQ(readJournal(path("journal"), layout_).samples.size(), 3U);
}

TEST_F(RecordJournalTest, OneWithoutSamplesIsBegunAnew) {
  RecordJournal journal;
  journal.open(path("journal"), layout_, 1);
  EXPECT_EQ(journal.open(path("journal"), layout_, 2), 0U);
  append(journal, 0, 3);
  journal.close();
  EXPECT_EQ(journalRun(path("journal"), layout_), 2U);
  EXPECT_EQ(readJournal(path("journal"), layout_).samples.size(), 3U);
}

TEST_F(RecordJournalTest, ItTellsOfWhichLoopAndRunItIs) {
  write("letter", std::string(500, 'a'));
  EXPECT_FALSE(journalLabel(path("letter")).has_value());
  EXPECT_FALSE(journalLabel(path("nothing")).has_value());
  RecordJournal journal;
  journal.open(path("journal"), layout_, 7);
  EXPECT_TRUE(journalLabel(path("journal"))->empty);
  append(journal, 0, 2);
  const auto label = journalLabel(path("journal"));
  EXPECT_EQ(label->run_id, 7U);
  EXPECT_EQ(label->loop, "asp_case1_clp");
  EXPECT_FALSE(label->empty);
  EXPECT_EQ(parseLoop(label->text, label->loop).resolved, loop_.resolved);
}

TEST_F(RecordJournalTest, SamplesThatCouldNotBeKeptLeaveTheirPlacesEmpty) {
  RecordJournal journal;
  journal.start(layout_, 1);
  constexpr auto kMost = static_cast<std::uint32_t>(RecordJournal::kMostUnwritten);
  for (std::uint32_t k = 0; k < kMost + 3; ++k) journal.put(k, record_.samples[0]);
  EXPECT_EQ(journal.lost(), 3U);  // the disk comes back after them
  journal.open(path("journal"), layout_, 1);
  journal.put(kMost + 3, record_.samples[4]);
  journal.close();
  const RunRecord back = readJournal(path("journal"), layout_);
  ASSERT_EQ(back.samples.size(), RecordJournal::kMostUnwritten + 4);
  EXPECT_FALSE(back.samples[RecordJournal::kMostUnwritten + 2].has_measurement);
  EXPECT_EQ(back.samples.back().measurement.header.step, 4U);
}

TEST_F(RecordJournalTest, ASampleIsAmendedInItsPlaceAndWhatNeverCameHasNoValues) {
  SampleRecord part = record_.samples[2];
  part.has_action = part.has_report = false;
  RecordJournal journal;
  journal.open(path("journal"), layout_, 1);
  append(journal, 0, 1);
  append(journal, 3, 5);  // before 1 and 2
  journal.put(2, part);
  EXPECT_EQ(journal.samples(), 5U);
  RunRecord back = readJournal(path("journal"), layout_);
  EXPECT_FALSE(back.samples[1].has_measurement || back.samples[2].has_action);
  EXPECT_TRUE(back.samples[2].has_measurement && back.samples[3].has_action);
  append(journal, 2, 3);
  append(journal, 1, 2);
  append(journal, 5, record_.samples.size());
  journal.close();
  EXPECT_EQ(textOf(readJournal(path("journal"), layout_)), textOf(record_));
}

TEST_F(RecordJournalTest, WhatADiskWithoutRoomKeepsIsAmendedToo) {
  SampleRecord part = record_.samples[1];
  part.has_action = false;
  RecordJournal journal;
  journal.start(layout_, 1);
  append(journal, 0, 1);
  journal.put(1, part);
  append(journal, 1, 2);
  EXPECT_EQ(journal.unwritten(), 2U);
  journal.open(path("journal"), layout_, 1);
  journal.close();
  EXPECT_TRUE(readJournal(path("journal"), layout_).samples[1].has_action);
}

TEST_F(RecordJournalTest, IsOnTheDiskItselfOnceASecond) {
  RecordJournal journal;
  journal.open(path("journal"), layout_, 1);
  append(journal, 0, 1);
  EXPECT_TRUE(journal.sync(10.0));
  append(journal, 1, 2);
  EXPECT_FALSE(journal.sync(10.9));
  EXPECT_TRUE(journal.sync(11.0));
  EXPECT_FALSE(journal.sync(13.0));  // nothing new
}

TEST_F(RecordJournalTest, APartOfAnEndlessRunBeginsWhereTheOneBeforeEnded) {
  layout_.samples = 0;
  {
    RecordJournal journal;
    journal.open(path("journal"), layout_, 1);
    append(journal, 0, 9);
    journal.beginNextPart();
    EXPECT_TRUE(journalLabel(path("journal"))->empty);
    append(journal, 9, 12);
  }
  RecordJournal journal;
  EXPECT_EQ(journal.open(path("journal"), layout_, 1), 3U);
  EXPECT_EQ(journal.firstStep(), 9U);
  JournalReader reader(path("journal"), layout_);
  EXPECT_EQ(reader.firstStep(), 9U);
  SampleRecord sample;
  ASSERT_TRUE(reader.next(sample));
  EXPECT_EQ(sample.measurement.header.step, 9U);
}

TEST_F(RecordJournalTest, WhenItBeganOutlivesTheProcess) {
  double began{};
  {
    RecordJournal journal;
    journal.open(path("journal"), layout_, 1);
    append(journal, 0, 2);
    began = journal.beganAt();
    EXPECT_GT(began, 0.0);
  }
  RecordJournal journal;
  journal.open(path("journal"), layout_, 1);
  EXPECT_EQ(journal.beganAt(), began);
}

TEST_F(RecordJournalTest, OnlyOneWritesAtATimeAndAFolderThatIsNotThereIsSaidAtOnce) {
  RecordJournal first, second;
  first.open(path("journal"), layout_, 1);
  expectWords(errorOf([&] { second.open(path("journal"), layout_, 2); }),
              {"journal", "another loop is running"});
  expectWords(errorOf([&] { second.open(path("nowhere/journal"), layout_, 2); }),
              {"nowhere/journal", "can be written"});
  append(first, 0, 2);
  first.close();
  EXPECT_EQ(readJournal(path("journal"), layout_).samples.size(), 2U);
}

TEST_F(RecordJournalTest, AFullDiskIsSaidAndWhatItRefusedIsWrittenOnceThereIsRoom) {
  RecordJournal journal;
  journal.open(path("journal"), layout_, 1);
  {
    const FullDisk full(1000);
    append(journal, 0, record_.samples.size());
    expectWords(journal.problem(), {"journal cannot be written"});
  }
  journal.flush();
  EXPECT_EQ(journal.problem(), "");
  EXPECT_EQ(journal.lost(), 0U);
  journal.close();
  EXPECT_EQ(textOf(readJournal(path("journal"), layout_)), textOf(record_));
}

}  // namespace loop_record_journal_test
}  // namespace fpc
