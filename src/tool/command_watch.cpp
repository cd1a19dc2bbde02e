// `fmbpc watch` and `fmbpc page` become scripts: one shows a running loop from its topics, the
// other writes a finished run as a page.
#include <cstdlib>
#include <filesystem>

#include "fmbpc/base/input_error.hpp"
#include "runtime/plot.hpp"
#include "tool/become.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {

namespace {

[[noreturn]] void becomeScript(const char* command, const char* name,
                               const std::vector<std::string>& words) {
  const std::string script = findScript(name);
  require(!script.empty(), command, std::string("scripts/") + name + " beside the config folders");
  std::vector<std::string> line{kPython, script};
  line.insert(line.end(), words.begin(), words.end());
  become(line);
}

}  // namespace

int watch(const std::vector<std::string>& words) { becomeScript("watch", "watch.py", words); }

int page(std::vector<std::string> words) {
  std::error_code none;
  words.insert(words.end(), {"--tool", std::filesystem::read_symlink("/proc/self/exe", none)});
  if (const std::string path = pythonPath(); !path.empty()) setenv("PYTHONPATH", path.c_str(), 1);
  becomeScript("page", "../python/panel/page.py", words);
}

}  // namespace fpc::tool
