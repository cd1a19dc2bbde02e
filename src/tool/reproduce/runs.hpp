// Runs that several rows of `fmbpc reproduce` share: each loop runs once in a call of the tool.
#pragma once

#include <string>

#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/loop/report.hpp"

namespace fpc::tool {

/// The run of a shipped loop in process; kept until the tool ends, nothing is stored.
const RunRecord& recordOf(const std::string& loop, const Overrides& overrides = {});
const Summary& summaryOf(const std::string& loop, const Overrides& overrides = {});
/// @throws InputError if the loop has no such output.
const OutputIndices& indicesOf(const Summary& summary, const std::string& output);

}  // namespace fpc::tool
