// fmbpc new plant|controller NAME: a package that builds and whose tests pass. fmbpc new loop: see
// new_loop.cpp.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "base/files.hpp"
#include "config/loop_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {
namespace {

namespace fs = std::filesystem;

/// Of a package, a library, a type and a class.
void requirePackageName(const std::string& name) {
  const bool fits = !name.empty() && std::islower(static_cast<unsigned char>(name[0])) != 0 &&
                    std::all_of(name.begin(), name.end(), [](unsigned char c) {
                      return std::islower(c) != 0 || std::isdigit(c) != 0 || c == '_';
                    });
  require(fits, "NAME", "lower-case letters, digits and _, a letter first; got '" + name + "'");
}

/// "my_tank" -> "MyTank"
std::string classNameOf(const std::string& name) {
  std::string words;
  bool begins = true;
  for (const char c : name) {
    if (c != '_') words += begins ? static_cast<char>(std::toupper(c)) : c;
    begins = c == '_';
  }
  return words;
}

std::string filled(std::string text, const std::string& name, const std::string& kind) {
  const std::pair<const char*, std::string> blanks[] = {
      {"@name@", name}, {"@Name@", classNameOf(name)}, {"@kind@", kind}};
  for (const auto& [blank, value] : blanks)
    for (auto at = text.find(blank); at != std::string::npos; at = text.find(blank, at))
      text.replace(at, std::string(blank).size(), value);
  return text;
}

fs::path templateFolder(const std::string& part) {
  for (const std::string& config : configFolders()) {
    const fs::path folder = fs::path(config) / "template" / part;
    if (fs::is_directory(folder)) return folder;
  }
  throw InputError("fmbpc new: expected the folder template/" + part +
                   " in one of fmbpc's config folders");
}

void fill(const fs::path& from, const fs::path& to, const std::string& name,
          const std::string& kind) {
  for (const auto& entry : fs::recursive_directory_iterator(from)) {
    if (!entry.is_regular_file()) continue;
    const fs::path target = to / filled(entry.path().lexically_relative(from).string(), name, kind);
    makeFolder(target.parent_path().string());
    std::ifstream stream(entry.path());
    std::stringstream text;
    text << stream.rdbuf();
    writeText(filled(text.str(), name, kind), target.string());
  }
}

}  // namespace

int newPackage(const NewArguments& a, const std::string& kind) {
  requirePackageName(a.name);
  const fs::path folder = fs::path(a.out) / a.name;
  require(!fs::exists(folder), folder.string(), "a folder that is not there yet");
  fill(templateFolder("package"), folder, a.name, kind);
  fill(templateFolder(kind), folder, a.name, kind);
  std::cout << "written: " << folder.string()
            << "\nHow to build and test it: " << (folder / "README.md").string() << "\n";
  return 0;
}

}  // namespace fpc::tool
