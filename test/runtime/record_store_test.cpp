#include "runtime/record_store.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "runtime/full_disk.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/recover.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace loop_record_store_test {

/// Largest memory of this process since the last call [kB]; 0 where the system does not say.
double peakSinceLastCall() {
  double peak = 0.0;
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) peak = std::stod(line.substr(6));
  std::ofstream("/proc/self/clear_refs") << "5";
  return peak;
}

class RecordStoreTest : public LoopFolder {
 protected:
  static void put(RecordStore& store, const RunRecord& record, std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k)
      store.put(static_cast<std::uint32_t>(k), record.samples[k]);
  }
  static std::string textOf(const std::string& file) {
    std::ifstream stream(file);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }
  /// The files that finish() makes, sample by sample, are those of the whole record.
  void expectSameFiles(const LoopFile& loop, RunRecord record, bool complete) {
    conclude(record, complete);
    RecordStore store(loop, path("streamed"));
    store.begin(7);
    put(store, record, 0, record.samples.size());
    store.finish(1.5);
    Summary summary = summarize(loop, record, 1.5);
    summary.run_id = 7;
    writeRun(loop, record, summary, path("whole"));
    for (const char* name : {"/trajectory.csv", "/summary.json"})
      EXPECT_EQ(textOf(path("streamed") + name), textOf(path("whole") + name)) << name;
    EXPECT_GT(textOf(path("whole") + "/trajectory.csv").size(), 100U);
  }
};

TEST_F(RecordStoreTest, FilesMadeSampleBySampleAreThoseOfTheWholeRecord) {
  const LoopFile loop = readLoop("asp_case1_clp", {{"sampling.duration_h", "8"}});
  expectSameFiles(loop, runLoop(loop), true);
}

TEST_F(RecordStoreTest, AlsoWithHolesWindowsAndALateStart) {
  const LoopFile loop =
      readLoop("asp_case1", {{"sampling.duration_h", "8"},
                             {"report.record_from_h", "3"},
                             {"report.windows", "[{name: late, between_s: [7200, 21600]}]"}});
  RunRecord record = runLoop(loop);
  for (const std::size_t hole : {5, 20, 21}) record.samples[hole] = SampleRecord();
  record.samples[7].has_tracking = record.samples[9].has_action = false;
  record.samples[11].events = {eventOf({EventCode::kNote, "a word", "x"}, 11)};
  expectSameFiles(loop, record, false);
}

TEST_F(RecordStoreTest, AStartAfterTheEndLeavesTheLastRow) {
  const LoopFile loop =
      readLoop("asp_case1", {{"sampling.duration_h", "2"}, {"report.record_from_h", "2"}});
  RunRecord record = runLoop(loop);
  record.samples.resize(4);
  expectSameFiles(loop, record, false);
}

TEST_F(RecordStoreTest, MemoryDoesNotGrowWithTheRun) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "AddressSanitizer keeps what is freed";
#endif
  const LoopFile loop = readLoop("asp_case1_clp", {{"sampling.duration_h", "2"}});
  const RunRecord record = runLoop(loop);
  RecordStore store(loop, path("long"));
  store.begin(7);
  for (std::uint32_t k = 0; k < 20000; ++k)
    store.put(k, record.samples[k % (record.samples.size() - 1)]);
  peakSinceLastCall();
  const double before = peakSinceLastCall();
  if (before == 0.0) GTEST_SKIP() << "no /proc/self/status";
  const Summary summary = store.finish(0.0);
  EXPECT_EQ(summary.steps, 20000U);
  EXPECT_LT(peakSinceLastCall() - before, 3000.0);  // 21600 when the record was read whole
}

/// Runs that processes are killed in: a store that goes without finish().
class InterruptedTest : public RecordStoreTest {
 protected:
  InterruptedTest()
      : clp_(readLoop("asp_case1_clp", {{"sampling.duration_h", "2"}})),
        plain_(readLoop("asp_case1", {{"sampling.duration_h", "2"}})) {}

  /// A process that records the first samples of the run.
  void record(const LoopFile& loop, std::uint64_t run_id, std::size_t samples,
              bool finish = false) {
    const RunRecord run = runLoop(loop);
    RecordStore store(loop, path("out"));
    store.begin(run_id);
    put(store, run, 0, samples);
    if (finish) store.finish(1.0);
  }
  std::size_t rows(const std::string& folder) const {
    const std::string text = textOf(path(folder) + "/trajectory.csv");
    return text.empty() ? 0
                        : static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) - 1;
  }
  bool exists(const std::string& file) const { return std::filesystem::exists(path(file)); }

  LoopFile clp_, plain_;
};

