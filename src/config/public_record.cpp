#include "config/public_record.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/yaml_load.hpp"
#include "config/loop_file.hpp"

namespace fpc {
namespace {

namespace fs = std::filesystem;

std::string folderInWords() {
  const char* folder = std::getenv(kRecordFolder);
  return folder == nullptr || *folder == '\0' ? "is not set" : "is '" + std::string(folder) + "'";
}

}  // namespace

std::string whereToGet(const std::string& file) {
  const std::string name = fs::path(file).filename().string();
  for (const auto& folder : configFolders()) {
    const fs::path list = fs::path(folder) / "records.yaml";
    std::ifstream stream(list);
    if (!stream) continue;
    std::ostringstream text;
    text << stream.rdbuf();
    const YAML::Node record = loadYaml(text.str(), list.string())[name];
    if (!record.IsDefined() || !record.IsMap()) continue;
    return name + " is a public record that does not ship: had from " +
           record["from"].as<std::string>("") +
           ", it goes, laid out as docs/records.md says (sha256 " +
           record["sha256"].as<std::string>("") + "), into the folder that " + kRecordFolder +
           " names; " + kRecordFolder + " " + folderInWords();
  }
  return "";
}

}  // namespace fpc
