#include "fmbpc/loop/record_journal.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <sstream>

#include "fmbpc/loop/report.hpp"
#include "fmbpc/loop/run.hpp"
#include "loop/loop_fixture.hpp"

namespace fpc {
namespace loop_record_journal_test {

class RecordJournalTest : public LoopFolder {
 protected:
  RecordJournalTest()
      : loop_(readLoop("asp_case1_clp", {{"sampling.duration_h", "4"}})),
        layout_(recordLayout(loop_)),
        record_(runLoop(loop_)) {}

  void append(RecordJournal& journal, std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) journal.append(record_.samples[k]);
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

TEST_F(RecordJournalTest, AnotherRunStartsAnew) {
  RecordJournal journal;
  journal.open(path("journal"), layout_, 1);
  append(journal, 0, 3);
  EXPECT_EQ(journal.open(path("journal"), layout_, 2), 0U);
  journal.close();
  EXPECT_TRUE(readJournal(path("journal"), layout_).samples.empty());
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

/// While it lives no file grows beyond the size, as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    rlimit full = before_;
    full.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &full);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

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
