// What a journal holds: a header that says of which loop and run, then entries of one size, one for
// each sample. Native doubles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fmbpc/loop/recorder_session.hpp"

namespace fpc {

/// What must agree before entries are read as those of a loop.
struct JournalHeader {
  char magic[8];
  std::uint64_t run_id;
  std::uint64_t sizes[5];  // outputs, disturbances, inputs, states, true disturbances
  std::uint64_t spare;
};
static_assert(sizeof(JournalHeader) == 64, "the header has no holes");

constexpr std::size_t kMostRemark = 511;  ///< letters of a sample's remarks that an entry holds

struct JournalSizes {
  std::size_t n_y, n_d, n_u, n_x, n_true;
  explicit JournalSizes(const RecordLayout& layout);
  /// Doubles of one sample: marks, times, measurement, state, tracking, base, action, report,
  /// words.
  std::size_t entry() const;
};

JournalHeader headerOf(const RecordLayout& layout, std::uint64_t run_id);
bool sameLoop(const JournalHeader& a, const JournalHeader& b);

std::vector<double> packEntry(const SampleRecord& sample, const JournalSizes& sizes);
SampleRecord unpackEntry(const double* at, const JournalSizes& sizes);

}  // namespace fpc
