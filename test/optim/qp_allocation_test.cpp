// The QP solver does not allocate, whatever the outcome; and the counter that says so does count.
// The allocation counter replaces malloc: this file is a test program of its own.
#include "allocation_counter.hpp"

#include <cstdlib>
#include <memory>

#include <gtest/gtest.h>

#include "optim/qp_problems.hpp"

namespace fpc::testing {
namespace optim_qp_allocation_test {

/// A pointer that the compiler must take for used, so that it keeps the allocation.
void keep(void* pointer) { asm volatile("" : : "g"(pointer) : "memory"); }

TEST(AllocationCounter, CountsNewMallocAndEigen) {
  if (!AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  AllocationCounter counter;
  EXPECT_EQ(counter.count(), 0u);
  auto number = std::make_unique<double>(1.0);
  keep(number.get());
  EXPECT_EQ(counter.count(), 1u);
  void* block = std::malloc(10);
  keep(block);
  EXPECT_EQ(counter.count(), 2u);
  block = std::realloc(block, 100000);
  keep(block);
  EXPECT_EQ(counter.count(), 3u);
  std::free(block);
  block = std::calloc(3, 8);
  keep(block);
  std::free(block);
  EXPECT_EQ(counter.count(), 4u);
  block = std::aligned_alloc(64, 128);
  keep(block);
  std::free(block);
  EXPECT_EQ(counter.count(), 5u);
  counter.reset();
  Vector v(20);
  keep(v.data());
  EXPECT_EQ(counter.count(), 1u);
  const Matrix M = Matrix::Identity(20, 20);
  counter.reset();
  v.setOnes();
  const Vector w = M * v;  // Eigen's own storage
  keep(const_cast<double*>(w.data()));
  EXPECT_GE(counter.count(), 1u);
}

TEST(QpAllocation, ColdAndWarmSolvesOfControllerProblemsAllocateNothing) {
  if (!AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  using Kind = ControllerQp::Kind;
  for (const Kind kind : {Kind::kBounds, Kind::kMoves, Kind::kOutputs}) {
    ControllerQp controller(kind);
    QpSolver solver(controller.problem.g.size(), controller.problem.a_lower.size());
    for (int k = 0; k < 200; ++k) {
      controller.update(0.05 * k);
      const AllocationCounter counter;
      const QpResult& r = solver.solve(controller.problem, k % 10 != 0);
      ASSERT_EQ(counter.count(), 0u) << "step " << k;
      ASSERT_TRUE(r.usable());
    }
  }
}

TEST(QpAllocation, NoOutcomeOnRandomProblemsAllocates) {
  if (!AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  int solved = 0, failed = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const Eigen::Index n = draw.index(1, 150), m = draw.index(1, 100);
    QpProblem p = knownQp(draw, n, m).problem;
    if (draw.chance(0.2)) p.H(0, 0) = -1.0;
    if (draw.chance(0.3)) {  // semidefinite
      p.H.row(n - 1).setZero();
      p.H.col(n - 1).setZero();
    }
    if (draw.chance(0.2)) p.A(0, 0) = std::nan("");
    if (draw.chance(0.3)) {  // infeasible
      p.A.row(m - 1).setZero();
      p.a_lower(m - 1) = p.a_upper(m - 1) = 1.0;
    }
    QpSolver solver(n, m);
    const AllocationCounter counter;
    for (const bool warm : {false, true}) (solver.solve(p, warm).usable() ? solved : failed) += 1;
    ASSERT_EQ(counter.count(), 0u);
  }
  EXPECT_GT(solved, 50);
  EXPECT_GT(failed, 50);
}

}  // namespace optim_qp_allocation_test
}  // namespace fpc::testing
