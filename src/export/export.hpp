// `fmbpc export`: a loop's law as a block in C99 or Structured Text, with vectors and test
// programs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "export/ir.hpp"

namespace fpc {

struct ExportOptions {
  bool c99{true}, structured_text{true};
  bool single{false};             ///< REAL, float
  std::string name{"law"};        ///< of files, types and functions: letters, digits
  int samples{1000};              ///< vectors
  std::uint64_t seed{1};          ///< of what happens in them
  std::string exporter{"fmbpc"};  ///< with its version, on the page
  std::string date;               ///< on the page; empty: today, or SOURCE_DATE_EPOCH
};

/// The block of a loop. @throws InputError naming what is not exported, and why.
void makeProgram(const LoopFile& loop, const ExportOptions& options, ir::Program& program);

/// Writes NAME.h, NAME.c, NAME_test.c, NAME.st, NAME_test.st, NAME_vectors.csv, NAME.md into
/// `folder`, which is made. Returns their names. @throws InputError also where nothing can be
/// written.
std::vector<std::string> exportLoop(const LoopFile& loop, const ExportOptions& options,
                                    const std::string& folder);

/// Tolerance of a block against the process, of an input's span.
constexpr double kExportTolerance = 1e-9, kSingleTolerance = 1e-4;

}  // namespace fpc
