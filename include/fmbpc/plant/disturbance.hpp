// Where disturbances come from: the seeded activated-sludge pattern, a user's CSV, or constants.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// A disturbance record on the loop's own samples: column k of `values` acts on [t_k, t_k + Ts).
struct DisturbanceRecord {
  Matrix values;             ///< n_d (samples + 1)
  std::uint64_t repaired{};  ///< missing cells that were held or interpolated
};

/// One channel of the pattern: [0,1]-scaled shape raised to the power that gives `mean`, mapped to lower..upper.
struct PatternChannel {
  std::string name;
  std::string shape;  ///< "flow" or "load" (the two published-like shapes, see disturbance_pattern.cpp)
  double lower{}, upper{}, mean{};
};

struct PatternParams {
  std::uint64_t seed{1};
  std::vector<PatternChannel> channels;
};

/// The seeded daily pattern: one value an hour, interpolated linearly to the samples.
/// Element order follows `names`; channels not in the pattern keep `nominal`.
/// @throws InputError naming channel and field.
DisturbanceRecord makePattern(const PatternParams& params, const std::vector<std::string>& names, const Vector& nominal,
                              double sample_time_s, std::uint32_t samples);

/// How one disturbance is taken from a CSV column: value = scale * cell + offset, or, with `mean` set, the
/// column scaled so that its mean over the record is `mean` (offset 0).
struct CsvChannel {
  std::string name;
  std::string column;
  double scale{1.0};
  double offset{0.0};
  double mean{};  ///< used if not 0
};

struct CsvDisturbanceParams {
  std::string file;
  std::string time_column;
  std::string time_unit{"h"};           ///< s, min, h, d
  std::string missing{"error"};         ///< error, hold, interpolate
  std::string interpolation{"hold"};    ///< hold (zero order) or linear
  std::string end{"error"};             ///< what if the record is shorter than the run: error, hold, repeat
  std::vector<CsvChannel> channels;
};

/// Reads and resamples a record; its first time is the loop's start.
/// @throws InputError naming file and column: unknown column, times not increasing, missing cells where not allowed,
/// nothing but missing cells, record too short.
DisturbanceRecord readDisturbances(const CsvDisturbanceParams& params, const std::vector<std::string>& names,
                                   const Vector& nominal, double sample_time_s, std::uint32_t samples);

}  // namespace fpc
