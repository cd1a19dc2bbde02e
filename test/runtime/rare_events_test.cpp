// Words that are always there say nothing: no event lasts on a loop in which all is well.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>

#include "runtime/loop_fixture.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace runtime_rare_events_test {

constexpr double kRare = 0.01;  // of the samples

/// Loops that are there to show what an event is said of.
const std::map<std::string, std::set<EventCode>> kOnPurpose{
    {"asp_case_b", {EventCode::kOutsideModel}},            // a setpoint where its model has no data
    {"asp_uci_daily", {EventCode::kOutsideModel}},         // a record with days like no other
    {"cstr_tracking_linear", {EventCode::kOutsideModel}},  // steps beyond its one point
    {"four_on_two", {EventCode::kTargetGivenUp, EventCode::kSoftLimitExceeded}},  // more is asked
    {"shell_fractionator",
     {EventCode::kTargetGivenUp}},  // disturbances beyond what is held at rest
    {"column_clp_limits", {EventCode::kSoftLimitExceeded}},  // a limit that cannot hold
};

/// Every third of the short loops that every machine has; with FMBPC_LONG_TESTS all, and the table.
TEST(RareEvents, OnShippedLoops) {
  const bool all = std::getenv("FMBPC_LONG_TESTS") != nullptr;
  std::size_t number = 0, seen = 0;
  for (const std::string& name : loopNames()) {
    if (needsRecords(name) && !(all && hasRecords())) continue;
    const LoopFile loop = readLoop(name);
    if (loop.external_plant || (!all && loop.simulation.samples > 600)) continue;
    if (!all && number++ % 3 != 0) continue;
    const Summary summary = summarize(loop, runLoop(loop), 0.0);
    const auto purpose = kOnPurpose.find(name);
    for (const Event& event : summary.events) {
      const double share = static_cast<double>(event.count) / summary.steps;
      const char* code = kindOf(event.code).name;
      if (all)
        std::printf("%-28s %-22s %-10s %6u of %6u  %6.2f %%\n", name.c_str(), code,
                    event.signal.c_str(), event.count, summary.steps, 100.0 * share);
      const bool known = purpose != kOnPurpose.end() && purpose->second.count(event.code) > 0;
      EXPECT_TRUE(known || event.count == 0 || share <= kRare) << name << ": " << code << share;
    }
    ++seen;
  }
  EXPECT_GT(seen, 10U);
}

}  // namespace runtime_rare_events_test
}  // namespace fpc
