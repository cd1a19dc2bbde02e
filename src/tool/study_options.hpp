// Options of the commands that make many runs, which fmbpc_mpi has as well.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "tool/commands.hpp"

namespace fpc::tool {

/// Each sets `chosen` to what the command does once it is parsed.
void addTune(CLI::App& app, TuneArguments& a, std::function<int()>& chosen);
void addStudy(CLI::App& app, StudyArguments& a, std::function<int()>& chosen);
/// Words on a command that the app does not have, or on none at all; empty where there is one.
std::string unknownCommand(const CLI::App& app, int argc, char** argv);
/// What is wrong with the arguments; for an unknown command what may have been meant.
std::string wrongWith(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv);

}  // namespace fpc::tool
