// fmbpc resolve LOOP: the one text that nodes read.
#include <iostream>

#include "config/loop_file.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {

int resolve(const std::string& loop, const std::vector<std::string>& set, const std::string& sets,
            bool on_model) {
  Overrides overrides;
  if (on_model) overrides.emplace_back("plant.type", "model");
  for (const auto& text : set) overrides.push_back(parseOverride(text));
  for (const auto& override : parseOverrides(sets)) overrides.push_back(override);
  std::cout << resolveLoop(loop, overrides);
  return 0;
}

}  // namespace fpc::tool
