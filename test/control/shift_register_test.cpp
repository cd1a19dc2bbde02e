// Known on paper: a shift register of maximal length (golomb1967) with n bits repeats after
// N = 2^n - 1, holds (N + 1) / 2 ones, and the autocorrelation of its signs is -1 / N at every
// shift but 0.
#include <gtest/gtest.h>

#include "control/excitation/excitation.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace control_shift_register_test {

std::vector<int> signs(int bits, std::size_t count) {
  ShiftRegister shift(bits, 1);
  std::vector<int> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(shift.next() ? 1 : -1);
  return values;
}

class MaximalLength : public ::testing::TestWithParam<int> {};

TEST_P(MaximalLength, EveryWordButZeroComesOncePerPeriod) {
  const int bits = GetParam();
  const std::uint32_t period = (1U << static_cast<unsigned>(bits)) - 1U;
  EXPECT_EQ(ShiftRegister(bits, 1).period(), period);
  const auto value = signs(bits, period + static_cast<std::size_t>(bits));
  std::vector<bool> seen(period + 1U, false);
  std::uint32_t word = 0, ones = 0;
  for (std::size_t i = 0; i < value.size(); ++i) {
    word = ((word << 1U) | (value[i] > 0 ? 1U : 0U)) & period;
    if (i < period) ones += value[i] > 0 ? 1U : 0U;
    if (i + 1 < static_cast<std::size_t>(bits) || i + 1 >= period + static_cast<std::size_t>(bits))
      continue;
    ASSERT_FALSE(seen[word]) << "word " << word << " again at " << i;
    seen[word] = true;
  }
  EXPECT_FALSE(seen[0]);
  EXPECT_EQ(ones, (period + 1U) / 2U);
}

INSTANTIATE_TEST_SUITE_P(Bits, MaximalLength,
                         ::testing::Range(ShiftRegister::kFewestBits,
                                          ShiftRegister::kMostBits + 1));

TEST(ShiftRegister, AutocorrelationIsMinusOneOverThePeriod) {
  for (const int bits : {3, 5, 8, 10}) {
    const std::size_t period = ShiftRegister(bits, 1).period();
    const auto value = signs(bits, period);
    for (std::size_t shift = 0; shift < period; ++shift) {
      int sum = 0;
      for (std::size_t i = 0; i < period; ++i) sum += value[i] * value[(i + shift) % period];
      EXPECT_EQ(sum, shift == 0 ? static_cast<int>(period) : -1) << bits << " bits, " << shift;
    }
  }
}

TEST(ShiftRegister, NeverStartsFromZeroWhateverTheStateIs) {
  for (std::uint64_t state = 0; state < 40; ++state) {
    ShiftRegister shift(3, state);
    int ones = 0;
    for (int i = 0; i < 7; ++i) ones += shift.next() ? 1 : 0;
    EXPECT_EQ(ones, 4) << state;
  }
  EXPECT_THROW(ShiftRegister(1, 1), InputError);
  EXPECT_THROW(ShiftRegister(21, 1), InputError);
}

}  // namespace control_shift_register_test
}  // namespace fpc
