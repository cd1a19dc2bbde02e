// Options of the commands that deal with runs over topics, and those that are other programs.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tool/commands.hpp"

namespace fpc::tool {

/// Each sets `chosen` to what the command does once it is parsed.
void addRecover(CLI::App& app, RecoverArguments& a, std::function<int()>& chosen);

/// set, disturb, manual, auto, release.
void addOperate(CLI::App& app, std::function<int()>& chosen);
void addShadow(CLI::App& app, std::function<int()>& chosen);

/// `watch`, `page`, `reproduce` and the commands of fmbpc_design for the list of commands only:
/// their words are those of other programs.
void addWatch(CLI::App& app);
void addPage(CLI::App& app);
void addReproduce(CLI::App& app);
void addDesign(CLI::App& app);
/// Becomes the other program if one of them is asked for, whatever stands behind it, --help too.
/// @return -1 for any other command
int runOther(int argc, char** argv);

}  // namespace fpc::tool
