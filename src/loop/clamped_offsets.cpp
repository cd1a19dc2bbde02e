#include <algorithm>
#include <cmath>

#include "fmbpc/base/command_table.hpp"
#include "fmbpc/base/sample_clock.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/config/disturbance_source.hpp"
#include "loop/record_remarks.hpp"

namespace fpc {
namespace {

using Eigen::Index;

/// What the file offsets of these disturbances, by step.
CommandTable tableOf(const LoopFile& loop, const std::vector<Quantity>& all) {
  std::vector<std::string> names;
  for (const Quantity& q : all) names.push_back(q.name);
  CommandTable table(names);
  const SampleClock clock(loop.simulation.sample_time_s, loop.simulation.start_time_s);
  for (const auto& [time_h, command] : loop.simulation.disturbance_commands) {
    if (std::find(names.begin(), names.end(), command.name.front()) == names.end()) continue;
    table.accept(command, clock.firstStepAtHours(time_h));
  }
  return table;
}

class Clamped {
 public:
  explicit Clamped(const Quantity& of) : of_(of) {}
  void look(double asked, std::uint32_t step) {
    if (asked >= of_.lower && asked <= of_.upper) return;
    if (samples_++ == 0) first_ = step;
    const double beyond = std::max(of_.lower - asked, asked - of_.upper);
    if (!(beyond > most_)) return;
    most_ = beyond;
    worst_ = asked;
  }
  void tell(std::vector<RunRemark>& remarks) const {
    if (samples_ == 0) return;
    remarks.push_back({"an offset of " + of_.name + " was asked beyond its range (" +
                           shortText(worst_) + "), " + exactText(of_.lower) + ".." +
                           exactText(of_.upper) + (of_.unit.empty() ? "" : " [" + of_.unit + "]") +
                           ", and clamped",
                       samples_, first_});
  }

 private:
  const Quantity& of_;
  std::uint32_t samples_{}, first_{};
  double most_{}, worst_{};
};

}  // namespace

std::vector<RunRemark> clampedIn(const LoopFile& loop, const Matrix& values) {
  std::vector<RunRemark> remarks;
  const std::vector<Quantity> all = disturbancesOf(loop);
  CommandTable table = tableOf(loop, all);
  std::vector<Clamped> counts(all.begin(), all.end());
  for (std::uint32_t step = 0; step < loop.simulation.samples; ++step) {
    table.advance(step);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const ActiveCommand& entry = table.active()[i];
      if (!entry.active || entry.mode != CommandMode::kOffset) continue;
      const auto row = static_cast<Index>(i);
      const double scheduled = values.size() == 0
                                   ? loop.simulation.disturbance_nominal[row]
                                   : values(row, std::min<Index>(step, values.cols() - 1));
      counts[i].look(table.apply(i, scheduled), step);
    }
  }
  for (const Clamped& count : counts) count.tell(remarks);
  return remarks;
}

}  // namespace fpc
