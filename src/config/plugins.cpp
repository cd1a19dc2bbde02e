#include "config/plugins.hpp"

#include <dlfcn.h>
#include <link.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <sstream>

#include "control/registered_code.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/control/registry.hpp"
#include "fmbpc/plant/plant.hpp"
#include "plant/registered_code.hpp"

namespace fpc {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> listedIn(const char* variable) {
  const char* value = std::getenv(variable);
  std::stringstream stream(value ? value : "");
  std::vector<std::string> parts;
  for (std::string part; std::getline(stream, part, ':');)
    if (!part.empty()) parts.push_back(part);
  return parts;
}

/// "two_tanks", not "libtwo_tanks.so".
void requireBareName(const std::string& name, const std::string& where) {
  require(!name.empty(), where, "a plugin's name, got ''");
  const bool whole = name.rfind("lib", 0) == 0 && fs::path(name).extension() == ".so";
  require(!whole, where,
          "the plugin '" + fs::path(name).stem().string().substr(3) +
              "', without lib and .so, or a path; got '" + name + "'");
}

std::string findLibrary(const std::string& name, const std::string& where) {
  requireBareName(name, where);
  const std::string file = "lib" + name + ".so";
  const std::vector<std::string> folders = pluginFolders();
  std::error_code ignored;
  for (const std::string& folder : folders)
    if (fs::is_regular_file(fs::path(folder) / file, ignored))
      return (fs::path(folder) / file).string();
  throw InputError(where + ": expected a plugin, got '" + name + "' (no " + file + " in " +
                   join(folders) + "; FMBPC_PLUGIN_PATH names more folders)");
}

std::string pathOf(const std::string& name, const std::string& where) {
  if (!isPluginPath(name)) return findLibrary(name, where);
  require(fs::is_regular_file(name), where, "an existing library, got '" + name + "'");
  return name;
}

const std::string kRegistersNothing = "a library that registers plants or controllers, got ";

std::string oneLine(std::string text) {
  for (char& c : text)
    if (c == '\n') c = ' ';
  return text;
}

/// What the registries hold, and what they had to refuse.
struct Registered {
  std::size_t types{plantNames().size() + controllerNames().size()};
  std::vector<std::string> plants{refusedPlants()}, controllers{refusedControllers()};
};

/// What to expect instead; the library's path goes behind it. Nothing if all is well.
std::string whatIsWrong(const Registered& before) {
  const Registered after;
  const std::string taken = ", which is there already, from ";
  if (after.plants.size() > before.plants.size())
    return "names of its own, got the plant " + after.plants.back() + taken;
  if (after.controllers.size() > before.controllers.size())
    return "names of its own, got the controller " + after.controllers.back() + taken;
  return after.types == before.types ? kRegistersNothing : "";
}

/// True if a plant or controller was registered by this library.
bool registers(void* library) {
  link_map* own = nullptr;
  if (dlinfo(library, RTLD_DI_LINKMAP, &own) != 0) return false;
  std::vector<const void*> code = plantCode();
  for (const void* address : controllerCode()) code.push_back(address);
  return std::any_of(code.begin(), code.end(), [own](const void* address) {
    Dl_info info{};
    link_map* found = nullptr;
    return dladdr1(address, &info, reinterpret_cast<void**>(&found), RTLD_DL_LINKMAP) != 0 &&
           found == own;
  });
}

/// Of a library that could not be loaded.
std::string whyNot(const std::string& path) {
  const char* reason = dlerror();
  const std::string words = oneLine(reason ? reason : path);
  if (words.find("requireSameLayout") != std::string::npos)
    return "a library that was built against this fmbpc (build it again), got " + path;
  return "a library that this fmbpc can load: " + words;
}

/// Loads it for good (what it registered lives in it), whatever path leads to it. Returns what is
/// wrong with it, or nothing.
std::string load(const std::string& path) {
  static std::map<void*, std::string> outcomes;  // of what was loaded here
  if (void* mapped = dlopen(path.c_str(), RTLD_NOW | RTLD_NOLOAD)) {
    const auto known = outcomes.find(mapped);
    if (known != outcomes.end()) return known->second.empty() ? "" : known->second + path;
    return registers(mapped) ? "" : kRegistersNothing + path;  // linked, or another plugin needs it
  }
  const Registered before;
  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return whyNot(path);
  const std::string problem = outcomes[library] = whatIsWrong(before);
  return problem.empty() ? "" : problem + path;
}

}  // namespace

std::string libraryFolder() {
  Dl_info info{};
  return dladdr(reinterpret_cast<void*>(&loadPlugin), &info) != 0 && info.dli_fname
             ? fs::absolute(info.dli_fname).parent_path().string()
             : std::string();
}

std::vector<std::string> pluginFolders() {
  std::vector<std::string> folders = listedIn("FMBPC_PLUGIN_PATH");
  for (const auto& prefix : listedIn("CMAKE_PREFIX_PATH")) folders.push_back(prefix + "/lib");
  for (const auto& share : listedIn("ROS_PACKAGE_PATH"))
    if (fs::path(share).filename() == "share")
      folders.push_back((fs::path(share).parent_path() / "lib").string());
  if (const fs::path own = libraryFolder(); !own.empty()) folders.push_back(own.string());
  return folders;
}

bool isPluginPath(const std::string& name) { return name.find('/') != std::string::npos; }

void loadPlugin(const std::string& name, const std::string& where) {
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  const std::string problem = load(pathOf(name, where));
  if (!problem.empty()) throw InputError(where + ": expected " + problem);
}

}  // namespace fpc
