// What a loop file asks for that cannot be: entries beyond the run, what is overruled, cells of the
// disturbance record, outputs that show an input later than the model expects.
#include <algorithm>
#include <cmath>

#include "config/disturbance_source.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/plant/plant.hpp"
#include "runtime/run_events.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kSeen = 0.05;  // of a sample: less of an input's effect is none

bool predicts(const LoopFile& loop) {
  return loop.has_model && loop.controller && loop.controllerType().needs_model;
}

/// Entries that lie beyond the run.
class BeyondRun {
 public:
  BeyondRun(const LoopFile& loop, EventList& list)
      : clock_(loop.simulation.sample_time_s, loop.simulation.start_time_s),
        samples_(loop.simulation.samples),
        list_(list) {}

  bool isLate(double time_h) const { return clock_.firstStepAtHours(time_h) > samples_; }

  void add(const std::string& key, const std::vector<double>& times_h) {
    std::size_t late = 0;
    double first = kInfinity;
    for (const double time_h : times_h) {
      if (!isLate(time_h)) continue;
      ++late;
      first = std::min(first, time_h);
    }
    if (late > 0)
      say(std::to_string(late) + " of " + std::to_string(times_h.size()) + " entries of " + key +
          " lie beyond the run, the first at " + exactText(first) + " h");
  }

  void say(const std::string& text) {
    list_.add(eventOf(EventCode::kBeyondRun,
                      text + "; the run ends at " + exactText(clock_.hoursAt(samples_)) + " h"));
  }

 private:
  SampleClock clock_;
  std::uint32_t samples_;
  EventList& list_;
};

void addSetpoints(const LoopFile& loop, BeyondRun& found) {
  std::vector<double> schedule, commands;
  for (const SetpointStep& entry : loop.setpoint.schedule) schedule.push_back(entry.time_h);
  found.add("the setpoint's schedule or recipe", schedule);
  const std::int64_t start = loop.plant_info.header.time_ns;
  for (const Command& command : loop.setpoint.commands)
    commands.push_back(static_cast<double>(command.time_ns - start) / 3600e9);
  found.add("setpoint.commands", commands);
}

