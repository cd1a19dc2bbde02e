#include "fmbpc/loop/plot.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "fmbpc/loop/loop_file.hpp"

namespace fpc {
namespace {

namespace fs = std::filesystem;
constexpr char kPython[] = "/usr/bin/python3";

/// The script stands beside the config folders, in the source tree as in an installed package.
std::string findScript() {
  for (const auto& folder : configFolders()) {
    const fs::path script = fs::path(folder).lexically_normal() / ".." / "scripts" / "plot_loop.py";
    if (fs::is_regular_file(script)) return script.lexically_normal().string();
  }
  return {};
}

/// Runs the script with its standard output on our standard error; true if it succeeded.
bool runScript(const std::string& script, const std::string& folder) {
  const pid_t child = fork();
  if (child < 0) return false;
  if (child == 0) {
    dup2(STDERR_FILENO, STDOUT_FILENO);
    execl(kPython, kPython, script.c_str(), folder.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

PlotResult drawPlot(const std::string& folder) {
  const std::string script = findScript();
  if (script.empty())
    return {"", "no plot: scripts/plot_loop.py not found beside the config folders"};
  if (!runScript(script, folder)) return {"", "no plot of " + folder};
  return {(fs::path(folder) / "plot.png").string(), ""};
}

}  // namespace fpc
