// Stages that reach into a loop: what they are told went out is what went out, inside the limits.
#include "runtime/commissioning/plant_tap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

namespace fpc {
namespace plant_tap_test {

TEST(PlantTap, WhatTheStagesSeeIsWhatWentOut) {
  PlantTap tap(kInfinity);
  const InputLimits limits{Vector::Constant(1, -10.0), Vector::Constant(1, 10.0),
                           Vector::Constant(1, 1.0)};
  Measurement now;
  now.outputs = Vector::Zero(1);
  now.input_applied = Vector::Zero(1);
  for (const double wish : {0.25, 5.0, -20.0}) {
    Vector out = Vector::Constant(1, 0.5);
    std::thread loop([&] { tap.pass(now, limits, now.input_applied, out); });
    tap.next();
    const Vector sent = tap.send(Vector::Constant(1, wish));
    loop.join();
    EXPECT_EQ(sent, out) << wish;
    EXPECT_EQ(out[0], std::min(1.0, std::max(-1.0, wish)));
  }
  EXPECT_EQ(tap.late(), 0U);
}

}  // namespace plant_tap_test
}  // namespace fpc
