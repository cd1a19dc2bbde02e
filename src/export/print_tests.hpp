// Test programs of an exported block. Private to the room.
#pragma once

#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "export/ir.hpp"

namespace fpc {

/// Plays NAME_vectors.csv, in either precision.
std::string cTest(const LoopFile& loop, const ir::Program& program,
                  const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);
/// A block that tests itself, one embedded vector a call.
std::string structuredTextTest(const LoopFile& loop, const ir::Program& program,
                               const std::vector<std::string>& inputs,
                               const std::vector<std::string>& outputs,
                               const std::vector<std::vector<double>>& rows);

}  // namespace fpc
