// What timers and messages of a node call must not end it.
#include "ros/guard.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace fpc {
namespace ros_guard_test {

/// What became of a handler, in words.
template <typename Handler>
std::string told(Handler handler) {
  std::string words = "nothing";
  callGuarded(
      handler, [&](const std::string& why) { words = "refused: " + why; },
      [&](const std::string& what) { words = "mishap: " + what; });
  return words;
}

TEST(Guard, NothingIsToldOfAHandlerThatReturns) {
  bool called = false;
  EXPECT_EQ(told([&] { called = true; }), "nothing");
  EXPECT_TRUE(called);
}

TEST(Guard, WhatAHandlerThrowsGoesNoFurther) {
  const auto refusal = [] { throw InputError("setpoint: another size"); };
  const auto mishap = [] { throw std::runtime_error("no memory"); };
  const auto unknown = [] { throw 7; };
  ASSERT_NO_THROW(told(refusal));
  ASSERT_NO_THROW(told(mishap));
  ASSERT_NO_THROW(told(unknown));
  EXPECT_EQ(told(refusal), "refused: setpoint: another size");
  EXPECT_EQ(told(mishap), "mishap: no memory");
  EXPECT_EQ(told(unknown), "mishap: an exception of unknown kind");
}

}  // namespace ros_guard_test
}  // namespace fpc