TEST_F(InterruptedTest, EveryRunThatWasCutShortHasAFolderOfItsOwnAndIsOfItsOwnLoop) {
  record(clp_, 11, 5);
  record(clp_, 12, 6);
  record(plain_, 13, 7);
  record(plain_, 14, 1);
  EXPECT_EQ(rows("out/history/11"), 5U);
  EXPECT_EQ(rows("out/history/12"), 6U);
  EXPECT_EQ(rows("out/history/13"), 7U);
  for (const auto& [run, loop] :
       {std::pair("11", "asp_case1_clp"), {"12", "asp_case1_clp"}, {"13", "asp_case1"}}) {
    const std::string folder = std::string("out/history/") + run;
    EXPECT_EQ(readSummary(path(folder) + "/summary.json").loop, loop);
    EXPECT_FALSE(exists(folder + "/journal.bin"));
  }
}

TEST_F(InterruptedTest, AJournalOfOtherSizesIsNotTruncated) {
  record(clp_, 11, 5);
  record(readLoop("cstr_tracking"), 12, 3);
  EXPECT_EQ(rows("out/history/11"), 5U);
  EXPECT_EQ(journalLabel(path("out/journal.bin"))->run_id, 12U);
}

TEST_F(InterruptedTest, WhatIsNoJournalOfThisVersionIsPutAsideAsItIs) {
  std::filesystem::create_directories(path("out"));
  const std::string letter(5000, 'a');
  write("out/journal.bin", letter);
  RecordStore store(clp_, path("out"));
  store.begin(12);
  EXPECT_EQ(textOf(path("out/history/unknown/journal.bin")), letter);
  expectWords(store.remark(), {"history/unknown/journal.bin", "stays as it is"});
  EXPECT_EQ(store.problem(), "");
}

TEST_F(InterruptedTest, OneRunThatIsPutAsideTwiceHasTwoFolders) {
  record(clp_, 11, 5);
  record(plain_, 11, 4);
  record(clp_, 11, 3);
  EXPECT_EQ(rows("out/history/11"), 5U);
  EXPECT_EQ(rows("out/history/11-2"), 4U);
}

TEST_F(InterruptedTest, TheFolderHoldsTheNewestRunAndItsHistoryThoseBefore) {
  record(clp_, 11, 11, true);
  const std::string complete = textOf(path("out/trajectory.csv"));
  record(clp_, 12, 4, true);
  EXPECT_EQ(textOf(path("out/history/11/trajectory.csv")), complete);
  EXPECT_EQ(rows("out"), 4U);
  record(plain_, 13, 11, true);
  EXPECT_EQ(readSummary(path("out/summary.json")).loop, "asp_case1");
  EXPECT_EQ(rows("out/history/12"), 4U);
  EXPECT_EQ(textOf(path("out/history/11/trajectory.csv")), complete);
}

TEST_F(InterruptedTest, PartsOfARunWhoseRecorderEndedInOrderAreJoined) {
  const RunRecord run = runLoop(clp_);
  const auto part = [&](std::size_t from, std::size_t to) {
    RecordStore store(clp_, path("out"));
    const std::size_t here = store.begin(11);
    put(store, run, here, to);
    if (to == run.samples.size())
      store.finish(1.0);
    else
      store.interrupt(1.0);
    return here == from;
  };
  EXPECT_TRUE(part(0, 5));
  EXPECT_EQ(rows("out"), 5U);
  EXPECT_FALSE(readSummary(path("out/summary.json")).complete);
  EXPECT_TRUE(part(5, 7));
  EXPECT_EQ(rows("out"), 7U);
  EXPECT_TRUE(part(7, 11));
  EXPECT_EQ(rows("out"), 11U);
  EXPECT_TRUE(readSummary(path("out/summary.json")).complete);
  EXPECT_FALSE(exists("out/journal.bin") || exists("out/history"));
}

TEST_F(InterruptedTest, ASampleThatHadComeInPartIsGoneOnWith) {
  const RunRecord run = runLoop(clp_);
  SampleRecord parts[] = {run.samples[3], run.samples[4]};
  parts[0].has_tracking = parts[1].has_action = false;
  {
    RecordStore store(clp_, path("out"));
    store.begin(11);
    put(store, run, 0, 3);
    store.put(3, parts[0]);
    store.put(4, parts[1]);
  }
  RecordStore store(clp_, path("out"));
  const std::uint32_t here = store.begin(11);
  ASSERT_EQ(here, 5U);
  RecorderSession session(recordLayout(clp_), [&](std::uint32_t step, const SampleRecord& sample) {
    store.put(step, sample);
  });
  session.resume(11, here, store.unfinished());
  EXPECT_EQ(session.waiting(), 2U);
  Tracking tracking = run.samples[3].tracking;
  ControlAction action = run.samples[4].action;
  tracking.header.run_id = action.header.run_id = 11;
  session.receive(tracking);
  session.receiveAction(action);
  EXPECT_EQ(session.waiting(), 0U);
  put(store, run, 5, run.samples.size());
  store.finish(1.0);
  EXPECT_TRUE(readSummary(path("out/summary.json")).complete);
  EXPECT_EQ(rows("out"), 11U);
}

