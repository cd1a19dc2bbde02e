#include <gtest/gtest.h>

#include "allocation_counter.hpp"
#include "optim/rls.hpp"

namespace fpc {
namespace optim_rls_allocation_test {

TEST(RecursiveLeastSquares, AnUpdateDoesNotAllocate) {
  if (!testing::AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  RlsParams params;
  params.forgetting = 0.99;
  RecursiveLeastSquares rls(Vector::Zero(6), params);
  Vector x = Vector::LinSpaced(6, 0.1, 1.0);
  testing::AllocationCounter counter;
  for (int k = 0; k < 100; ++k) {
    x[k % 6] += 0.3;
    rls.update(x, 1.0, 0.5);
  }
  EXPECT_EQ(counter.count(), 0U);
}

}  // namespace optim_rls_allocation_test
}  // namespace fpc
