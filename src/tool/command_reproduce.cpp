// `fmbpc reproduce`: becomes the program fmbpc_papers, which is built apart.
#include <filesystem>

#include "fmbpc/base/input_error.hpp"
#include "tool/become.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {

int reproduce(const std::vector<std::string>& words) {
  std::error_code error;
  const auto program =
      std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "fmbpc_papers";
  require(std::filesystem::exists(program), "reproduce",
          "the program fmbpc_papers beside this one: `scripts/build fmbpc_papers` makes it");
  std::vector<std::string> line{program.string()};
  line.insert(line.end(), words.begin(), words.end());
  become(line);
}

}  // namespace fpc::tool
