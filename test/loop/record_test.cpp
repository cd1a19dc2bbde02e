#include "fmbpc/loop/record.hpp"

#include <gtest/gtest.h>

namespace fpc {
namespace {

StepHeader header(std::uint32_t step, std::uint64_t run = 7) { return {1000 + step, run, step}; }

Measurement measurement(std::uint32_t step, bool final = false) {
  Measurement m;
  m.header = header(step);
  m.final = final;
  return m;
}

Tracking tracking(std::uint32_t step) { return {header(step), Vector::Zero(1), Vector::Zero(1)}; }
ControlAction action(std::uint32_t step) {
  return {header(step), Vector::Ones(1), ActionSource::kBase};
}

Recorder recorder(bool has_optimizer) {
  return {"loop", PlantInfo{}, has_optimizer, false, {}, {}};
}

void addSample(Recorder& r, std::uint32_t step, bool final) {
  r.add(measurement(step, final));
  r.add(tracking(step));
  if (!final) r.addBase(action(step));
}

TEST(Recorder, IsCompleteWithTheFinalSampleAndNoGap) {
  Recorder r = recorder(false);
  EXPECT_FALSE(r.complete());
  EXPECT_TRUE(r.gaps().empty());
  addSample(r, 0, false);
  addSample(r, 1, false);
  EXPECT_FALSE(r.complete());
  addSample(r, 2, true);
  EXPECT_TRUE(r.finalSeen());
  EXPECT_TRUE(r.complete());
  const RunRecord record = r.take();
  EXPECT_TRUE(record.complete);
  EXPECT_EQ(record.samples.size(), 3U);
}

TEST(Recorder, OrderOfArrivalDoesNotMatter) {
  Recorder r = recorder(false);
  addSample(r, 2, true);
  addSample(r, 0, false);
  EXPECT_EQ(r.gaps(), (std::vector<std::string>{"sample 1: no measurement", "sample 1: no tracking",
                                                "sample 1: no base_action"}));
  addSample(r, 1, false);
  EXPECT_TRUE(r.complete());
}

TEST(Recorder, WithoutAnOptimizerTheBaseActionIsWhatThePlantWasTold) {
  Recorder r = recorder(false);
  r.addBase(action(0));
  EXPECT_TRUE(r.record().samples[0].has_action);
  EXPECT_EQ(r.record().samples[0].action.input, Vector::Ones(1));
}

TEST(Recorder, AnOptimizerOwesActionAndReport) {
  Recorder r = recorder(true);
  addSample(r, 0, false);
  addSample(r, 1, true);
  EXPECT_EQ(r.gaps(), (std::vector<std::string>{"sample 0: no control_action",
                                                "sample 0: no solver_report"}));
  EXPECT_EQ(r.gaps(1).size(), 1U);
  r.addAction(action(0));
  SolverReport report;
  report.header = header(0);
  r.add(report);
  EXPECT_TRUE(r.complete());
}

TEST(Recorder, ANewRunStartsOverAndOldOnesAreIgnored) {
  Recorder r = recorder(false);
  addSample(r, 0, false);
  addSample(r, 1, true);
  Measurement newer = measurement(0);
  newer.header.run_id = 8;
  r.add(newer);
  EXPECT_EQ(r.record().samples.size(), 1U);
  EXPECT_FALSE(r.complete());
  addSample(r, 1, true);  // run 7 again
  EXPECT_EQ(r.record().samples.size(), 1U);
}

TEST(Recorder, AStrayStepNumberDoesNotFillTheMemory) {
  Recorder r = recorder(false);
  r.add(measurement(4000000000U));
  EXPECT_TRUE(r.record().samples.empty());
}

}  // namespace
}  // namespace fpc
