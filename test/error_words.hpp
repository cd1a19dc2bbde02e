// What is thrown, and the words of it.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "fmbpc/base/input_error.hpp"

namespace fpc::test {

/// What the action throws, in one line.
inline std::string thrownBy(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& e) {
    return e.what();
  }
  return "nothing was thrown";
}

inline void expectWords(const std::string& error, const std::string& words) {
  EXPECT_NE(error.find(words), std::string::npos) << error;
}

}  // namespace fpc::test
