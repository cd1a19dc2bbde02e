#include "base/register_codec.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "random/dice.hpp"

namespace fpc {
namespace base_register_codec_test {

const std::vector<RegisterType> kTypes{RegisterType::kInt16, RegisterType::kUint16,
                                       RegisterType::kInt32, RegisterType::kUint32,
                                       RegisterType::kFloat32};

RegisterFormat format(RegisterType type, WordOrder order = WordOrder::kHighFirst,
                      double scale = 1.0, double offset = 0.0) {
  return {type, order, scale, offset};
}

TEST(RegisterCodec, KnowsTheBitsOfPaper) {
  EXPECT_EQ(encode(format(RegisterType::kFloat32), 1.0), (Registers{0x3F80, 0x0000}));
  EXPECT_EQ(encode(format(RegisterType::kFloat32, WordOrder::kLowFirst), 1.0),
            (Registers{0x0000, 0x3F80}));
  EXPECT_EQ(encode(format(RegisterType::kInt16), -2.0), (Registers{0xFFFE, 0}));
  EXPECT_EQ(encode(format(RegisterType::kInt32), -2.0), (Registers{0xFFFF, 0xFFFE}));
  EXPECT_EQ(encode(format(RegisterType::kUint32, WordOrder::kLowFirst), 65537.0),
            (Registers{1, 1}));
  EXPECT_EQ(encode(format(RegisterType::kUint16, WordOrder::kHighFirst, 0.01), 103.41),
            (Registers{10341, 0}));
  EXPECT_EQ(decode(format(RegisterType::kInt16, WordOrder::kHighFirst, 0.1, 20.0), {0xFF9C, 0}),
            10.0);
}

TEST(RegisterCodec, SaysNothingOfWhatDoesNotFit) {
  EXPECT_FALSE(encode(format(RegisterType::kUint16), -1.0));
  EXPECT_FALSE(encode(format(RegisterType::kUint16), 65536.0));
  EXPECT_FALSE(encode(format(RegisterType::kInt16), 32768.0));
  EXPECT_FALSE(encode(format(RegisterType::kFloat32), 1e300));
  for (const RegisterType type : kTypes) {
    EXPECT_FALSE(encode(format(type), std::numeric_limits<double>::quiet_NaN()));
    EXPECT_FALSE(encode(format(type), std::numeric_limits<double>::infinity()));
  }
}

TEST(RegisterCodec, WhatIsRepresentableTravelsUnchangedAndKeepsItsLimits) {
  Dice dice(1);
  int found = 0;
  for (int i = 0; i < 20000; ++i) {
    const RegisterFormat f = format(
        dice.pick(kTypes), dice.chance(0.5) ? WordOrder::kHighFirst : WordOrder::kLowFirst,
        (dice.chance(0.5) ? 1.0 : -1.0) * dice.scale(1e-4, 1e2), dice.between(-100.0, 100.0));
    const double lower = dice.between(-500.0, 500.0), upper = lower + dice.scale(1e-6, 1e3);
    const double value = dice.between(lower, upper);
    const auto told = representable(f, value, lower, upper);
    if (!told) continue;
    ++found;
    ASSERT_GE(*told, lower);
    ASSERT_LE(*told, upper);
    const auto registers = encode(f, *told);
    ASSERT_TRUE(registers);
    ASSERT_EQ(decode(f, *registers), *told);
    const double step = f.type == RegisterType::kFloat32
                            ? 1e-6 * (std::abs(value) + std::abs(f.offset) + std::abs(f.scale))
                            : std::abs(f.scale);
    ASSERT_LE(std::abs(*told - value), step * (1.0 + 1e-9));
  }
  EXPECT_GT(found, 5000);
}

TEST(RegisterCodec, ARoundedNumberGivesWayToTheLimitAndNotTheLimitToIt) {
  const RegisterFormat f = format(RegisterType::kInt16, WordOrder::kHighFirst, 0.3);
  EXPECT_NEAR(*representable(f, 2.0, 0.0, 2.0), 1.8, 1e-12);  // 2.1 would be nearer
  EXPECT_NEAR(*representable(f, 1.95, 1.9, 3.0), 2.1, 1e-12);
  EXPECT_FALSE(representable(f, 1.95, 1.9, 2.0));
}

}  // namespace base_register_codec_test
}  // namespace fpc
