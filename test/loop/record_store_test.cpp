#include "fmbpc/loop/record_store.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "fmbpc/loop/run.hpp"
#include "loop/loop_fixture.hpp"

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
    for (const SampleRecord& sample : record.samples) store.append(sample);
    store.finish(1.5);
    writeRun(loop, record, summarize(loop, record, 1.5), path("whole"));
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
                             {"report.windows", "[{name: late, from_h: 2, to_h: 6}]"}});
  RunRecord record = runLoop(loop);
  for (const std::size_t hole : {5, 20, 21}) record.samples[hole] = SampleRecord();
  record.samples[7].has_tracking = record.samples[9].has_action = false;
  record.samples[11].remark = "a word";
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
  const LoopFile loop = readLoop("asp_case1_clp", {{"sampling.duration_h", "2"}});
  const RunRecord record = runLoop(loop);
  RecordStore store(loop, path("long"));
  store.begin(7);
  for (std::size_t k = 0; k < 20000; ++k)
    store.append(record.samples[k % (record.samples.size() - 1)]);
  peakSinceLastCall();
  const double before = peakSinceLastCall();
  if (before == 0.0) GTEST_SKIP() << "no /proc/self/status";
  const Summary summary = store.finish(0.0);
  EXPECT_EQ(summary.steps, 20000U);
  EXPECT_LT(peakSinceLastCall() - before, 3000.0);  // 21600 when the record was read whole
}

}  // namespace loop_record_store_test
}  // namespace fpc
