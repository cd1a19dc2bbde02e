// Stages that reach into a loop: what they are told went out is what went out, inside the limits.
#include "runtime/commissioning/plant_tap.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "session_fixture.hpp"

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

using PlantTapSession = test_session::SessionFixture;

// A law that restarts begins at the applied input. What the test adds is in it already.
TEST_F(PlantTapSession, ARestartedLawDoesNotTakeTheTestsLevelForItsOwn) {
  const auto tap = std::make_shared<PlantTap>(kInfinity);
  session->announce(1);
  session->test(tap);
  double applied = 570.0;
  for (std::uint32_t step = 0; step < 20; step += 2) {  // each other sample is lost
    std::thread loop([&] { session->receive(test_session::sample(step, 1, applied)); });
    const Vector present = tap->next().present;
    tap->send(present.array() + 10.0);
    loop.join();
    applied = input();
  }
  EXPECT_EQ(law->resets.size(), 10U);
  EXPECT_DOUBLE_EQ(applied, 570.0 + 10.0 + 10.0);  // one for each sample by the law
}

}  // namespace plant_tap_test
}  // namespace fpc
