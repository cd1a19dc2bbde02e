// Known on paper: a shift register of maximal length (golomb1967) with n bits repeats after
// N = 2^n - 1, holds (N + 1) / 2 ones, and the autocorrelation of its signs is -1 / N at every
// shift but 0.
#include <gtest/gtest.h>

#include <algorithm>

#include "control/excitation/excitation.hpp"

namespace fpc {
namespace control_shift_register_test {

constexpr std::uint32_t kBits = ShiftRegister::kBits, kPeriod = ShiftRegister::kPeriod;

std::vector<int> signs(std::uint64_t state, std::size_t count) {
  ShiftRegister shift(state);
  std::vector<int> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(shift.next() ? 1 : -1);
  return values;
}

TEST(ShiftRegister, EveryWordButZeroComesOncePerPeriod) {
  const auto value = signs(1, kPeriod + kBits);
  std::vector<bool> seen(kPeriod + 1U, false);
  std::uint32_t word = 0, ones = 0;
  for (std::size_t i = 0; i < value.size(); ++i) {
    word = ((word << 1U) | (value[i] > 0 ? 1U : 0U)) & kPeriod;
    if (i < kPeriod) ones += value[i] > 0 ? 1U : 0U;
    if (i + 1 < kBits || i + 1 >= kPeriod + kBits) continue;
    ASSERT_FALSE(seen[word]) << "word " << word << " again at " << i;
    seen[word] = true;
  }
  EXPECT_FALSE(seen[0]);
  EXPECT_EQ(ones, (kPeriod + 1U) / 2U);
}

TEST(ShiftRegister, AutocorrelationIsMinusOneOverThePeriod) {
  const auto value = signs(1, kPeriod);
  for (std::size_t shift = 0; shift < kPeriod; ++shift) {
    int sum = 0;
    for (std::size_t i = 0; i < kPeriod; ++i) sum += value[i] * value[(i + shift) % kPeriod];
    EXPECT_EQ(sum, shift == 0 ? static_cast<int>(kPeriod) : -1) << shift;
  }
}

TEST(ShiftRegister, NeverStartsFromZeroWhateverTheStateIs) {
  for (std::uint64_t state = 0; state < 40; ++state) {
    const auto value = signs(state * kPeriod, kPeriod);
    EXPECT_EQ(std::count(value.begin(), value.end(), 1), 512) << state;
  }
}

}  // namespace control_shift_register_test
}  // namespace fpc
