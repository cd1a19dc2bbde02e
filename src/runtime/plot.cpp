#include "runtime/plot.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <utility>

#include "config/loop_file.hpp"

namespace fpc {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::string findScript(const std::string& name) {
  for (const auto& folder : configFolders()) {
    const fs::path script = fs::path(folder).lexically_normal() / ".." / "scripts" / name;
    if (fs::is_regular_file(script)) return script.lexically_normal().string();
  }
  return {};
}

namespace {

/// Runs the script with its standard output on our standard error; true if it succeeded.
bool runScript(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t child = fork();
  if (child < 0) return false;
  if (child == 0) {
    dup2(STDERR_FILENO, STDOUT_FILENO);
    execv(kPython, arguments.data());
    _exit(127);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// A warning, or nothing. `words`: folders first.
std::string drawWith(const std::string& name, const std::vector<std::string>& words) {
  const std::string script = findScript(name);
  if (script.empty()) return "no plot: scripts/" + name + " not found beside the config folders";
  std::vector<std::string> line{kPython, script};
  line.insert(line.end(), words.begin(), words.end());
  return runScript(std::move(line)) ? "" : "no plot of " + words.front();
}

}  // namespace

PlotResult drawPlot(const std::string& folder) {
  const std::string warning = drawWith("plot_loop.py", {folder});
  if (!warning.empty()) return {"", warning};
  return {(fs::path(folder) / "plot.png").string(), ""};
}

PlotResult drawComparison(const std::vector<std::string>& folders, const std::string& file) {
  std::vector<std::string> words = folders;
  words.insert(words.end(), {"--out", file});
  const std::string warning = drawWith("plot_loop.py", words);
  return {warning.empty() ? file : "", warning};
}

PlotResult drawModelPlots(const std::string& folder) {
  return {"", drawWith("plot_model.py", {folder})};
}

PlotResult drawStability(const std::string& folder) {
  const std::string warning = drawWith("plot_stability.py", {folder});
  if (!warning.empty()) return {"", warning};
  return {(fs::path(folder) / "root_locus.png").string(), ""};
}

PlotResult drawStudy(const std::string& folder) {
  const std::string warning = drawWith("plot_study.py", {folder});
  if (!warning.empty()) return {"", warning};
  return {(fs::path(folder) / "distributions.png").string(), ""};
}

PlotResult drawTuning(const std::string& folder) {
  const std::string warning = drawWith("plot_tuning.py", {folder});
  if (!warning.empty()) return {"", warning};
  return {(fs::path(folder) / "convergence.png").string(), ""};
}

PlotResult drawReproduction(const std::string& folder) {
  return {"", drawWith("plot_reproduce.py", {folder})};
}

}  // namespace fpc
