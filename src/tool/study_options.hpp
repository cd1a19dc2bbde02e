// Options of the commands that make many runs, which fmbpc_mpi has as well.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

#include "tool/commands.hpp"

namespace fpc::tool {

/// Each sets `chosen` to what the command does once it is parsed.
void addTune(CLI::App& app, TuneArguments& a, std::function<int()>& chosen);
void addStudy(CLI::App& app, StudyArguments& a, std::function<int()>& chosen);
/// The command `export`.
void addExport(CLI::App& app, std::function<int()>& chosen);

}  // namespace fpc::tool
