// Options of the commands that deal with runs over topics, and what all commands refuse.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "tool/commands.hpp"

namespace fpc::tool {

/// Each sets `chosen` to what the command does once it is parsed.
void addReplay(CLI::App& app, ReplayArguments& a, std::function<int()>& chosen);
void addRecover(CLI::App& app, RecoverArguments& a, std::function<int()>& chosen);
void addWatch(CLI::App& app, std::vector<std::string>& words, std::function<int()>& chosen);

/// An empty text where a file or folder is named is a script's variable that nobody has set: no
/// command of the app takes one. Call it when all are there.
void refuseEmptyNames(CLI::App& app);

}  // namespace fpc::tool
