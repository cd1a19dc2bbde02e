// Where disturbances come from: the seeded activated-sludge pattern, a user's CSV, or constants.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "base/column_repair.hpp"
#include "base/csv.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

/// Rows of a CSV file whose rounded times act a sample late: a row acts from the first sample at or
/// after its time (early by at most 1e-4 of an interval), one whose time was rounded up past its
/// sample from the next.
struct LateRows {
  std::uint64_t rows{};  ///< up to 2 % of a sample after one, and not early enough for it
  std::uint64_t of{};    ///< rows within the run, the first one of a file left out
  /// More than chance: records whose rows fall anywhere between samples have 2 % of such rows.
  bool isRounding() const { return rows >= 2 && 10 * rows >= of; }
};

/// A disturbance record on the loop's own samples: column k of `values` acts on [t_k, t_k + Ts).
struct DisturbanceRecord {
  Matrix values;                ///< n_d (samples + 1)
  std::uint64_t repaired{};     ///< missing cells that were held or interpolated
  std::uint64_t implausible{};  ///< cells outside `plausible` that were held or interpolated
  LateRows late{};              ///< of a CSV file; none where it is interpolated
};

/// One channel of the pattern: [0,1]-scaled shape raised to the power that gives `mean`, mapped to
/// lower..upper.
struct PatternChannel {
  std::string name;
  std::string shape;  ///< "flow" or "load", see disturbance_pattern.cpp
  double lower{}, upper{}, mean{};
};

struct PatternParams {
  std::uint64_t seed{1};
  std::vector<PatternChannel> channels;
};

/// The seeded daily pattern: one value an hour, interpolated linearly to the samples 0..`samples`,
/// scaled to [0,1] over them, raised to the power that gives `mean` over them, and mapped to
/// lower..upper. A run of less than a day takes the start of a day's record. Element order follows
/// `names`; channels not in the pattern keep `nominal`.
/// @throws InputError naming channel and field; also when samples = 0: an endless run has no record
/// to scale.
DisturbanceRecord makePattern(const PatternParams& params, const std::vector<std::string>& names,
                              const Vector& nominal, double sample_time_s, std::uint32_t samples);

/// How one disturbance is taken from a CSV column: value = scale * cell + offset, or, with `mean`
/// set, the column scaled so that the mean of all its measured cells in the file is `mean` (scale 1
/// and offset 0 then).
struct CsvChannel {
  std::string name;
  std::string column;
  double scale{1.0};
  double offset{0.0};
  double mean{};  ///< used if not 0
  double lower{-std::numeric_limits<double>::infinity()},
      upper{std::numeric_limits<double>::infinity()};  ///< plausible cells, in the file's unit;
                                                       ///< others are missing ones
};

/// Between two rows of a record.
enum class Interpolation { kHold, kLinear };
/// What if the record is shorter than the run.
enum class RecordEnd { kError, kHold, kRepeat };
inline std::vector<std::string> wordsOf(Interpolation) { return {"hold", "linear"}; }
inline std::vector<std::string> wordsOf(RecordEnd) { return {"error", "hold", "repeat"}; }

struct CsvDisturbanceParams {
  std::string file;
  std::string time_column;
  std::string time_unit{"h"};  ///< s, min, h, d; dates and times of ISO 8601 carry their own
  CsvFormat format;
  /// Not kDrop; at the ends interpolated cells take the nearest measured one.
  MissingCells missing{MissingCells::kError};
  Interpolation interpolation{Interpolation::kHold};
  RecordEnd end{RecordEnd::kError};
  std::vector<CsvChannel> channels;
  double lead_in_h{};     ///< nominal values for so long before the record begins
  std::string next_file;  ///< a record of the same columns that follows; empty: none
  double next_after_h{};  ///< ... after so much of the first one
};

/// Reads and resamples a record; its first time is the loop's start. A row acts from its time on
/// (early by at most 1e-4 of an interval, since files round their times); the last one as long as
/// the row before it. With `end: repeat` a last row that equals the first one in all channels only
/// closes the period. Where the times jump by more than one and a half of their median interval,
/// rows are missing: cells of their own, treated as `missing` says. `repaired` counts the missing
/// cells of the channels' columns in the whole file, `implausible` those outside a channel's range.
/// @throws InputError naming file, line and column: unknown column, times not increasing, missing
/// cells where not allowed, nothing but missing cells, record too short, samples = 0.
DisturbanceRecord readDisturbances(const CsvDisturbanceParams& params,
                                   const std::vector<std::string>& names, const Vector& nominal,
                                   double sample_time_s, std::uint32_t samples);
/// The same with the lead-in before it and the next record behind it. A run that is shorter
/// ends before. @throws InputError also unless these begin at a sample.
DisturbanceRecord readDisturbanceSequence(const CsvDisturbanceParams& params,
                                          const std::vector<std::string>& names,
                                          const Vector& nominal, double sample_time_s,
                                          std::uint32_t samples);

}  // namespace fpc
