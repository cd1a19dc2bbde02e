// The judge of the benchmark of other people's QP solvers.
#include "../../bench/baselines/judge.hpp"

#include <gtest/gtest.h>

#include "optim/qp_problems.hpp"

namespace fpc::testing {
namespace {

using bench::errorOf;

TEST(QpJudge, MeasuresViolationAndCost) {
  const QpProblem p = nearestPointOfHalfPlane();
  const Vector ours = Vector::Ones(2);
  EXPECT_EQ(errorOf(p, ours, ours), 0.0);
  EXPECT_DOUBLE_EQ(errorOf(p, Vector::Constant(2, 2.0), ours), 1.5);  // costs 4, not 1
  EXPECT_DOUBLE_EQ(errorOf(p, Vector::Zero(2), ours), 1.0);           // 2 beyond the row
}

TEST(QpJudge, RefusesWhatIsNoPoint) {
  const QpProblem p = nearestPointOfHalfPlane();
  const Vector ours = Vector::Ones(2);
  EXPECT_EQ(errorOf(p, Vector::Constant(2, kNaN), ours), kInfinity);
  EXPECT_EQ(errorOf(p, Vector::Constant(2, kInfinity), ours), kInfinity);
  EXPECT_EQ(errorOf(p, Vector(), ours), kInfinity);
}

}  // namespace
}  // namespace fpc::testing
