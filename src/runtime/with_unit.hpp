// "s [mg/l]" for tables.
#pragma once

#include <string>
#include <vector>

namespace fpc {

/// The name alone where no unit is known or none is needed.
inline std::string withUnit(const std::vector<std::string>& names,
                            const std::vector<std::string>& units, std::size_t i) {
  const bool known = i < units.size() && !units[i].empty() && units[i] != "-";
  return known ? names[i] + " [" + units[i] + "]" : names[i];
}

}  // namespace fpc
