// Numbers as text: known cases, and the portable way beside the standard library's over random
// doubles.
#include "base/number.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace fpc {
namespace base_number_test {

TEST(Number, ShortestTextOfKnownNumbers) {
  for (const auto& print : {&fpc::printNumber, &portable::printNumber}) {
    EXPECT_EQ(print(0.1), "0.1");
    EXPECT_EQ(print(-2.0), "-2");
    EXPECT_EQ(print(0.0), "0");
    EXPECT_EQ(print(1e22), "1e+22");
    EXPECT_EQ(print(123456.0), "123456");
    EXPECT_EQ(print(100000.0), "1e+05");
    EXPECT_EQ(print(1e-5), "1e-05");
    EXPECT_EQ(print(147573952589676412928.0), "147573952589676412928");
    EXPECT_EQ(print(5e-324), "5e-324");
    EXPECT_EQ(print(std::numeric_limits<double>::infinity()), "inf");
  }
}

TEST(Number, PortableWayWritesTheSameBytes) {
  std::mt19937_64 generator(7);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t bits = generator();
    double value = 0.0;
    std::memcpy(&value, &bits, sizeof value);
    if (i % 2 == 0)
      value = std::ldexp(static_cast<double>(bits >> 40), -static_cast<int>(bits % 30));
    if (!std::isfinite(value)) continue;
    const std::string text = printNumber(value);
    ASSERT_EQ(portable::printNumber(value), text);
    ASSERT_EQ(portable::parseNumber(text), value);
    ASSERT_EQ(parseNumber(text), value);
  }
}

TEST(Number, WhatIsNoNumberIsRefusedByBoth) {
  for (const auto& parse : {&fpc::parseNumber, &portable::parseNumber}) {
    for (const char* text : {"", "-", "+1", " 1", "1 ", "0x10", "1e400", "-1e400", "1.5.2", "e5",
                             "1,5", "--1", "abc", "1e"})
      EXPECT_FALSE(parse(text).has_value()) << text;
    for (const char* text : {"1", "-1.5", ".5", "1.", "1e-3", "1E5", "inf", "-inf", "010"})
      EXPECT_TRUE(parse(text).has_value()) << text;
    EXPECT_TRUE(std::isnan(parse("nan").value_or(0.0)));
  }
}

}  // namespace base_number_test
}  // namespace fpc
