// A folder of loop files that a test writes, and the words of errors.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "config/loop_file.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {

/// A folder of its own per test, empty at the start, gone at the end.
class LoopFolder : public ::testing::Test {
 protected:
  LoopFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "fmbpc_loop_XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~LoopFolder() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    return path(name);
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::filesystem::path folder_;
};

/// A short run of the shipped plant: what a loop file needs at least.
inline std::string smallLoop() {
  return "plant:\n  type: activated_sludge\nsampling:\n  sample_time_s: 720\n  duration_h: 4\n"
         "setpoint:\n  initial: {s: 55, x: 2000}\ncontroller:\n  type: pi\n  loops:\n"
         "    - {input: q_r, output: x, kp: 1, ki_per_h: 0.1}\n";
}

/// What the action throws, in one line.
inline std::string errorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& e) {
    return e.what();
  }
  return "nothing was thrown";
}

inline void expectWords(const std::string& error, std::initializer_list<std::string> words) {
  for (const auto& word : words)
    EXPECT_NE(error.find(word), std::string::npos) << "no '" << word << "' in: " << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

/// The folder of public records, or empty with a reason.
inline bool hasRecords() { return std::getenv("FMBPC_DATA") != nullptr; }

/// True if the loop reads a file of ${FMBPC_DATA}.
inline bool needsRecords(const std::string& loop) {
  return loop.rfind("asp_bsm1", 0) == 0 || loop.rfind("asp_uci", 0) == 0 ||
         (loop.rfind("bsm1_", 0) == 0 && loop.rfind("bsm1_own", 0) != 0);
}

}  // namespace fpc
