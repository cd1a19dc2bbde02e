// Loops on a model, compared before they are written: what they cost, and how sensitive they are.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/loop_file.hpp"

namespace fpc::tool {

/// What counts as one: a step of each setpoint, and the move of each input that makes it.
struct RehearsalScale {
  Vector output, input;
};

/// What a loop was chosen by.
struct Rehearsed {
  std::string text;
  double cost{};  ///< mean square of errors and, a tenth of it, of moves, in steps; noise-free y
  double peak{};  ///< sensitivity, largest along the course; infinite if it does not rest
};

/// What is usually asked of the sensitivity's peak (astrom2008).
constexpr double kUsualPeak = 1.7;

/// The cheapest of these loop files (plants of type model) with a peak below kUsualPeak; if none
/// has, that with the lowest.
Rehearsed chosenOf(const std::vector<std::string>& texts, const std::string& name,
                   const RehearsalScale& scale);

/// Means over runs with noise that no loop was chosen by.
struct Judged {
  double cost{};
  Vector ise;       ///< n_y, sum of (setpoint - y)^2
  double movement;  ///< mean move a sample, in parts of the inputs' ranges, mean over inputs
};
Judged judged(const std::string& text, const std::string& name, const RehearsalScale& scale);

}  // namespace fpc::tool
