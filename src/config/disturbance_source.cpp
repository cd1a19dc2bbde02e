#include "config/disturbance_source.hpp"

#include "config/csv_checks.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/signals.hpp"

namespace fpc {
namespace {

constexpr std::uint32_t kMostSamples = 10'000'000;  // of a record that is held as a whole

}  // namespace

void requireSimulated(const LoopFile& loop) {
  require(!loop.external_plant, loop.name + ": plant.type",
          "a plant that can be simulated; an external one runs over topics only");
}

std::vector<Quantity> disturbancesOf(const LoopFile& loop) {
  requireSimulated(loop);
  return makePlant(loop.simulation)->description().disturbances;
}

DisturbanceRecord makeDisturbance(const LoopFile& loop) {
  requireSimulated(loop);
  const SimulationParams& sim = loop.simulation;
  const DisturbanceParams& params = loop.disturbance;
  if (params.source == DisturbanceSource::kConstant) return sim.disturbance;
  require(sim.samples > 0, loop.name + ": sampling.duration_h",
          "a time > 0 with disturbance.source " + wordOf(params.source) +
              " (an endless run needs constant)");
  require(sim.samples <= kMostSamples, loop.name + ": sampling.duration_h",
          "at most 10000000 samples with disturbance.source " + wordOf(params.source));
  const auto disturbances = disturbancesOf(loop);
  const auto names = namesOf(disturbances);
  if (params.source == DisturbanceSource::kPattern)
    return makePattern(params.pattern, names, sim.disturbance_nominal, sim.sample_time_s,
                       sim.samples);
  checkCsvUnits(loop, disturbances);
  DisturbanceRecord record = readDisturbanceSequence(params.csv, names, sim.disturbance_nominal,
                                                     sim.sample_time_s, sim.samples);
  checkCsvRanges(params.csv, disturbances, record.values);
  return record;
}

}  // namespace fpc
