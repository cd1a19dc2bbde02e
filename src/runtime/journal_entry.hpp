// What a journal holds: a header that says of which loop and run, then entries of one size, one for
// each sample. Native doubles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <istream>
#include <string>
#include <vector>

#include "runtime/recorder_session.hpp"

namespace fpc {

/// At the beginning of the file; behind it `about_bytes` of text, then the entries.
struct JournalHeader {
  char magic[8];
  std::uint64_t run_id;
  std::uint64_t sizes[5];  // outputs, disturbances, inputs, states, true disturbances
  std::uint64_t about_bytes;
  std::int64_t began_ns;     // on the steady clock of the machine: when its first sample came
  std::uint64_t first_step;  // of its first entry
};
static_assert(sizeof(JournalHeader) == 80, "the header has no holes");

constexpr std::size_t kMostOfEvents = 511;  ///< letters that an entry holds
/// Those for which an entry has room, so that a run on disk and one in memory say the same.
void keepWhatFits(std::vector<Event>& events);

struct JournalSizes {
  std::size_t n_y, n_d, n_u, n_x, n_true;
  explicit JournalSizes(const RecordLayout& layout);
  /// Doubles of one sample: marks, times, measurement, state, tracking, base, action, report,
  /// words.
  std::size_t entry() const;
};

JournalHeader headerOf(const RecordLayout& layout, std::uint64_t run_id);
bool sameLoop(const JournalHeader& a, const JournalHeader& b);
/// Of which loop it is: name, names of the signals, text. Must agree as well.
std::string aboutOf(const RecordLayout& layout);
/// Reads both; false if they are not there, or of another version.
bool readHead(std::istream& stream, JournalHeader& header, std::string& about);

std::vector<double> packEntry(const SampleRecord& sample, const JournalSizes& sizes);
SampleRecord unpackEntry(const double* at, const JournalSizes& sizes);

}  // namespace fpc
