// Options of the commands that deal with runs over topics.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "tool/commands.hpp"

namespace fpc::tool {

/// Each sets `chosen` to what the command does once it is parsed.
void addReplay(CLI::App& app, ReplayArguments& a, std::function<int()>& chosen);
void addWatch(CLI::App& app, std::vector<std::string>& words, std::function<int()>& chosen);

}  // namespace fpc::tool
