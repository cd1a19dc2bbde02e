#include "base/time_unit.hpp"

#include <map>

namespace fpc {

std::vector<std::string> timeUnits() { return {"s", "min", "h", "d", "ms"}; }

double secondsPer(const std::string& unit) {
  static const std::map<std::string, double> seconds{
      {"s", 1.0}, {"min", 60.0}, {"h", 3600.0}, {"d", 86400.0}, {"ms", 1e-3}};
  const auto found = seconds.find(unit);
  return found != seconds.end() ? found->second : 0.0;
}

}  // namespace fpc
