// Commands and models that were refused in a run, for the remarks of its record. Private to the
// room.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/record.hpp"

namespace fpc {

class OperatorNotes {
 public:
  /// A command that was not done, due at `step`. The first twenty are kept in words, others
  /// counted.
  void refused(std::uint32_t step, const std::string& words);
  /// What did not go as asked without a command, kept in the same way.
  void failed(std::uint32_t step, const std::string& words);
  std::vector<RunRemark> remarks() const;

 private:
  void keep(std::uint32_t step, const std::string& remark);

  std::vector<RunRemark> refused_;
  std::uint64_t more_{};
};

}  // namespace fpc
