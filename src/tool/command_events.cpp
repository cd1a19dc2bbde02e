// fmbpc events: what a loop may say of itself, or docs/events.md.
#include <iostream>

#include "fmbpc/base/event.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {

int events(const std::vector<std::string>& codes) {
  for (const std::string& code : codes) {
    const EventKind& kind = kindOf(eventCode(code));
    std::cout << kind.name << " (" << nameOf(kind.severity) << ")\n  cause: " << kind.cause
              << "\n  consequence: " << kind.consequence << "\n  remedy: " << kind.remedy << "\n";
  }
  if (codes.empty()) std::cout << eventsPage();
  return 0;
}

}  // namespace fpc::tool
