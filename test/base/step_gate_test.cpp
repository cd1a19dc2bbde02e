#include "fmbpc/base/step_gate.hpp"

#include <gtest/gtest.h>

namespace fpc {
namespace {

StepHeader header(std::uint64_t run, std::uint32_t step) { return {0, run, step}; }

TEST(StepGate, EveryArrivalHasItsName) {
  StepGate gate;
  EXPECT_EQ(gate.pass(header(5, 3)), Arrival::kFirst);
  EXPECT_EQ(gate.pass(header(5, 4)), Arrival::kNext);
  EXPECT_EQ(gate.pass(header(5, 4)), Arrival::kRepeat);
  EXPECT_EQ(gate.pass(header(5, 2)), Arrival::kOld);
  EXPECT_EQ(gate.pass(header(5, 6)), Arrival::kGap);
  EXPECT_EQ(gate.pass(header(4, 7)), Arrival::kOtherRun);
  EXPECT_EQ(gate.pass(header(6, 0)), Arrival::kNewRun);
  EXPECT_EQ(gate.pass(header(6, 1)), Arrival::kNext);
}

TEST(StepGate, EachKindIsCountedApart) {
  StepGate gate;
  for (const auto& h : {header(1, 0), header(1, 0), header(1, 1), header(1, 0), header(1, 5),
                        header(0, 6), header(2, 0)})
    gate.pass(h);
  gate.countWrongSize();
  gate.countNotFinite();
  gate.countNotFinite();
  const ArrivalCounts& counts = gate.counts();
  EXPECT_EQ(counts.accepted, 4U);
  EXPECT_EQ(counts.repeated, 1U);
  EXPECT_EQ(counts.old, 1U);
  EXPECT_EQ(counts.gaps, 1U);
  EXPECT_EQ(counts.other_run, 1U);
  EXPECT_EQ(counts.new_runs, 1U);
  EXPECT_EQ(counts.wrong_size, 1U);
  EXPECT_EQ(counts.not_finite, 2U);
}

TEST(StepGate, DroppedArrivalsAreNotRemembered) {
  StepGate gate;
  EXPECT_TRUE(gate.empty());
  gate.pass(header(3, 10));
  gate.pass(header(3, 4));
  gate.pass(header(2, 11));
  EXPECT_EQ(gate.last().step, 10U);
  EXPECT_EQ(gate.last().run_id, 3U);
  EXPECT_EQ(gate.classify(header(3, 11)), Arrival::kNext);
}

TEST(StepGate, ClassifyingChangesNothing) {
  StepGate gate;
  gate.pass(header(1, 0));
  EXPECT_EQ(gate.classify(header(1, 1)), Arrival::kNext);
  EXPECT_EQ(gate.classify(header(1, 1)), Arrival::kNext);
  EXPECT_EQ(gate.counts().accepted, 1U);
}

TEST(StepGate, OnlyLostOrNewRunsNeedAReset) {
  for (const auto arrival : {Arrival::kFirst, Arrival::kGap, Arrival::kNewRun})
    EXPECT_TRUE(needsReset(arrival) && isNew(arrival));
  EXPECT_TRUE(isNew(Arrival::kNext) && !needsReset(Arrival::kNext));
  for (const auto arrival : {Arrival::kRepeat, Arrival::kOld, Arrival::kOtherRun})
    EXPECT_FALSE(isNew(arrival) || needsReset(arrival));
}

}  // namespace
}  // namespace fpc
