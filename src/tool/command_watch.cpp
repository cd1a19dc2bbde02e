// `fmbpc watch`: becomes scripts/watch.py, which shows a running loop from its topics.
#include "fmbpc/base/input_error.hpp"
#include "runtime/plot.hpp"
#include "tool/become.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {

int watch(const std::vector<std::string>& words) {
  const std::string script = findScript("watch.py");
  require(!script.empty(), "watch", "scripts/watch.py beside the config folders");
  std::vector<std::string> line{kPython, script};
  line.insert(line.end(), words.begin(), words.end());
  become(line);
}

}  // namespace fpc::tool
