#include "plant/transport_delay.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace plant_transport_delay_test {

/// Output at sample 20 of a ramp y(k) = k that starts at sample 0 after a rest at 0.
double rampAt20(double delay_samples) {
  TransportDelay delay(delay_samples);
  delay.reset(0.0);
  double shown = 0.0;
  for (int k = 0; k <= 20; ++k) shown = delay.pass(k);
  return shown;
}

TEST(TransportDelay, ARampComesLaterByTheDelay) {
  for (const double delay : {0.0, 1.0, 0.25, 3.0, 3.75, 19.5})
    EXPECT_DOUBLE_EQ(rampAt20(delay), 20.0 - delay) << delay;
}

TEST(TransportDelay, BeforeTheStartThereIsTheInitialValue) {
  TransportDelay delay(2.5);
  delay.reset(7.0);
  EXPECT_EQ(delay.pass(100.0), 7.0);
  EXPECT_EQ(delay.pass(100.0), 7.0);
  EXPECT_EQ(delay.pass(100.0), 7.0 + 0.5 * 93.0);
  EXPECT_EQ(delay.pass(100.0), 100.0);
}

TEST(TransportDelay, ResetEmptiesTheLine) {
  TransportDelay delay(1.0);
  delay.reset(0.0);
  delay.pass(5.0);
  delay.reset(3.0);
  EXPECT_EQ(delay.pass(9.0), 3.0);
}

TEST(TransportDelay, UnusableDelaysAreErrors) {
  for (const double bad : {-0.1, 1e7, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()})
    EXPECT_THROW(TransportDelay{bad}, InputError) << bad;
}

}  // namespace plant_transport_delay_test
}  // namespace fpc
