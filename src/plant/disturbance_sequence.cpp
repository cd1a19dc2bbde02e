// Records one after the other, as a benchmark's protocol asks: constant, then one file, then
// another.
#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "plant/disturbance.hpp"

namespace fpc {
namespace {

/// A time as a number of samples, at most `most`: a shorter run ends before.
std::uint32_t wholeSamples(double hours, double sample_time_s, std::uint32_t most,
                           const std::string& key) {
  const double samples = hours * 3600.0 / sample_time_s;
  const double whole = std::round(samples);
  require(std::isfinite(hours) && hours >= 0.0 &&
              std::abs(samples - whole) <= 1e-6 * std::max(1.0, samples),
          key, "a whole number of samples, got " + exactText(hours) + " h");
  return static_cast<std::uint32_t>(std::min(whole, static_cast<double>(most)));
}

}  // namespace

DisturbanceRecord readDisturbanceSequence(const CsvDisturbanceParams& params,
                                          const std::vector<std::string>& names,
                                          const Vector& nominal, double sample_time_s,
                                          std::uint32_t samples) {
  if (params.lead_in_h == 0.0 && params.next_file.empty())
    return readDisturbances(params, names, nominal, sample_time_s, samples);
  const std::uint32_t lead =
      wholeSamples(params.lead_in_h, sample_time_s, samples, "disturbance.csv.lead_in_h");
  std::uint32_t first = samples - lead;
  if (!params.next_file.empty()) {
    first = wholeSamples(params.next_after_h, sample_time_s, first, "disturbance.csv.next.after_h");
    require(params.next_after_h > 0.0, "disturbance.csv.next.after_h", "a time > 0");
  }
  if (lead == samples) return {nominal.replicate(1, static_cast<Eigen::Index>(samples) + 1), 0};
  DisturbanceRecord result = readDisturbances(params, names, nominal, sample_time_s, first);
  Matrix values(nominal.size(), static_cast<Eigen::Index>(samples) + 1);
  values.leftCols(lead) = nominal.replicate(1, lead);
  values.middleCols(lead, first + 1) = result.values;
  if (lead + first < samples) {
    CsvDisturbanceParams next = params;
    next.file = params.next_file;
    const DisturbanceRecord second =
        readDisturbances(next, names, nominal, sample_time_s, samples - lead - first);
    values.rightCols(samples - lead - first + 1) = second.values;
    result.repaired += second.repaired;
    result.implausible += second.implausible;
    result.late.rows += second.late.rows;
    result.late.of += second.late.of;
  }
  result.values = std::move(values);
  return result;
}

}  // namespace fpc
