// Units of time as files and column headers write them.
#pragma once

#include <string>
#include <vector>

namespace fpc {

std::vector<std::string> timeUnits();  ///< s, min, h, d
/// Seconds in a unit; 0 if it is none of timeUnits().
double secondsPer(const std::string& unit);

}  // namespace fpc
