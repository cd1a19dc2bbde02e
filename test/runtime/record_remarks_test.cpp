// What the summary says of messages that a record over topics lacks.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "runtime/loop_fixture.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace loop_record_remarks_test {

TEST(RecordRemarks, MessagesThatNeverCameAreTold) {
  const LoopFile loop =
      readLoop("asp_case1_clp", {{"sampling.duration_h", "4"}, {"setpoint.schedule", "[]"}});
  RunRecord record = runLoop(loop);
  const auto told = [&] {
    std::vector<std::string> words;
    for (const RunRemark& remark : summarize(loop, record, 0.0).remarks)
      if (remark.words.find("in the record") != std::string::npos)
        words.push_back(remark.words + " " + std::to_string(remark.samples) + " " +
                        std::to_string(remark.first));
    return words;
  };
  EXPECT_EQ(told(), std::vector<std::string>{});
  record.samples[3].has_action = record.samples[7].has_action = false;
  record.samples[4].has_report = false;
  EXPECT_EQ(told(), (std::vector<std::string>{"no control_action in the record 2 3",
                                              "no solver_report in the record 1 4"}));
  record.samples.resize(8);  // cut short: what its last sample lacks may have been on its way
  EXPECT_EQ(told(), (std::vector<std::string>{"no control_action in the record 1 3",
                                              "no solver_report in the record 1 4"}));
}

}  // namespace loop_record_remarks_test
}  // namespace fpc
