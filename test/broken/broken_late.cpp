// What crashes when the result is written: test/counting_test.py runs it to see that the count
// notices.
#include <gtest/gtest.h>

#include <cstdlib>

namespace {
struct Late {
  ~Late() { std::abort(); }
} late;
}  // namespace

TEST(Broken, PassesBeforeTheCrash) { EXPECT_EQ(1, 1); }
