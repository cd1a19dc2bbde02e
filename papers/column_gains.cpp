#include "papers/column_gains.hpp"

namespace fpc::tool {

const Overrides& fittedBottomLoop() {
  static const Overrides fit{{"controller.loops.1.kp", "-0.13"},
                             {"controller.loops.1.integral_time_min", "16.129"}};
  return fit;
}

Overrides withGains(const ColumnGains& gains, bool feed) {
  static const char* const names[] = {"y_D/L", "y_D/V", "x_B/L", "x_B/V"};
  std::string commands = feed ? "{time_h: 0, name: F, value: 0.2}, " : "";
  for (std::size_t i = 0; i < 4; ++i)
    commands += std::string(i ? ", " : "") + "{time_h: 0, name: gain/" + names[i] +
                ", value: " + std::to_string(gains.values[i]) + "}";
  return {{"disturbance.commands", "[" + commands + "]"}};
}

}  // namespace fpc::tool
