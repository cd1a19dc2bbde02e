// What `fmbpc reproduce column` shows: tables 3, 4 and 5 of Mekki and Saad on the Wood-Berry
// column.
#pragma once

#include <string>
#include <vector>

namespace fpc::tool {

/// One figure of a paper beside ours.
struct ColumnRow {
  std::string name;    ///< of the experiment
  std::string source;  ///< where the paper's figure stands
  std::string quantity;
  double paper{}, here{};
  std::string unit;
  std::string verdict;  ///< reproduced, near, or not reproducible
  std::string note;
};

/// Runs everything anew, about 0.5 s. @throws InputError if a shipped loop cannot be read.
std::vector<ColumnRow> reproduceColumn();

}  // namespace fpc::tool
