#include "tool/program.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <vector>

#include "base/near_names.hpp"
#include "fmbpc/base/text.hpp"
#include "tool/printed.hpp"

namespace fpc::tool {
namespace {

/// Words on a command that the app does not have, or on none at all; empty where there is one.
std::string unknownCommand(const CLI::App& app, int argc, char** argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands(nullptr))
    commands.push_back(command->get_name());
  const bool known = std::find(commands.begin(), commands.end(), first) != commands.end();
  if (first.empty()) return "expected a command: " + join(commands);
  if (known || first[0] == '-') return "";
  const auto near = nearest(first, commands, 1);
  return "unknown command '" + first + "'" +
         (near.empty() ? ": expected one of " + join(commands) : ", did you mean " + near[0] + "?");
}

/// An empty text where a file or folder is named is a script's variable that nobody has set: no
/// command of the app takes one.
void refuseEmptyNames(CLI::App& app) {
  const CLI::Validator named(
      [](const std::string& text) { return text.empty() ? "expected a name, got none" : ""; }, "");
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; }))
    for (const char* name : {"--out", "--plots", "--commands", "--validate"})
      if (CLI::Option* option = command->get_option_no_throw(name)) option->check(named);
}

}  // namespace

std::string wrongWith(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
  const std::string unknown = unknownCommand(app, argc, argv);
  return unknown.empty() ? error.what() : unknown;
}

int runProgram(CLI::App& app, const std::function<int()>& chosen, int argc, char** argv) {
  app.require_subcommand(1);
  app.footer("fmbpc COMMAND --help: options and an example of each\n");
  refuseEmptyNames(app);
  try {
    const std::string unknown = unknownCommand(app, argc, argv);
    if (!unknown.empty()) throw std::invalid_argument(unknown);  // before its --help is answered
    app.parse(argc, argv);
    return printed(chosen());
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return printed(app.exit(e));
    std::fprintf(stderr, "fmbpc: %s\n", wrongWith(app, e, argc, argv).c_str());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "fmbpc: %s\n", e.what());
  }
  return 1;
}

}  // namespace fpc::tool
