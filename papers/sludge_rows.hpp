// Rows that the control experiments of the activated-sludge thesis share. Its disturbance records
// were never published; the seeded pattern stands for them, so that only ratios between controllers
// on the same data can be compared, over many seeds.
#pragma once

#include <string>

#include "papers/runs.hpp"

namespace fpc::tool {

inline constexpr char kUnpublished[] =
    "curves only; the paper's influent record was never published";

/// ISE of one output, one loop against another, seed by seed.
Values iseRatio(const std::string& loop, const std::string& baseline, const std::string& output);
/// Statement: the ratio is at most 1 (or at least, kHigher).
ReproduceRow ahead(const std::string& loop, const std::string& baseline, const std::string& output,
                   const std::string& note, Direction side = Direction::kLower);
/// Statement: the ratio is 1 within 15 %.
ReproduceRow alike(const std::string& loop, const std::string& baseline, const std::string& output,
                   const std::string& note);
/// Root mean square of an output about its reference trajectory [its unit].
Values trackingOver(const std::string& loop, const std::string& output);
Values rmseOver(const std::string& loop, const std::string& output);
using OfInput = double (*)(const InputIndices&);
Values inputOver(const std::string& loop, OfInput what);
double largestInput(const InputIndices& u);
double smallestInput(const InputIndices& u);
double inputRange(const InputIndices& u);
double meanMove(const InputIndices& u);
/// Statement: x follows its reference within 5 % of `setpoint`; the 5 % are ours.
ReproduceRow followsReference(const std::string& loop, double setpoint);
/// rmse of s, range and mean move of q_r beside curves.
ReproduceRow substrateBeside(const std::string& loop);
ReproduceRow inputBeside(const std::string& loop);

}  // namespace fpc::tool
