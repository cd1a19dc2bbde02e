// An affine law of what is measured: its value on paper, and what is not finite.
#include "control/affine_law.hpp"

#include <cmath>

#include "runtime/session_fixture.hpp"

namespace fpc::test_session {
namespace control_affine_law_test {

/// s follows the load q_i s_i / 2.6e6, gain 4.
AffineTerm load() { return {0, {0, 1}, 2.6e6, 4.0}; }

TEST(AffineLaw, AddsGainTimesTheRelativeProduct) {
  AffineLaw plan({load(), {1, {2}, 50.0, -100.0}}, 2);
  const Vector& sum = plan.follow(of({1950.0, 2000.0, 60.0}));
  EXPECT_NEAR(sum[0], 4.0 * (2000.0 * 1950.0 / 2.6e6 - 1.0), 1e-12);
  EXPECT_NEAR(sum[1], -100.0 * 0.2, 1e-12);
}

TEST(AffineLaw, WhatIsNotFiniteLeavesItAsItWas) {
  AffineLaw plan({load()}, 2);
  const double before = plan.follow(of({2600.0, 2000.0}))[0];
  EXPECT_NEAR(before, 4.0, 1e-12);
  EXPECT_EQ(plan.follow(of({kNaN, 2000.0}))[0], before);
}

TEST(AffineLaw, MistakesAreNamed) {
  const auto words = [](AffineTerm term) -> std::string {
    try {
      AffineLaw law({term}, 2);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing thrown";
  };
  EXPECT_NE(words({0, {1}, 0.0, 1.0}).find("term[0].about"), std::string::npos);
  EXPECT_NE(words({0, {}, 1.0, 1.0}).find("term[0].of"), std::string::npos);
  EXPECT_NE(words({2, {1}, 1.0, 1.0}).find("target"), std::string::npos);
  EXPECT_NE(words({0, {1}, 1.0, kNaN}).find("gain"), std::string::npos);
}

}  // namespace control_affine_law_test
}  // namespace fpc::test_session
