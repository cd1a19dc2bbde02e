// An assertion that does not hold: test/counting_test.py runs it to see that the count notices.
#include <gtest/gtest.h>

TEST(Broken, AssertionThatDoesNotHold) { EXPECT_EQ(1, 2); }
