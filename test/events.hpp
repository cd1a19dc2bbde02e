// Events of a run, for tests: compared by code, signal and samples.
#pragma once

#include <string>
#include <vector>

#include "runtime/record.hpp"

namespace fpc::test {

/// What controller and plant said of the samples, and what was said besides.
inline std::vector<Event> eventsOf(const RunRecord& record) {
  EventList list;
  for (const SampleRecord& sample : record.samples) list.add(sample.events);
  list.add(record.events);
  return list.all();
}

/// The first one of this code and signal (empty: of any); null if there is none.
inline const Event* find(const std::vector<Event>& events, EventCode code,
                         const std::string& signal = "") {
  for (const Event& event : events)
    if (event.code == code && (signal.empty() || event.signal == signal)) return &event;
  return nullptr;
}

inline std::vector<EventCode> codesOf(const std::vector<Event>& events) {
  std::vector<EventCode> codes;
  for (const Event& event : events) codes.push_back(event.code);
  return codes;
}

/// "signal_frozen x 12..30 (19)", one each.
inline std::vector<std::string> shown(const std::vector<Event>& events) {
  std::vector<std::string> lines;
  for (const Event& e : events)
    lines.push_back(std::string(kindOf(e.code).name) + " " + e.signal + " " +
                    std::to_string(e.first) + ".." + std::to_string(e.last) + " (" +
                    std::to_string(e.count) + ")");
  return lines;
}

}  // namespace fpc::test
