// Where loop files are found by name.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>

#include "base/near_names.hpp"
#include "config/loop_file.hpp"
#include "config/plant_loops.hpp"
#include "config/plugins.hpp"
#include "config/study_file.hpp"
#include "config/tuning_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

#ifndef FMBPC_SOURCE_CONFIG
#define FMBPC_SOURCE_CONFIG ""
#endif
#ifndef FMBPC_LIBRARY_TO_CONFIG
#define FMBPC_LIBRARY_TO_CONFIG ""
#endif

namespace fpc {
namespace fs = std::filesystem;

std::vector<std::string> configFolders() {
  std::vector<std::string> folders;
  const char* user = std::getenv("FMBPC_CONFIG_PATH");
  std::stringstream listed(user ? user : "");
  for (std::string folder; std::getline(listed, folder, ':');)
    if (!folder.empty()) folders.push_back(folder);
  // Where the library is installed, whatever the prefix, and else the source tree.
  const fs::path beside = (libraryFolder() / fs::path(FMBPC_LIBRARY_TO_CONFIG)).lexically_normal();
  std::error_code ignored;
  for (const fs::path& folder : {beside, fs::path(FMBPC_SOURCE_CONFIG)})
    if (!folder.empty() && fs::is_directory(folder / "loop", ignored))
      folders.push_back(folder.string());
  return folders;
}

namespace {

/// Every file of a kind, by name: config/KIND and the folders below it, in alphabetical order.
/// The first folder of the search path that has a name wins.
std::map<std::string, fs::path> filesOf(const std::string& kind) {
  std::map<std::string, fs::path> files;
  for (const auto& folder : configFolders()) {
    std::vector<fs::path> found;
    std::error_code ignored;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(folder) / kind, ignored))
      if (entry.path().extension() == ".yaml") found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    for (const auto& path : found) files.emplace(path.stem().string(), path);
  }
  return files;
}

std::vector<std::string> namesIn(const std::string& kind) {
  std::vector<std::string> names;
  for (const auto& file : filesOf(kind)) names.push_back(file.first);
  return names;
}

/// `kind` is the folder below config, and the word for such a file.
std::string find(const std::string& kind, const std::string& name_or_path) {
  const fs::path path(name_or_path);
  const bool is_path = name_or_path.find('/') != std::string::npos || path.extension() == ".yaml";
  if (is_path) {
    require(fs::is_regular_file(path), name_or_path, "an existing " + kind + " file");
    return fs::absolute(path).lexically_normal().string();
  }
  const auto files = filesOf(kind);
  const auto file = files.find(name_or_path);
  if (file != files.end()) return fs::absolute(file->second).lexically_normal().string();
  constexpr std::size_t kFew = 12;  // more names than a person reads
  const auto names = namesIn(kind);
  const std::string expected = kind + " '" + name_or_path + "': expected a path or ";
  if (names.size() <= kFew && nearest(name_or_path, names).empty())
    throw InputError(expected + "one of " + join(names));
  throw InputError(expected + "a name from config/" + kind +
                   nearNames(name_or_path, names,
                             kind == "loop" ? kLoopsListsThem : "there are " + join(names)));
}

}  // namespace

std::vector<std::string> loopNames() { return namesIn("loop"); }

std::vector<std::string> loopFiles() {
  std::vector<std::string> files;
  for (const auto& file : filesOf("loop")) files.push_back(file.second.string());
  return files;
}

std::vector<std::string> modelNames() { return namesIn("model"); }

std::string findLoop(const std::string& name_or_path) { return find("loop", name_or_path); }

std::string findStructure(const std::string& name_or_path) {
  return find("structure", name_or_path);
}

std::vector<std::string> studyNames() { return namesIn("study"); }

std::string findStudy(const std::string& name_or_path) { return find("study", name_or_path); }

std::string findPlantLoops(const std::string& name_or_path) { return find("plant", name_or_path); }

std::vector<std::string> tuningNames() { return namesIn("tuning"); }

std::string findTuning(const std::string& name_or_path) { return find("tuning", name_or_path); }

}  // namespace fpc
