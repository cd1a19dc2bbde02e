#include "runtime/unplayed.hpp"

#include <algorithm>
#include <string>

#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

class Unplayed {
 public:
  explicit Unplayed(const LoopFile& loop)
      : clock_(loop.simulation.sample_time_s, loop.simulation.start_time_s),
        samples_(loop.simulation.samples) {}

  bool isLate(double time_h) const { return clock_.firstStepAtHours(time_h) > samples_; }

  void add(const std::string& key, const std::vector<double>& times_h) {
    std::size_t late = 0;
    double first = kInfinity;
    for (const double time_h : times_h) {
      if (!isLate(time_h)) continue;
      ++late;
      first = std::min(first, time_h);
    }
    if (late == 0) return;
    say(std::to_string(late) + " of " + std::to_string(times_h.size()) + " entries of " + key +
        " lie beyond the run, the first at " + exactText(first) + " h");
  }

  void say(const std::string& words) {
    remarks_.push_back(
        {words + "; the run ends at " + exactText(clock_.hoursAt(samples_)) + " h", 0, 0});
  }

  std::vector<RunRemark> take() { return std::move(remarks_); }

 private:
  SampleClock clock_;
  std::uint32_t samples_;
  std::vector<RunRemark> remarks_;
};

void addSetpoints(const LoopFile& loop, Unplayed& found) {
  std::vector<double> schedule, commands;
  for (const SetpointStep& entry : loop.setpoint.schedule) schedule.push_back(entry.time_h);
  found.add("the setpoint's schedule or recipe", schedule);
  const std::int64_t start = loop.plant_info.header.time_ns;
  for (const Command& command : loop.setpoint.commands)
    commands.push_back(static_cast<double>(command.time_ns - start) / 3600e9);
  found.add("setpoint.commands", commands);
}

void addDisturbances(const LoopFile& loop, Unplayed& found) {
  std::vector<double> commands;
  for (const ScheduledCommand& entry : loop.simulation.disturbance_commands)
    commands.push_back(entry.time_h);
  found.add("disturbance.commands", commands);
  if (loop.disturbance.source != DisturbanceSource::kCsv) return;
  const CsvDisturbanceParams& csv = loop.disturbance.csv;
  if (csv.lead_in_h > 0.0 && found.isLate(csv.lead_in_h))
    return found.say("the record of disturbance.csv never acts: it begins after " +
                     exactText(csv.lead_in_h) + " h (disturbance.csv.lead_in_h)");
  const double next_h = csv.lead_in_h + csv.next_after_h;
  if (!csv.next_file.empty() && found.isLate(next_h))
    found.say("the record of disturbance.csv.next never acts: it begins after " +
              exactText(next_h) + " h");
}

/// A window of which the run holds no sample has no figures.
void addWindows(const LoopFile& loop, Unplayed& found) {
  for (const ReportWindow& window : loop.report.windows)
    if (found.isLate(window.from_h))
      found.say("the window " + window.name + " of report.windows begins only at " +
                exactText(window.from_h) + " h and has no figures");
}

/// The final sample is one more to learn from.
void addIdentification(const LoopFile& loop, Unplayed& found) {
  const auto after = static_cast<std::int64_t>(loop.has_identify ? loop.identify.after : 0);
  const std::int64_t samples = std::int64_t{loop.simulation.samples} + 1;
  if (after > samples)
    found.say("model.identify.after: no model is identified before " + std::to_string(after) +
              " samples, the run has " + std::to_string(samples));
}

}  // namespace

std::vector<RunRemark> unplayedIn(const LoopFile& loop) {
  Unplayed found(loop);
  if (loop.simulation.samples == 0) return found.take();
  addIdentification(loop, found);
  addSetpoints(loop, found);
  addDisturbances(loop, found);
  addWindows(loop, found);
  return found.take();
}

}  // namespace fpc
