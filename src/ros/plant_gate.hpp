// The plant that a node serves: one that does not fit the loop file is refused, and so are runs
// that it has not announced.
#pragma once

#include <fmbpc/PlantInfo.h>

#include <cstdint>
#include <string>

#include "config/loop_file.hpp"

namespace fpc {

class PlantGate {
 public:
  explicit PlantGate(const LoopFile& loop);

  /// A plant introduces itself, at its start or before a new run: from now on its run counts,
  /// whichever number is larger. One that does not fit is logged and leaves problem().
  /// @return true if it fits. @throws InputError if the plant in service stops fitting: that
  /// message is to be refused.
  bool introduce(const fmbpc::PlantInfo& msg);
  /// False: to be dropped; it is counted.
  bool admits(std::uint64_t run_id);
  bool open() const { return open_; }  ///< a plant that fits has introduced itself
  std::uint64_t runId() const { return run_id_; }
  const std::string& problem() const { return problem_; }
  const std::string& remark() const {
    return remark_;
  }  ///< bounds that differ; it serves all the same
  std::uint64_t foreign() const { return foreign_; }  ///< messages of runs that were not announced

 private:
  std::string mismatchOf(const PlantInfo& info, const std::string& loop_digest) const;

  PlantInfo expected_;
  std::string loop_digest_;
  std::uint64_t run_id_{};
  std::string problem_, remark_;
  std::uint64_t foreign_{};
  bool open_{false};
};

}  // namespace fpc
