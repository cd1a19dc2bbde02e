// The summary of a run sample by sample, with memory that does not grow with the run.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "runtime/report.hpp"

namespace fpc {

class RunSummary {
 public:
  explicit RunSummary(const LoopFile& loop, std::uint32_t first_step = 0);
  RunSummary(RunSummary&&) noexcept;
  ~RunSummary();
  /// Samples in order, those without values included.
  void add(const SampleRecord& sample);
  /// `nothing_missing`: the final sample came and no sample has a hole.
  Summary finish(double wall_s, bool nothing_missing) const;

 private:
  struct Sums;
  std::unique_ptr<Sums> sums_;
};

/// toJson() in a file. @throws InputError if it cannot be written.
void writeSummary(const Summary& summary, const std::string& file);

}  // namespace fpc
