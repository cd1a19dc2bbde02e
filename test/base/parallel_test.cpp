#include "base/parallel.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace base_parallel_test {

TEST(ParallelFor, DoesEveryIndexOnceOnAnyNumberOfThreads) {
  for (const int threads : {0, 1, 2, 4, 100}) {
    std::vector<int> done(37, 0);
    parallelFor(done.size(), threads, [&](std::size_t i) { done[i] += static_cast<int>(i) + 1; });
    for (std::size_t i = 0; i < done.size(); ++i) EXPECT_EQ(done[i], static_cast<int>(i) + 1);
  }
  parallelFor(0, 4, [](std::size_t) { FAIL(); });
}

TEST(ParallelFor, ThrowsWhatTheLowestIndexThrewAndDoesTheRest) {
  std::vector<int> done(20, 0);
  try {
    parallelFor(done.size(), 4, [&](std::size_t i) {
      done[i] = 1;
      if (i == 7 || i == 13) throw std::runtime_error(std::to_string(i));
    });
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), "7");
  }
  EXPECT_EQ(done, std::vector<int>(20, 1));
  EXPECT_THROW(parallelFor(1, -1, [](std::size_t) {}), InputError);
}

}  // namespace base_parallel_test
}  // namespace fpc
