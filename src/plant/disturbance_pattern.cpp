// Seeded stand-in for the influent records (vallejo2021thesis, article 1), which
// were never published: a daily cycle with its harmonic, a slow wave and hourly noise. t in hours,
// N standard normal, phi uniform in 0..6:
//   flow: sin(2 pi (t-9)/24)  + 0.45 sin(4 pi (t-4)/24) + 0.4 sin(2 pi t/168 + phi) + 0.25 N
//   load: sin(2 pi (t-11)/24) + 0.35 sin(4 pi (t-7)/24) + 0.5 sin(2 pi t/120 + phi) + 0.35 N
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "base/random.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "plant/channel_rows.hpp"
#include "plant/disturbance.hpp"

namespace fpc {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kShortestRecordH = 24.0;
constexpr Eigen::Index kMostValues = 10'000'000;
/// In log p: farther from the root than this, the side is certain; at a usual slope of the mean
/// much less will do.
constexpr double kNear = 1e-9;
constexpr double kSmallMean = 1e-14;    // difference of means that is rounding
constexpr double kDoubt = 1e-13;        // ten times that, for the way to the sum
constexpr double kLogPowerLimit = 7.0;  // powers e^-7..e^7 reach any mean a usable shape can have

struct Shape {
  double peak_h, second, second_peak_h, slow, slow_period_h, noise;
  std::uint64_t stream;  // so that flow and load of one seed are independent
};

const std::map<std::string, Shape>& shapes() {
  static const std::map<std::string, Shape> all = {
      {"flow", {9.0, 0.45, 4.0, 0.4, 168.0, 0.25, 0}},
      {"load", {11.0, 0.35, 7.0, 0.5, 120.0, 0.35, 1}},
  };
  return all;
}

Vector hourlyValues(const Shape& shape, std::mt19937_64 engine, Eigen::Index hours) {
  const double phi = 6.0 * uniform(engine);
  Vector values(hours + 1);
  for (Eigen::Index h = 0; h <= hours; ++h) {
    const auto t = static_cast<double>(h);
    values[h] = std::sin(2.0 * kPi * (t - shape.peak_h) / 24.0) +
                shape.second * std::sin(4.0 * kPi * (t - shape.second_peak_h) / 24.0) +
                shape.slow * std::sin(2.0 * kPi * t / shape.slow_period_h + phi) +
                shape.noise * standardNormal(engine);
  }
  return values;
}

Vector interpolated(const Vector& hourly, double sample_time_h, Eigen::Index count) {
  Vector values(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double t = static_cast<double>(k) * sample_time_h;
    const auto h = std::min(static_cast<Eigen::Index>(t), hourly.size() - 2);
    values[k] = hourly[h] + (t - static_cast<double>(h)) * (hourly[h + 1] - hourly[h]);
  }
  return values;
}

struct Near {
  double at;
  bool met;  ///< f(at) is rounding
};

/// Where decreasing `f` is zero, nearly: regula falsi in low..high; an end that stays twice counts
/// half (Illinois).
Near nearRoot(const std::function<double(double)>& f, double low, double high) {
  double f_low = f(low), f_high = f(high), f_last = 0.0, at = low;
  for (int i = 0; i < 40; ++i) {
    at = std::clamp((low * f_high - high * f_low) / (f_high - f_low), low, high);
    const double f_at = f(at);
    if (std::abs(f_at) < kSmallMean) return {at, true};
    (f_at > 0.0 ? low : high) = at;
    (f_at > 0.0 ? f_low : f_high) = f_at;
    if (f_at * f_last > 0.0) (f_at > 0.0 ? f_high : f_low) *= 0.5;
    f_last = f_at;
  }
  return {at, false};
}

/// -d mean(unit^p) / d log p; `logs` are those of unit, one of which is 0 and has no share.
double steepness(const Vector& logs, double log_p) {
  const double p = std::exp(log_p);
  double sum = 0.0;
  for (const double value : logs)
    if (std::isfinite(value)) sum -= p * value * std::exp(p * value);
  return sum / static_cast<double>(logs.size());
}

/// The power p for which mean(unit^p) = mean; unit in [0,1], so the mean falls as p grows.
/// Bisection in log p; the mean is only computed where a first estimate leaves its side open.
double powerForMean(const Vector& unit, double mean, const std::string& where) {
  const auto mean_at = [&](double log_p) { return unit.array().pow(std::exp(log_p)).mean(); };
  const Vector logs = unit.array().log();
  const auto nearly = [&](double log_p) { return (std::exp(log_p) * logs.array()).exp().mean(); };
  double low = -kLogPowerLimit, high = kLogPowerLimit;
  require((nearly(low) - mean > kDoubt || mean_at(low) >= mean) &&
              (mean - nearly(high) > kDoubt || mean_at(high) <= mean),
          where + ": mean",
          "a value that the shape can have; nearer to the middle of lower..upper");
  const Near near = nearRoot([&](double log_p) { return nearly(log_p) - mean; }, low, high);
  const double open = near.met ? std::min(kNear, kDoubt / steepness(logs, near.at)) : kNear;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    const bool last = middle == low || middle == high;
    const bool above =
        std::abs(middle - near.at) > open ? middle < near.at : mean_at(middle) > mean;
    (above ? low : high) = middle;
    if (last) break;
  }
  return std::exp(0.5 * (low + high));
}

