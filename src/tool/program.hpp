// What the main()s of the programs behind `fmbpc` have in common.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace fpc::tool {

/// What is wrong with the arguments; for an unknown command what may have been meant.
std::string wrongWith(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv);
/// Parses, does what the command has set `chosen` to, and says what is wrong. @return the exit code
int runProgram(CLI::App& app, const std::function<int()>& chosen, int argc, char** argv);

}  // namespace fpc::tool
