#include "loop/disturbance_remarks.hpp"

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/config/disturbance_source.hpp"

namespace fpc {
namespace {

void add(const LoopFile& loop, Summary& summary) {
  LateRows late;
  const DisturbanceRecord record = makeDisturbance(loop, late);
  summary.repaired_cells = record.repaired;
  summary.implausible_cells = record.implausible;
  if (late.of == 0)
    summary.remarks.push_back(
        {"only the first row of the disturbance record falls into the run "
         "(disturbance.csv.time_unit?)",
         0, 0});
  if (late.isRounding())
    summary.remarks.push_back({std::to_string(late.rows) + " of " + std::to_string(late.of) +
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
