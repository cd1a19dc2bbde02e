#include "runtime/plot.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "config/loop_file.hpp"

#ifndef FMBPC_CONFIG_TO_PYTHON
#define FMBPC_CONFIG_TO_PYTHON "../python"
#endif

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
    execv(arguments.front(), arguments.data());
    _exit(127);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// The folder of the Python package `fmbpc`: of the source tree, or where it is installed.
std::string pythonFolder() {
  for (const auto& folder : configFolders())
    for (const char* python : {"../python", FMBPC_CONFIG_TO_PYTHON}) {
      const fs::path path = (fs::path(folder) / python).lexically_normal();
      if (fs::is_regular_file(path / "fmbpc/plots/__main__.py")) return path.string();
    }
  return {};
}

/// A warning, or nothing. `words`: folders first.
std::string drawWith(const std::string& kind, const std::vector<std::string>& words) {
  const std::string path = pythonPath();
  if (path.empty()) return "no plot: the Python package fmbpc.plots is not installed";
  std::vector<std::string> line{"/usr/bin/env", "PYTHONPATH=" + path, kPython,
                                "-m",           "fmbpc.plots",        kind};
  line.insert(line.end(), words.begin(), words.end());
  return runScript(std::move(line)) ? "" : "no plot of " + words.front();
}

}  // namespace

std::string pythonPath() {
  const std::string folder = pythonFolder();
  const char* others = std::getenv("PYTHONPATH");
  return folder.empty() || others == nullptr ? folder : folder + ":" + others;
}

PlotResult drawPlot(const std::string& folder) {
  const std::string warning = drawWith("run", {folder});
  if (!warning.empty()) return {"", warning};
  return {(fs::path(folder) / "plot.png").string(), ""};
}

PlotResult drawComparison(const std::vector<std::string>& folders, const std::string& file) {
  std::vector<std::string> words = folders;
  words.insert(words.end(), {"--out", file});
  const std::string warning = drawWith("run", words);
  return {warning.empty() ? file : "", warning};
}

PlotResult drawModelPlots(const std::string& folder) { return {"", drawWith("model", {folder})}; }

PlotResult drawStability(const std::string& folder) {
  const std::string warning = drawWith("stability", {folder});
  if (!warning.empty()) return {"", warning};
  return {(fs::path(folder) / "root_locus.png").string(), ""};
}

PlotResult drawStudy(const std::string& folder) {
  const std::string warning = drawWith("study", {folder});
  if (!warning.empty()) return {"", warning};
  return {(fs::path(folder) / "distributions.png").string(), ""};
}

PlotResult drawTuning(const std::string& folder) {
  const std::string warning = drawWith("tuning", {folder});
  if (!warning.empty()) return {"", warning};
  return {(fs::path(folder) / "convergence.png").string(), ""};
}

PlotResult drawCommissioning(const std::string& folder) {
  return {"", drawWith("commissioning", {folder})};
}

PlotResult drawReproduction(const std::string& folder) {
  return {"", drawWith("reproduce", {folder})};
}

}  // namespace fpc
