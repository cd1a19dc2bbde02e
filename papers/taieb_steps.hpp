// Step indices of the loops of taieb2017, averaged, for several experiments.
#pragma once

#include <string>
#include <vector>

#include "analysis/performance.hpp"
#include "config/loop_file.hpp"

namespace fpc::tool {

inline constexpr char kTaieb[] = "taieb2017";

/// Every step of one output of a shipped loop; times in units of `unit_s` seconds.
/// @throws InputError if the setpoint never steps: nothing was followed.
std::vector<StepIndices> stepsOf(const std::string& loop, Eigen::Index output, double unit_s,
                                 const Overrides& overrides = {});
/// Rise, settling, overshoot and offset, each averaged. @throws InputError without steps.
StepIndices meanOf(const std::vector<StepIndices>& steps);
/// Sum of squares of all inputs of a run, each in shares of the input at its start.
double inputEnergy(const std::string& loop, const Overrides& overrides = {});

}  // namespace fpc::tool
