#include "runtime/disturbance_remarks.hpp"

#include "config/disturbance_source.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

void add(const LoopFile& loop, Summary& summary) {
  const DisturbanceRecord record = makeDisturbance(loop);
  summary.repaired_cells = record.repaired;
  summary.implausible_cells = record.implausible;
  const double run_h = loop.simulation.samples * loop.simulation.sample_time_s / 3600.0;
  const bool begins = loop.disturbance.csv.lead_in_h < run_h * (1.0 - 1e-9);
  if (record.late.of == 0 && begins)
    summary.remarks.push_back(
        {"only the first row of the disturbance record falls into the run "
         "(disturbance.csv.time_unit?)",
         0, 0});
  if (record.late.isRounding())
    summary.remarks.push_back({std::to_string(record.late.rows) + " of " +
                                   std::to_string(record.late.of) +
                                   " rows of the disturbance record come at most 2 % of a sample "
                                   "after one and act from the next: rounded times?",
                               0, 0});
}

}  // namespace

void addDisturbances(const LoopFile& loop, Summary& summary) {
  if (loop.external_plant || loop.disturbance.source != DisturbanceSource::kCsv) return;
  try {
    add(loop, summary);
  } catch (const InputError&) {  // not on this machine
  }
}

}  // namespace fpc
