#include "fmbpc/base/input_limits.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace base_input_limits_test {

Vector one(double value) { return Vector::Constant(1, value); }

InputLimits limits(double lower, double upper, double move) {
  return {one(lower), one(upper), one(move)};
}

double clipped(const InputLimits& limits, double input, double previous) {
  Vector u = one(input);
  limits.clip(u, one(previous));
  return u[0];
}

TEST(InputLimits, ClipsToMoveAndBounds) {
  const InputLimits l = limits(0.0, 1600.0, 100.0);
  EXPECT_EQ(clipped(l, 580.0, 570.0), 580.0);
  EXPECT_EQ(clipped(l, 900.0, 570.0), 670.0);
  EXPECT_EQ(clipped(l, 0.0, 570.0), 470.0);
  EXPECT_EQ(clipped(l, 1700.0, 1590.0), 1600.0);
  EXPECT_EQ(clipped(l, -20.0, 10.0), 0.0);
}

TEST(InputLimits, TheBoundWinsOverTheMoveLimitAndSaysSo) {
  const InputLimits l = limits(100.0, 200.0, 10.0);
  Vector u = one(150.0);
  EXPECT_TRUE(l.clip(u, one(0.0)));
  EXPECT_EQ(u[0], 100.0);
  u = one(150.0);
  EXPECT_FALSE(l.clip(u, one(145.0)));
}

TEST(InputLimits, AFullMoveIsNoConflictWhateverTheRounding) {
  const InputLimits l = limits(-1e9, 1e9, 1e-3);
  Vector u = one(1e8);
  EXPECT_FALSE(l.clip(u, one(1.0e7 + 1.0 / 3.0)));
}

TEST(InputLimits, NotANumberNeverPasses) {
  const InputLimits l = limits(0.0, 10.0, kInfinity);
  EXPECT_EQ(clipped(l, kNaN, 4.0), 4.0);
  EXPECT_EQ(clipped(l, kNaN, kNaN), 0.0);
  EXPECT_EQ(clipped(l, kInfinity, 4.0), 10.0);
  EXPECT_EQ(clipped(l, -kInfinity, 4.0), 0.0);
}

TEST(InputLimits, BoundsHoldForAnyInput) {
  constexpr unsigned kSeed = 11;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 generator(kSeed);
  std::normal_distribution<double> wild(0.0, 1e3);
  const InputLimits l = limits(-5.0, 7.0, 2.0);
  for (int i = 0; i < 1000; ++i) {
    const double previous = std::clamp(wild(generator), -5.0, 7.0);
    const double u = clipped(l, wild(generator), previous);
    EXPECT_TRUE(u >= -5.0 && u <= 7.0 && std::abs(u - previous) <= 2.0 + 1e-15) << u;
  }
}

TEST(InputLimits, ValidateNamesEachBadField) {
  const auto errorOf = [](const std::function<void(InputLimits&)>& spoil) -> std::string {
    InputLimits l = limits(0.0, 1.0, 1.0);
    spoil(l);
    try {
      l.validate(1);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  const auto names = [](const std::string& error, const char* field) {
    EXPECT_NE(error.find(field), std::string::npos) << "got '" << error << "'";
  };
  EXPECT_EQ(errorOf([](InputLimits&) {}), "");
  names(errorOf([](InputLimits& l) { l.lower.resize(2); }), "input_lower");
  names(errorOf([](InputLimits& l) { l.lower[0] = kNaN; }), "input_lower");
  names(errorOf([](InputLimits& l) { l.upper[0] = kInfinity; }), "input_upper");
  names(errorOf([](InputLimits& l) { l.upper[0] = -1.0; }), "input_upper");
  names(errorOf([](InputLimits& l) { l.move[0] = 0.0; }), "move_upper");
  names(errorOf([](InputLimits& l) { l.move[0] = kNaN; }), "move_upper");
}

}  // namespace base_input_limits_test
}  // namespace fpc
