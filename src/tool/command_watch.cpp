// `fmbpc watch`: becomes scripts/watch.py, which shows a running loop from its topics.
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "fmbpc/base/input_error.hpp"
#include "runtime/plot.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {

int watch(const std::vector<std::string>& words) {
  const std::string script = findScript("watch.py");
  require(!script.empty(), "watch", "scripts/watch.py beside the config folders");
  std::vector<std::string> line{kPython, script};
  line.insert(line.end(), words.begin(), words.end());
  std::vector<char*> arguments;
  for (std::string& word : line) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(kPython, arguments.data());
  throw InputError(std::string(kPython) + ": expected a Python that starts (" + strerror(errno) +
                   ")");
}

}  // namespace fpc::tool
