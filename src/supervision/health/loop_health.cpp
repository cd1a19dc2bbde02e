#include "supervision/health/loop_health.hpp"

#include <algorithm>
#include <cmath>

#include "base/order_statistics.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "supervision/health/better_pi.hpp"
#include "supervision/health/finite_runs.hpp"

namespace fpc {
namespace {

constexpr std::size_t kFewestAutomatic = 200;  // samples, without which nothing is judged
constexpr std::size_t kMostForValve = 3000;    // means of samples
constexpr double kFewestForValve = 1200.0;
constexpr double kDay = 86400.0, kSamePeriod = 0.06;  // s; of a period
constexpr double kSettled = 0.2;                      // of the error's autocorrelation
constexpr double kSlow = 1.55;                        // times the usual settling
constexpr double kSlowDeadTimes = 14.0;               // where only these are given
constexpr double kSlowIndex = 0.8;
constexpr double kWorthTuning = 0.85;  // of the error, that a PI would leave
constexpr double kLongPeriod = 25.0;   // dead times
constexpr double kDriven = 0.36;       // unrest of the envelope: below it driven, above it rings
constexpr double kAtLimits = 0.3;      // share

struct CauseWords {
  const char* name;
  const char* advice;
};
constexpr CauseWords kCauses[] = {
    {"healthy", "Nothing is to be done"},
    {"unknown", "Record more of it in automatic"},
    {"sensor_frozen", "Look after the sensor and its transmission before anything else"},
    {"sensor_spikes", "Look for loose contacts and interference; filter by the median"},
    {"stiction", "Service the valve and its positioner; tuning does not mend it"},
    {"backlash", "Service the valve's linkage; a smaller gain moves it less often"},
    {"aggressive_tuning", "Lower the gain, or lengthen the horizon"},
    {"oscillating_load", "Look for the source in loops and disturbances of the same period"},
    {"at_limits", "The input has no room: look at its size and at the setpoint"},
    {"sluggish_tuning", "Raise the gain, or shorten the integral time or the horizon"},
    {"model_out_of_date", "Identify the model anew from a test"},
};
static_assert(std::size(kCauses) == static_cast<std::size_t>(LoopCause::kModelOutOfDate) + 1);

bool isAutomatic(const ControlRecord& r, std::size_t k) {
  return r.duty.empty() || r.duty[k] == LoopDuty::kAutomatic;
}

/// y - setpoint while in automatic, NaN elsewhere.
std::vector<double> errorOf(const ControlRecord& r) {
  std::vector<double> e(r.y.size(), kNaN);
  const double mean = r.setpoint.empty() ? meanOf(r.y) : 0.0;
  for (std::size_t k = 0; k < e.size(); ++k) {
    if (!isAutomatic(r, k)) continue;
    e[k] = r.y[k] - (r.setpoint.empty() ? mean : r.setpoint[k]);
  }
  return e;
}

double medianSize(const std::vector<double>& values) {
  std::vector<double> sizes = finiteOnly(values);
  for (double& v : sizes) v = std::abs(v);
  return upperMedian(std::move(sizes));
}

/// Takes out what follows a change of the setpoint, until the error has stayed within three usual
/// ones for `calm` samples.
std::vector<double> atRest(const ControlRecord& r, std::vector<double> e, std::size_t calm) {
  if (r.setpoint.empty()) return e;
  std::vector<double> known = e;
  const double mean = meanOf(e);
  for (double& v : known) v -= mean;
  const double usual = 3.0 * 1.4826 * medianSize(known);
  bool moving = false;
  std::size_t quiet = 0;
  for (std::size_t k = 1; k < e.size(); ++k) {
    const double change = std::abs(r.setpoint[k] - r.setpoint[k - 1]);
    if (!(change <= 1e-9 * (1.0 + std::abs(r.setpoint[k])))) {
      moving = true;
      quiet = 0;
    }
    if (!moving) continue;
    quiet = std::abs(known[k]) <= usual ? quiet + 1 : 0;
    if (quiet >= calm) moving = false;
    e[k] = kNaN;
  }
  return e;
}

double settlingOf(const std::vector<double>& e) {
  const auto n = static_cast<Eigen::Index>(e.size());
  for (Eigen::Index factor = 1; n / factor >= 60; factor *= 4) {
    const std::vector<double> c = autocorrelationOf(blockMeans(e, factor), 80);
    for (std::size_t lag = 1; lag < c.size(); ++lag)
      if (c[lag] < kSettled) return static_cast<double>(lag) * static_cast<double>(factor);
  }
  return static_cast<double>(n);
}

double shareOf(const ControlRecord& r, LoopDuty which) {
  const std::vector<LoopDuty>& duty = r.duty;
  if (duty.empty() && r.counts.size() == 4) {
    double all = 0.0;
    for (const std::uint64_t count : r.counts) all += static_cast<double>(count);
    return all > 0.0 ? static_cast<double>(r.counts[static_cast<std::size_t>(which)]) / all : 0.0;
  }
  if (duty.empty()) return which == LoopDuty::kAutomatic ? 1.0 : 0.0;
  return static_cast<double>(std::count(duty.begin(), duty.end(), which)) /
         static_cast<double>(duty.size());
}

double shareAtLimits(const ControlRecord& r, double& lower, double& upper) {
  double at_lower = 0.0, at_upper = 0.0, all = 0.0;
  const double near = 1e-6 * (r.u_upper - r.u_lower);
  for (std::size_t k = 0; k < r.u.size(); ++k) {
    if (!std::isfinite(r.u[k]) || !isAutomatic(r, k)) continue;
    all += 1.0;
    if (std::isfinite(near)) {
      if (r.u[k] <= r.u_lower + near) at_lower += 1.0;
      if (r.u[k] >= r.u_upper - near) at_upper += 1.0;
    }
  }
  lower = all > 0.0 ? at_lower / all : 0.0;
  upper = all > 0.0 ? at_upper / all : 0.0;
  return lower + upper;
}

/// The newest part of a series, at most `count` values.
std::vector<double> newest(const std::vector<double>& values, std::size_t count) {
  if (values.size() <= count) return values;
  return {values.end() - static_cast<std::ptrdiff_t>(count), values.end()};
}

std::vector<double> automaticOnly(const ControlRecord& r, const std::vector<double>& values) {
  std::vector<double> some = values;
  for (std::size_t k = 0; k < some.size(); ++k)
    if (!isAutomatic(r, k)) some[k] = kNaN;
  return some;
}

Eigen::Index factorFor(const LoopHealth& h, double settling) {
  // twenty means in a period, or five until the error is forgotten
  const double span = h.oscillation.found ? h.oscillation.period / 20.0 : settling / 5.0;
  const double most = static_cast<double>(h.samples) / kFewestForValve;
  return std::max<Eigen::Index>(1, static_cast<Eigen::Index>(std::floor(std::min(span, most))));
}

void judgeValve(const ControlRecord& r, LoopHealth& h, double settling) {
  const Eigen::Index factor = factorFor(h, settling);
  const std::size_t count = kMostForValve * static_cast<std::size_t>(factor);
  const double delay = std::isfinite(h.dead_time_s) ? h.dead_time_s / r.sample_time_s
                       : h.oscillation.found        ? 0.35 * h.oscillation.period
                                                    : settling;
  h.valve = fitValve(newest(automaticOnly(r, r.u), count), newest(automaticOnly(r, r.y), count),
                     static_cast<int>(std::ceil(delay / static_cast<double>(factor))), factor);
}

void judgeDynamics(const ControlRecord& r, LoopHealth& h, double settling) {
  const Eigen::Index factor =
      std::max<Eigen::Index>(1, static_cast<Eigen::Index>(std::floor(settling / 10.0)));
  const std::vector<double>& input = r.position.empty() ? r.u : r.position;
  const LoopDynamics found = loopDynamics(input, r.y, factor, r.sample_time_s);
  h.response = found.response;
  if (std::isfinite(r.dead_time_s)) {
    h.dead_time_s = r.dead_time_s;
    h.dead_time_source = DeadTimeSource::kGiven;
  } else if (std::isfinite(found.delay)) {
    h.dead_time_s = found.delay * r.sample_time_s;
    h.dead_time_source = DeadTimeSource::kEstimated;
  }
  if (!r.model.empty() && !h.response.empty()) h.model = compareModel(r.model, h.response);
}

LoopCause oscillationCause(const ControlRecord& r, const LoopHealth& h, double lower,
                           double upper) {
  if (h.valve.sticks) return LoopCause::kStiction;
  if (h.valve.plays) return LoopCause::kBacklash;
  if (std::min(lower, upper) > 0.1) return LoopCause::kAggressiveTuning;
  if (h.oscillation.unrest <= kDriven) return LoopCause::kOscillatingLoad;
  // a gain too low for its integral time swings too, but slowly
  double dead = reactionCurve(r.model.empty() ? h.response : r.model).dead_time_s;
  if (!std::isfinite(dead) && h.dead_time_source != DeadTimeSource::kAssumed)
    dead = std::max(2.0 * h.sample_time_s, h.dead_time_s);
  const bool slow = h.periodS() > kLongPeriod * dead;
  return slow ? LoopCause::kSluggishTuning : LoopCause::kAggressiveTuning;
}

/// What a PI tuned for the model would make of the record; without a model: for the response that
/// one half of it shows, on that of the other, the worse of both. Under feedback a record without
/// noise shows responses that are none; those of its halves differ.
void judgeTuning(const ControlRecord& r, LoopHealth& h, const std::vector<double>& error,
                 const std::vector<double>& rest) {
  const bool rests = finiteOnly(rest).size() >= kFewestAutomatic;
  const RecordedLoop loop{r.sample_time_s, error, rests ? rest : error, r.u, r.u_lower, r.u_upper};
  if (!r.model.empty()) {
    h.error_under_pi = errorUnderPi(loop, r.model, r.model);
    return;
  }
  if (h.response.empty()) return;
  const auto factor =
      static_cast<Eigen::Index>(std::round(h.response.sample_time_s / r.sample_time_s));
  const std::vector<double>& input = r.position.empty() ? r.u : r.position;
  const auto half = static_cast<std::ptrdiff_t>(r.y.size() / 2);
  const auto part = [half](const std::vector<double>& v, bool later) {
    return later ? std::vector<double>(v.begin() + half, v.end())
                 : std::vector<double>(v.begin(), v.begin() + half);
  };
  StepResponse shown[2];
  for (const bool later : {false, true})
    shown[later] =
        loopDynamics(part(input, later), part(r.y, later), factor, r.sample_time_s).response;
  const double one = errorUnderPi(loop, shown[0], shown[1]),
               other = errorUnderPi(loop, shown[1], shown[0]);
  h.error_under_pi = std::isfinite(one + other) ? std::max(one, other) : kNaN;
}

/// Slower than a PI of one's own for this response would be (simc, skogestad2003), by what could be
/// foretold, and worse than that PI under the same loads: a slow load makes a slow error in any
/// loop.
bool isSluggish(const ControlRecord& r, const LoopHealth& h, const std::vector<double>& rest) {
  ReactionCurve curve = reactionCurve(h.response);
  if (!r.model.empty()) curve = reactionCurve(r.model);
  double dead = curve.dead_time_s, usual = kNaN;
  if (std::isfinite(dead)) {
    usual = kSlow * (1.2 * dead + 0.55 * std::min(curve.time_constant_s, 8.0 * dead));
  } else if (h.dead_time_source == DeadTimeSource::kGiven) {
    dead = std::max(2.0 * h.sample_time_s, h.dead_time_s);
    usual = kSlowDeadTimes * dead;
  }
  if (!(h.settling_s > usual)) return false;
  if (std::isfinite(curve.dead_time_s) && !(h.error_under_pi < kWorthTuning)) return false;
  const int ahead = static_cast<int>(std::ceil(2.0 * dead / h.sample_time_s));
  return minimumVariance(rest, std::max(1, ahead)).index < kSlowIndex;
}

LoopCause causeOf(const ControlRecord& r, const LoopHealth& h, double lower, double upper,
                  const std::vector<double>& rest) {
  if (h.sensor.isFrozen()) return LoopCause::kSensorFrozen;
  if (h.sensor.hasSpikes()) return LoopCause::kSensorSpikes;
  if (h.oscillation.found && !h.isDaily()) return oscillationCause(r, h, lower, upper);
  if (h.at_limits > kAtLimits) return LoopCause::kAtLimits;
  if (h.valve.sticks) return LoopCause::kStiction;
  if (h.valve.plays) return LoopCause::kBacklash;
  if (h.model.outdated) return LoopCause::kModelOutOfDate;
  if (isSluggish(r, h, rest)) return LoopCause::kSluggishTuning;
  return LoopCause::kHealthy;
}

std::string percent(double share) { return shortText(std::round(1000.0 * share) / 10.0) + " %"; }

void remarkSensor(const ControlRecord& r, LoopHealth& h) {
  const SensorFaults& s = h.sensor;
  if (s.isFrozen())
    h.remarks.push_back("The sensor repeats one value against its own noise in " +
                        percent(s.frozen) + " of the samples, longest from sample " +
                        std::to_string(s.frozen_first) + " on for " +
                        std::to_string(s.frozen_samples));
  if (s.hasSpikes())
    h.remarks.push_back("Values that stand alone: " + percent(s.spikes) + " of the samples");
  if (s.isCoarse(h.error_std))
    h.remarks.push_back("The resolution of " + shortText(s.resolution) + " " + h.unit +
                        " is coarse beside an error of " + shortText(h.error_std));
  if (!r.u.empty()) {
    const double trend = certainTrend(r.u), trend_y = certainTrend(r.y);
    const double spread = stdOf(r.u);
    if (std::abs(trend) > 2.0 * spread && std::abs(trend_y) < stdOf(r.y))
      h.remarks.push_back("The input drifts by " + shortText(trend) + " " + h.input_unit +
                          " over the record while the output holds: a drifting sensor, fouling or "
                          "a drifting load");
  }
}

void remarkPeriod(LoopHealth& h) {
  if (h.isDaily())
    h.remarks.push_back("It swings with the day, as a load does; that is taken for no fault");
}

void remarkTest(const ControlRecord& r, LoopHealth& h) {
  if (h.response.empty()) return;
  const double end = std::abs(h.response.value.back());
  const double bounds = h.response.std.back() / end;
  const bool shows = end > 0.0 && bounds < 0.5;
  if (h.model.outdated)
    h.remarks.push_back("The model's step response is off by " + percent(h.model.distance) +
                        "; a new test would mend that");
  else if (!shows)
    h.remarks.push_back(
        "Under this feedback the record does not show the process; a test with steps of the "
        "setpoint or excitation would");
  else
    h.remarks.push_back("The record shows the step response to within " + percent(2.0 * bounds) +
                        (r.model.empty() ? "" : ", and the model agrees with it") +
                        "; a new test would bring little more");
}

void remarkHarris(LoopHealth& h) {
  if (!std::isfinite(h.harris.index)) return;
  if (h.dead_time_source == DeadTimeSource::kAssumed)
    h.remarks.push_back(
        "The dead time is not known and not seen: one sample is assumed, the index is a lower "
        "bound");
  h.remarks.push_back("Minimum-variance control would have a standard deviation of " +
                      shortText(h.harris.std_least) + " " + h.unit + ", this loop has " +
                      shortText(h.harris.std_error));
}

void remarkTuning(LoopHealth& h) {
  if (h.cause == LoopCause::kSluggishTuning && std::isfinite(h.error_under_pi))
    h.remarks.push_back("A PI tuned for the response would leave " + percent(h.error_under_pi) +
                        " of the error's standard deviation under the same loads");
}

}  // namespace

void ControlRecord::validate() const {
  require(!y.empty(), output, "a column of measured values");
  require(sample_time_s > 0.0 && std::isfinite(sample_time_s), output, "a sample time > 0");
  for (const auto* series : {&setpoint, &u, &position})
    require(series->empty() || series->size() == y.size(), output, "columns of one length");
  require(duty.empty() || duty.size() == y.size(), output, "columns of one length");
}

const char* nameOf(LoopCause cause) { return kCauses[static_cast<std::size_t>(cause)].name; }
const char* adviceOf(LoopCause cause) { return kCauses[static_cast<std::size_t>(cause)].advice; }

const char* nameOf(DeadTimeSource source) {
  constexpr const char* kNames[] = {"assumed", "estimated", "given"};
  return kNames[static_cast<std::size_t>(source)];
}

bool LoopHealth::isDaily() const {
  if (!oscillation.found) return false;
  const double days = periodS() / kDay;
  return std::abs(days - 1.0) < kSamePeriod || std::abs(2.0 * days - 1.0) < kSamePeriod;
}

LoopHealth judgeLoop(const ControlRecord& r) {
  r.validate();
  LoopHealth h;
  h.output = r.output;
  h.input = r.input;
  h.unit = r.unit;
  h.input_unit = r.input_unit;
  h.sample_time_s = r.sample_time_s;
  h.samples = static_cast<Eigen::Index>(r.y.size());
  h.hours = static_cast<double>(h.samples) * r.sample_time_s / 3600.0;
  for (const double v : r.y) h.missing += std::isfinite(v) ? 0 : 1;
  h.automatic = shareOf(r, LoopDuty::kAutomatic);
  h.manual = shareOf(r, LoopDuty::kManual);
  h.fallback = shareOf(r, LoopDuty::kFallback);
  h.held = shareOf(r, LoopDuty::kHeld);
  double lower = 0.0, upper = 0.0;
  h.at_limits = shareAtLimits(r, lower, upper);
  h.sensor = sensorFaults(r.y);
  const std::vector<double> error = errorOf(r);
  h.error_std = stdOf(error);
  h.error_mean = meanOf(error);
  double settling = settlingOf(error);
  if (!r.u.empty()) judgeDynamics(r, h, settling);
  const double dead = std::isfinite(h.dead_time_s)
                          ? std::max(1.0, std::round(h.dead_time_s / r.sample_time_s))
                          : 1.0;
  if (!std::isfinite(h.dead_time_s)) h.dead_time_s = dead * r.sample_time_s;
  const std::vector<double> rest = atRest(r, error, static_cast<std::size_t>(2.0 * dead) + 10);
  h.harris = minimumVariance(rest, static_cast<int>(dead));
  h.oscillation = findOscillation(rest);
  settling = settlingOf(rest);
  h.settling_s = settling * r.sample_time_s;
  if (finiteOnly(error).size() < kFewestAutomatic || !(h.error_std > 0.0)) return h;
  if (!r.u.empty()) judgeValve(r, h, settling);
  if (!r.u.empty()) judgeTuning(r, h, error, rest);
  h.cause = causeOf(r, h, lower, upper, rest);
  remarkHarris(h);
  remarkTuning(h);
  remarkSensor(r, h);
  remarkPeriod(h);
  remarkTest(r, h);
  return h;
}

void relateLoops(std::vector<LoopHealth>& loops) {
  constexpr double kAlike = 0.1;
  for (LoopHealth& loop : loops) {
    if (!loop.oscillation.found) continue;
    std::string others, source;
    for (const LoopHealth& other : loops) {
      if (&other == &loop || !other.oscillation.found) continue;
      if (std::abs(other.periodS() / loop.periodS() - 1.0) > kAlike) continue;
      others += (others.empty() ? "" : ", ") + other.output;
      if (other.cause == LoopCause::kStiction || other.cause == LoopCause::kBacklash ||
          other.cause == LoopCause::kAggressiveTuning)
        source = other.output;
    }
    if (others.empty()) continue;
    loop.remarks.push_back("The same period is seen in " + others +
                           (loop.cause == LoopCause::kOscillatingLoad && !source.empty()
                                ? "; " + source + " is the likely source"
                                : ""));
  }
}

std::vector<std::pair<std::string, std::string>> figuresOf(const LoopHealth& h) {
  std::vector<std::pair<std::string, std::string>> f;
  f.emplace_back("cause", nameOf(h.cause));
  f.emplace_back("input", h.input);
  f.emplace_back("hours", shortText(h.hours));
  f.emplace_back("samples", std::to_string(h.samples));
  f.emplace_back("missing", std::to_string(h.missing));
  f.emplace_back("automatic [%]", shortText(100.0 * h.automatic));
  f.emplace_back("manual [%]", shortText(100.0 * h.manual));
  f.emplace_back("fallback [%]", shortText(100.0 * h.fallback));
  f.emplace_back("held [%]", shortText(100.0 * h.held));
  f.emplace_back("at limits [%]", shortText(100.0 * h.at_limits));
  f.emplace_back("Harris index", shortText(h.harris.index));
  f.emplace_back("dead time [s]",
                 shortText(h.dead_time_s) + " (" + nameOf(h.dead_time_source) + ")");
  f.emplace_back("error, mean [" + h.unit + "]", shortText(h.error_mean));
  f.emplace_back("error, standard deviation [" + h.unit + "]", shortText(h.error_std));
  f.emplace_back("error forgotten after [s]", shortText(h.settling_s));
  f.emplace_back("period [s]", shortText(h.periodS()));
  f.emplace_back("amplitude [" + h.unit + "]", shortText(h.oscillation.amplitude));
  f.emplace_back("regularity", shortText(h.oscillation.regularity));
  const bool valve = h.valve.sticks || h.valve.plays;
  f.emplace_back("valve, dead band [" + h.input_unit + "]", valve ? shortText(h.valve.band) : "-");
  f.emplace_back("valve, slip jump [" + h.input_unit + "]", valve ? shortText(h.valve.jump) : "-");
  f.emplace_back("frozen [%]", shortText(100.0 * h.sensor.frozen));
  f.emplace_back("spikes [%]", shortText(100.0 * h.sensor.spikes));
  f.emplace_back("model, distance over the horizon [%]",
                 h.model.judged ? shortText(100.0 * h.model.distance) : "-");
  f.emplace_back("gain, record over model", h.model.judged ? shortText(h.model.gain_ratio) : "-");
  return f;
}

}  // namespace fpc
