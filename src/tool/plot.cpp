// plot.png of a result folder, by scripts/plot_loop.py.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>

#include "fmbpc/loop/loop_file.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {
namespace {

namespace fs = std::filesystem;
constexpr char kPython[] = "/usr/bin/python3";

/// The script stands beside the config folders, in the source tree as in an installed package.
std::string findScript() {
  for (const auto& folder : fpc::configFolders()) {
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

std::string plot(const std::string& folder) {
  const std::string script = findScript();
  if (script.empty()) {
    std::fprintf(
        stderr,
        "fmbpc: warning: no plot, scripts/plot_loop.py not found beside the config folders\n");
    return {};
  }
  if (!runScript(script, folder)) {
    std::fprintf(stderr, "fmbpc: warning: no plot of %s\n", folder.c_str());
    return {};
  }
  return (fs::path(folder) / "plot.png").string();
}

}  // namespace fpc::tool