void addDisturbances(const LoopFile& loop, BeyondRun& found) {
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

void addBeyondRun(const LoopFile& loop, EventList& list) {
  if (loop.simulation.samples == 0) return;
  BeyondRun found(loop, list);
  // The final sample is one more to learn from.
  const auto after = static_cast<std::int64_t>(loop.has_identify ? loop.identify.after : 0);
  const std::int64_t samples = std::int64_t{loop.simulation.samples} + 1;
  if (after > samples)
    found.say("model.identify.after: no model is identified before " + std::to_string(after) +
              " samples, the run has " + std::to_string(samples));
  addSetpoints(loop, found);
  addDisturbances(loop, found);
  for (const ReportWindow& window : loop.report.windows)
    if (found.isLate(window.from_h))  // it has no sample, and no figures
      found.say("the window " + window.name + " of report.windows begins only at " +
                exactText(window.from_h) + " h and has no figures");
}

bool givenByPattern(const LoopFile& loop, const std::string& name) {
  const auto& channels = loop.disturbance.pattern.channels;
  return loop.disturbance.source == DisturbanceSource::kPattern &&
         std::any_of(channels.begin(), channels.end(),
                     [&](const PatternChannel& channel) { return channel.name == name; });
}

void addOverruled(const LoopFile& loop, EventList& list) {
  if (loop.external_plant) return;
  const auto all = makePlant(loop.simulation)->description().disturbances;
  const Vector& asked = loop.simulation.disturbance_nominal;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (asked[static_cast<Index>(i)] != all[i].nominal && givenByPattern(loop, all[i].name))
      list.add(eventOf(EventCode::kNominalOverruled, "", all[i].name));
}

/// The setpoint of the schedule that is farthest beyond the data, NaN if none is.
double beyondData(const LoopFile& loop, Index output, const SignalInfo& data) {
  double worst = std::nan(""), most = 0.0;
  const auto look = [&](double asked) {
    const double beyond = std::max(data.lower - asked, asked - data.upper);
    if (!(beyond > most)) return;
    most = beyond;
    worst = asked;
  };
  look(loop.setpoint.initial[output]);
  for (const SetpointStep& step : loop.setpoint.schedule)
    if (output < step.value.size()) look(step.value[output]);
  return worst;
}

void addSetpointsOutside(const LoopFile& loop, EventList& list) {
  if (!predicts(loop)) return;
  for (const Index i : loop.controller->signalUse(controllerContext(loop)).followed) {
    if (i >= static_cast<Index>(loop.model.outputs.size())) continue;
    const SignalInfo& data = loop.model.outputs[static_cast<std::size_t>(i)];
    if (!std::isfinite(data.lower) || !std::isfinite(data.upper)) continue;
    const double asked = beyondData(loop, i, data);
    if (std::isfinite(asked))
      list.add(eventOf(EventCode::kSetpointOutsideModel,
                       data.name + " is asked to be " + shortText(asked) +
                           ", where the model has no data (" + shortText(data.lower) + " to " +
                           shortText(data.upper) + ")",
                       data.name));
  }
}

/// From one reading of the record.
void addRecord(const LoopFile& loop, EventList& list) {
  const DisturbanceRecord record = makeDisturbance(loop);
  const auto cells = [&](std::uint64_t count, EventCode code, const char* what) {
    if (count > 0)
      list.add(eventOf(code, std::to_string(count) + what + " cells of the disturbance record"));
  };
  cells(record.repaired, EventCode::kCellsFilled, " missing");
  cells(record.implausible, EventCode::kCellsImplausible, " implausible");
  const double run_h = loop.simulation.samples * loop.simulation.sample_time_s / 3600.0;
  const bool begins = loop.disturbance.csv.lead_in_h < run_h * (1.0 - 1e-9);
  if (record.late.of == 0 && begins) list.add(eventOf(EventCode::kRecordUnused));
  if (record.late.isRounding())
    list.add(eventOf(EventCode::kTimesRounded,
                     std::to_string(record.late.rows) + " of " + std::to_string(record.late.of) +
                         " rows of the disturbance record come at most 2 % of a sample after one "
                         "and act from the next"));
}

/// The least lag of an input in the model of this output; -1: none acts on it.
int leastInputLag(const OutputModel& output) {
  int least = -1;
  for (const Regressor& r : output.regressors)
    if (r.kind == SignalKind::kInput) least = least < 0 ? r.lag : std::min(least, r.lag);
  return least;
}

}  // namespace

void addFileEvents(const LoopFile& loop, EventList& list) {
  addBeyondRun(loop, list);
  addOverruled(loop, list);
  addSetpointsOutside(loop, list);
  if (loop.external_plant || loop.disturbance.source != DisturbanceSource::kCsv) return;
  try {
    addRecord(loop, list);
  } catch (const InputError&) {  // it is the plant's, not on this machine
  }
}

// What u(k) does is in y(k + 1 + lag) of the model, and cannot be seen before its line lets it by.
std::vector<Event> delayEvents(const LoopFile& loop, const std::vector<double>& delays_s,
                               std::uint32_t step) {
  std::vector<Event> events;
  if (step > 0 || !predicts(loop)) return events;
  const TsModel& model = loop.model;
  for (std::size_t i = 0; i < std::min(delays_s.size(), model.submodels.size()); ++i) {
    const int lag = leastInputLag(model.submodels[i]);
    const double expected_s = (lag + 1) * model.sample_time_s;
    if (lag < 0 || delays_s[i] < expected_s - kSeen * model.sample_time_s) continue;
    const std::string text = model.outputs[i].name + " shows an input only after " +
                             shortText(delays_s[i]) + " s (tf.sample_lines), where model '" +
                             model.name + "' expects it within " + shortText(expected_s) + " s";
    events.push_back(
        eventOf({EventCode::kOutputDelayed, text.c_str(), model.outputs[i].name.c_str()}, step));
  }
  return events;
}

}  // namespace fpc