TEST_F(InterruptedTest, WhatARecorderLeftForAnotherOneIsFiledOnce) {
  {
    const RunRecord run = runLoop(clp_);
    RecordStore store(clp_, path("out"));
    store.begin(11);
    put(store, run, 0, 5);
    store.interrupt(1.0);
  }
  record(clp_, 12, 11, true);
  EXPECT_EQ(rows("out"), 11U);
  EXPECT_EQ(rows("out/history/11"), 5U);
  EXPECT_FALSE(exists("out/history/11-2"));
}

TEST_F(InterruptedTest, AnEndlessRunIsFiledInPartsThatFollowEachOther) {
  const RunRecord run = runLoop(clp_);
  const LoopFile endless =
      readLoop("asp_case1_clp", {{"sampling.duration_h", "0"}, {"disturbance.source", "constant"}});
  const auto record = [&](std::size_t from, std::size_t to) {
    RecordStore store(endless, path("out"), 0.0, 0.8);
    EXPECT_EQ(store.begin(11), from);
    for (std::size_t k = from; k < to; ++k) {
      put(store, run, k, k + 1);
      EXPECT_FALSE(store.flush(false));
      store.flush();
    }
    store.interrupt(1.0);
  };
  record(0, 5);
  record(5, 10);
  EXPECT_EQ(rows("out"), 2U);
  EXPECT_EQ(rows("out/history/11"), 4U);
  EXPECT_EQ(rows("out/history/11-2"), 4U);
  std::string joined = textOf(path("out/history/11/trajectory.csv"));
  for (const char* folder : {"out/history/11-2", "out"}) {
    const std::string text = textOf(path(folder) + "/trajectory.csv");
    joined += text.substr(text.find('\n') + 1);
  }
  std::istringstream lines(joined);
  std::string line;
  std::getline(lines, line);
  for (int k = 0; std::getline(lines, line); ++k)
    EXPECT_NEAR(std::stod(line), 0.2 * k, 1e-9);  // time goes on
  EXPECT_TRUE(readSummary(path("out/history/11/summary.json")).complete);
  EXPECT_EQ(readSummary(path("out/history/11-2/summary.json")).first_step, 4U);
}

TEST_F(InterruptedTest, APartOfWhichMoreMayComeIsTwiceAsLongAndNoMore) {
  const RunRecord run = runLoop(clp_);
  const LoopFile endless =
      readLoop("asp_case1_clp", {{"sampling.duration_h", "0"}, {"disturbance.source", "constant"}});
  RecordStore store(endless, path("out"), 0.0, 0.8);
  store.begin(11);
  std::vector<std::size_t> ends;
  for (std::size_t k = 0; k < 10; ++k) {
    put(store, run, k, k + 1);
    if (store.flush(false)) ends.push_back(k + 1);
  }
  EXPECT_EQ(ends, (std::vector<std::size_t>{8}));
}

TEST_F(InterruptedTest, AJournalBecomesFilesOnRequest) {
  EXPECT_TRUE(recoverFolder(path("out")).empty());
  record(clp_, 11, 5);
  const auto first = recoverFolder(path("out"));
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].problem, "");
  EXPECT_EQ(first[0].record.folder, path("out"));
  EXPECT_EQ(rows("out"), 5U);
  EXPECT_FALSE(exists("out/journal.bin"));
  EXPECT_TRUE(recoverFolder(path("out")).empty());
  record(plain_, 12, 4);
  EXPECT_EQ(recoverFolder(path("out")).at(0).record.folder, path("out"));
  EXPECT_EQ(rows("out"), 4U);
  EXPECT_EQ(rows("out/history/11"), 5U);
}

TEST_F(InterruptedTest, AJournalThatIsBeingWrittenIsLeftAlone) {
  RecordStore store(clp_, path("out"));
  store.begin(11);
  store.put(0, runLoop(clp_).samples[0]);
  expectWords(recoverFolder(path("out")).at(0).problem, {"another loop is running"});
  EXPECT_TRUE(exists("out/journal.bin"));
}

TEST_F(InterruptedTest, AFullDiskAtTheBeginningIsSaidAndTheWholeRunIsRecordedOnceThereIsRoom) {
  record(clp_, 11, 5);
  const RunRecord run = runLoop(clp_);
  RecordStore store(clp_, path("out"));
  {
    const FullDisk full(0);
    EXPECT_EQ(store.begin(12), 0U);
    put(store, run, 0, run.samples.size());
    store.flush();
    expectWords(store.problem(), {"not recorded", "room on the disk"});
  }
  store.flush();
  EXPECT_EQ(store.problem(), "");
  EXPECT_EQ(store.finish(1.0).steps, 10U);
  EXPECT_EQ(rows("out"), 11U);
  EXPECT_EQ(recoverFolder(path("out")).size(), 1U);  // there was no room for its files
  EXPECT_EQ(rows("out/history/11"), 5U);
}

}  // namespace loop_record_store_test
}  // namespace fpc
