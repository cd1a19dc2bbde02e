// fmbpc resolve LOOP: the one text that nodes read.
#include <iostream>

#include "fmbpc/config/loop_file.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {

int resolve(const std::string& loop, const std::vector<std::string>& set) {
  Overrides overrides;
  for (const auto& text : set) overrides.push_back(parseOverride(text));
  std::cout << resolveLoop(loop, overrides);
  return 0;
}

}  // namespace fpc::tool
