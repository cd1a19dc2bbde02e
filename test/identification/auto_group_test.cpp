// Several starts of one structure as one: those that got stuck do not speak.
#include <gtest/gtest.h>

#include <cmath>

#include "identification/auto_search.hpp"

namespace fpc {
namespace fuzzy_auto_group_test {

using Eigen::Index;

/// 40 rows of zero, two blocks.
DataSet zeros() {
  DataSet data;
  data.source = "zeros";
  data.sample_time_s = 1.0;
  data.outputs = {{"y", "", 0.0, 1.0}};
  data.values = Matrix::Zero(40, 1);
  return data;
}
AutoData prepared(const DataSet& data) {
  AutoData a;
  a.data = &data;
  a.windows = {{0, 20}, {20, 40}};
  return a;
}

/// Runs `early` off in the first block and `late` off in the second.
Judgement member(double early, double late, double seen_early, double seen_late) {
  Judgement j;
  j.free_run.resize(40);
  j.free_run << Vector::Constant(20, early), Vector::Constant(20, late);
  j.seen = {seen_early, seen_late};
  j.parameters = 3;
  return j;
}

TEST(StuckStarts, AreThoseFarAboveTheLowerQuartile) {
  EXPECT_EQ(stuckStarts({1.0, 1.2, 9.0, 1.29, 1.31}),
            (std::vector<bool>{false, false, true, false, false}))
      << "the quartile of five is the second";
  EXPECT_EQ(stuckStarts({5.0}), std::vector<bool>{false});
  EXPECT_EQ(stuckStarts({kInfinity, 1.0, 1.0, 1.0, 1.0}).front(), true);
}

TEST(StartsOfOneStructure, LeaveOutThoseStuckInABlock) {
  const DataSet data = zeros();
  const AutoData a = prepared(data);
  Group group;
  group.members = {member(0.1, 8.0, 1.0, 5.0), member(8.0, 0.1, 5.0, 1.0),
                   member(0.1, 0.1, 1.0, 1.0)};
  settleGroup(a, group);
  EXPECT_NEAR(group.rmse, 0.1, 1e-12);
  EXPECT_NEAR(group.members[0].rmse, 0.1, 1e-12) << "only where it was not stuck";
  EXPECT_NEAR(group.score, 0.1 * penalty(3, a), 1e-12);
  for (auto& m : group.members) m.seen = {1.0, 1.0};
  settleGroup(a, group);
  EXPECT_NEAR(group.free_run[0], 0.1, 1e-12) << "the extremes do not count";
  EXPECT_NEAR(group.members[0].rmse, std::sqrt((0.01 + 64.0) / 2.0), 1e-12);
}

TEST(MeanBlockError, IsNotDecidedByOneBlockAlone) {
  const DataSet data = zeros();
  const AutoData a = prepared(data);
  const Judgement uneven = member(0.1, 0.9, 0.0, 0.0), even = member(0.6, 0.6, 0.0, 0.0);
  EXPECT_NEAR(meanBlockError(a, uneven.free_run), 0.5, 1e-12);
  EXPECT_NEAR(meanBlockError(a, even.free_run), 0.6, 1e-12);
  EXPECT_GT(rmseOf(a, uneven.free_run), rmseOf(a, even.free_run)) << "squares say otherwise";
}

}  // namespace fuzzy_auto_group_test
}  // namespace fpc
