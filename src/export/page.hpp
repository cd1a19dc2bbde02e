// The page that goes with an exported block. Private to the room.
#pragma once

#include <string>

#include "export/export.hpp"
#include "export/print.hpp"

namespace fpc {

std::string exportPage(const LoopFile& loop, const ir::Program& program,
                       const ExportIdentity& identity, const ExportOptions& options);

}  // namespace fpc