void validate(const PatternChannel& channel, const std::string& where) {
  require(shapes().count(channel.shape) == 1, where + ": shape", "one of flow, load");
  require(std::isfinite(channel.lower), where + ": lower", "a finite number");
  require(std::isfinite(channel.upper) && channel.upper > channel.lower, where + ": upper",
          "a finite number above lower");
  require(channel.mean > channel.lower && channel.mean < channel.upper, where + ": mean",
          "a number between lower and upper");
}

Vector shaped(const PatternChannel& channel, const Vector& raw, const std::string& where) {
  const double range = channel.upper - channel.lower;
  const Vector unit = (raw.array() - raw.minCoeff()) / (raw.maxCoeff() - raw.minCoeff());
  const double power = powerForMean(unit, (channel.mean - channel.lower) / range, where);
  return channel.lower + range * unit.array().pow(power);
}

}  // namespace

DisturbanceRecord makePattern(const PatternParams& params, const std::vector<std::string>& names,
                              const Vector& nominal, double sample_time_s, std::uint32_t samples) {
  require(samples > 0, "disturbance: pattern", "a run with a duration: it is scaled over the run");
  require(sample_time_s > 0.0 && std::isfinite(sample_time_s), "sampling.sample_time_s",
          "a finite number > 0");
  require(nominal.size() == static_cast<Eigen::Index>(names.size()), "disturbance.nominal",
          std::to_string(names.size()) + " numbers");
  const double sample_time_h = sample_time_s / 3600.0;
  const auto columns = static_cast<Eigen::Index>(samples) + 1;
  const auto day = static_cast<Eigen::Index>(std::ceil(kShortestRecordH / sample_time_h)) + 1;
  const Eigen::Index count = std::max(columns, day);
  require(count <= kMostValues, "sampling.sample_time_s",
          "a time with which a pattern of " + shortText(kShortestRecordH) + " h has at most " +
              std::to_string(kMostValues) + " samples");
  const auto hours =
      static_cast<Eigen::Index>(std::ceil(static_cast<double>(count - 1) * sample_time_h));
  DisturbanceRecord record;
  record.values = nominal.replicate(1, columns);
  std::map<std::string, std::uint64_t> seen;
  ChannelRows rows(names);
  for (const auto& channel : params.channels) {
    const std::string where = channelName(channel.name);
    const Eigen::Index row = rows.take(channel.name);
    validate(channel, where);
    const Shape& shape = shapes().at(channel.shape);
    const auto engine = seededEngine(params.seed, {shape.stream, seen[channel.shape]++});
    const Vector raw = interpolated(hourlyValues(shape, engine, hours), sample_time_h, count);
    record.values.row(row) = shaped(channel, raw, where).head(columns).transpose();
  }
  return record;
}

}  // namespace fpc
