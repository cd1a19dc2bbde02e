// What people have asked of the setpoints and what still stands, kept for controllers that come
// back.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fmbpc/base/command_table.hpp"
#include "fmbpc/base/ring.hpp"

namespace fpc {

class SetpointKeeper {
 public:
  explicit SetpointKeeper(std::vector<std::string> output_names)
      : table_(std::move(output_names)) {}

  /// @throws InputError (nothing is taken) as CommandTable::accept().
  void accept(const Command& command);
  /// A sample at `time_ns` was measured: brings what is due into force; true if that changed
  /// anything.
  bool advance(std::int64_t time_ns);
  void clear();
  /// What is in force: at most one override and one offset, stamp 0.
  std::vector<Command> inForce() const;
  /// What waits for its time, as asked.
  const std::vector<Command>& waiting() const { return waiting_; }

 private:
  CommandTable table_;
  std::vector<Command> waiting_;
};

}  // namespace fpc
