// Options of the commands that deal with runs over topics, and what all commands refuse.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tool/commands.hpp"

namespace fpc::tool {

/// Each sets `chosen` to what the command does once it is parsed.
void addReplay(CLI::App& app, ReplayArguments& a, std::function<int()>& chosen);
void addRecover(CLI::App& app, RecoverArguments& a, std::function<int()>& chosen);

/// set, disturb, manual, auto, release.
void addOperate(CLI::App& app, std::function<int()>& chosen);
void addShadow(CLI::App& app, std::function<int()>& chosen);

/// `watch`, `page` and `reproduce` for the list of commands only: their words are those of other
/// programs.
void addWatch(CLI::App& app);
void addPage(CLI::App& app);
void addExport(CLI::App& app, std::function<int()>& chosen);
void addReproduce(CLI::App& app);
/// Becomes the other program if one of them is asked for, whatever stands behind it, --help too.
/// @return -1 for any other command
int runOther(int argc, char** argv);

/// An empty text where a file or folder is named is a script's variable that nobody has set: no
/// command of the app takes one. Call it when all are there.
void refuseEmptyNames(CLI::App& app);

}  // namespace fpc::tool
