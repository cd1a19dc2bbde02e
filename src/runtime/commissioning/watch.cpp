#include "runtime/commissioning/watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "identification/feedback_share.hpp"
#include "supervision/flat_line.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kSettledShare = 0.3;           // of the record, at its start, is left out
constexpr double kNormal = 0.6744897501960817;  // median of |N(0,1)|
constexpr double kClearPeriod = 0.5;            // correlation one period later that stands out
constexpr double kAnswers = 0.05;               // share of news that is feedback
constexpr double kSame = 1e-9;

std::vector<double> numbersOf(const Vector& values) {
  std::vector<double> numbers;
  for (const double v : values)
    if (std::isfinite(v)) numbers.push_back(v);
  return numbers;
}

/// From second differences, which a slow signal hardly has; of white noise their variance is six
/// times its own. Robust: by the median.
double noiseOf(const std::vector<double>& y) {
  std::vector<double> bends;
  for (std::size_t k = 2; k < y.size(); ++k)
    bends.push_back(std::abs(y[k] - 2.0 * y[k - 1] + y[k - 2]));
  if (bends.empty()) return 0.0;
  const double by_median = median(bends) / kNormal / std::sqrt(6.0);
  if (by_median > 0.0) return by_median;
  double square = 0.0;
  for (const double b : bends) square += b * b;
  return std::sqrt(square / (6.0 * static_cast<double>(bends.size())));
}

double smallestStep(const std::vector<double>& y) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < y.size(); ++k) {
    const double step = std::abs(y[k] - y[k - 1]);
    if (step > kSame * std::max(1.0, std::abs(y[k]))) least = std::min(least, step);
  }
  return std::isfinite(least) ? least : 0.0;
}

/// All steps are whole multiples of the smallest.
bool isGrid(const std::vector<double>& y, double q) {
  if (q <= 0.0) return false;
  std::size_t steps = 0;
  for (std::size_t k = 1; k < y.size(); ++k) {
    const double parts = (y[k] - y[k - 1]) / q;
    if (std::abs(parts - std::round(parts)) > 0.02) return false;
    steps += std::abs(parts) > 0.5 ? 1 : 0;
  }
  return steps >= 3;
}

double correlation(const std::vector<double>& y, std::size_t lag) {
  double mean = 0.0, square = 0.0, product = 0.0;
  for (const double v : y) mean += v;
  mean /= static_cast<double>(y.size());
  for (std::size_t k = 0; k < y.size(); ++k) {
    square += (y[k] - mean) * (y[k] - mean);
    if (k >= lag) product += (y[k] - mean) * (y[k - lag] - mean);
  }
  return square > 0.0 ? product / square : 0.0;
}

void lookAtTime(const std::vector<double>& y, double sample_time, double noise, double deviation,
                WatchedOutput& out) {
  if (y.size() < 20 || deviation <= 0.0) return;
  const double signal = std::max(1.0 - noise * noise / (deviation * deviation), 0.05);
  std::size_t lag = 1;
  while (lag < y.size() / 2 && correlation(y, lag) > signal * std::exp(-1.0)) ++lag;
  out.memory_s = static_cast<double>(lag) * sample_time;
  std::size_t trough = 0;
  for (std::size_t k = 2; k < y.size() / 3; ++k) {
    const double c = correlation(y, k);
    if (c < -kClearPeriod * signal && trough == 0) trough = k;
    if (trough > 0 && c > kClearPeriod * signal && c >= correlation(y, k + 1)) {
      out.period_s = static_cast<double>(k) * sample_time;
      return;
    }
  }
}

WatchedOutput lookAtOutput(const SignalInfo& signal, const Vector& all, Index first,
                           double sample_time) {
  WatchedOutput out;
  out.name = signal.name;
  const Vector part = all.tail(all.size() - first);
  const std::vector<double> y = numbersOf(part);
  out.missing = 1.0 - static_cast<double>(y.size()) / static_cast<double>(part.size());
  if (y.size() < 3) {
    out.frozen = true;
    return out;
  }
  double sum = 0.0, square = 0.0;
  for (const double v : y) sum += v;
  out.mean = sum / static_cast<double>(y.size());
  for (const double v : y) square += (v - out.mean) * (v - out.mean);
  out.deviation = std::sqrt(square / static_cast<double>(y.size()));
  out.noise = noiseOf(y);
  const double q = smallestStep(y);
  if (isGrid(y, q)) {
    out.resolution = q;
    out.quantised = out.noise < q;
    out.noise = std::max(out.noise, q / std::sqrt(12.0));
  }
  FlatLine flat;
  for (const double v : numbersOf(all)) {
    flat.add(v);
    out.frozen = out.frozen || flat.isUnlikely();
  }
  lookAtTime(y, sample_time, out.noise, out.deviation, out);
  const std::size_t half = y.size() / 2;
  double early = 0.0, late = 0.0;
  for (std::size_t k = 0; k < y.size(); ++k) (k < half ? early : late) += y[k];
  early /= static_cast<double>(half);
  late /= static_cast<double>(y.size() - half);
  const double few =
      std::sqrt(4.0 * std::max(1.0, out.memory_s / sample_time) / static_cast<double>(y.size()));
  out.settled =
      std::abs(late - early) <= std::max(3.0 * few, 0.5) * out.deviation + 3.0 * out.noise;
  return out;
}

WatchedInput lookAtInput(const SignalInfo& signal, const PlantRecord& record, Index j,
                         Index first) {
  WatchedInput in;
  in.name = signal.name;
  const Vector u = record.inputs().col(j).tail(record.rows() - first),
               applied = record.applied().col(j).tail(record.rows() - first);
  const double range =
      std::isfinite(signal.upper - signal.lower) ? signal.upper - signal.lower : 1.0;
  in.moves = u.maxCoeff() - u.minCoeff() > kSame * range;
  std::vector<double> offsets;
  double ignored = 0.0, followed = std::numeric_limits<double>::infinity();
  bool applied_moves = false;
  for (Index k = 1; k + 1 < u.size(); ++k) {
    offsets.push_back(applied[k + 1] - u[k]);
    const double asked = std::abs(u[k] - applied[k]), went = std::abs(applied[k + 1] - applied[k]);
    applied_moves = applied_moves || went > kSame * range;
    if (went <= kSame * range)
      ignored = std::max(ignored, asked);
    else
      followed = std::min(followed, asked);
  }
  if (!offsets.empty()) in.offset = median(offsets);
  in.stuck = in.moves && !applied_moves;
  // A band is one only where all that is larger was followed.
  if (in.moves && !in.stuck && ignored > 1e-6 * range && ignored <= 1.2 * followed)
    in.dead_band = ignored;
  if (in.moves)
    for (Index i = 0; i < record.outputs().cols(); ++i) {
      const Vector y = record.outputs().col(i).tail(u.size());
      if (y.allFinite()) in.answers = std::max(in.answers, feedbackShare(u, y));
    }
  return in;
}

void remark(Watched& w, const std::string& text, bool grave) {
  w.remarks.push_back(text);
  w.grave = w.grave || grave;
}

void speak(Watched& w) {
  for (const WatchedOutput& y : w.outputs) {
    if (y.missing > 0.0)
      remark(w, y.name + ": " + shortText(100.0 * y.missing) + " % of its samples are missing",
             y.missing > 0.5);
    if (y.frozen)
      remark(w, y.name + ": shows one number for longer than its noise allows: frozen", true);
    if (y.quantised)
      remark(w, y.name + ": its resolution, " + shortText(y.resolution) + ", hides its noise",
             false);
    if (!y.settled) remark(w, y.name + ": has not settled: its mean still moves", false);
    if (y.period_s > 0.0)
      remark(w,
             y.name + ": swings with a period of " + shortText(y.period_s) +
                 " s under the present control",
             false);
  }
  for (const WatchedInput& u : w.inputs) {
    if (u.stuck) remark(w, u.name + ": does not follow its commands: stuck", true);
    if (u.dead_band > 0.0)
      remark(w, u.name + ": does not follow moves of less than " + shortText(u.dead_band), false);
  }
}

}  // namespace

Watched watch(const PlantRecord& record) {
  Watched w;
  w.first = static_cast<Index>(kSettledShare * static_cast<double>(record.rows()));
  const PlantInfo& info = record.info();
  for (std::size_t i = 0; i < info.outputs.size(); ++i)
    w.outputs.push_back(lookAtOutput(info.outputs[i], record.outputs().col(static_cast<Index>(i)),
                                     w.first, info.sample_time_s));
  for (std::size_t j = 0; j < info.inputs.size(); ++j)
    w.inputs.push_back(lookAtInput(info.inputs[j], record, static_cast<Index>(j), w.first));
  speak(w);
  return w;
}

OrderedJson toJson(const Watched& w) {
  OrderedJson json = {
      {"first_row", w.first}, {"outputs", OrderedJson::array()}, {"inputs", OrderedJson::array()}};
  for (const WatchedOutput& y : w.outputs)
    json["outputs"].push_back({{"name", y.name},
                               {"mean", y.mean},
                               {"deviation", y.deviation},
                               {"noise", y.noise},
                               {"resolution", y.resolution},
                               {"missing", y.missing},
                               {"frozen", y.frozen},
                               {"quantised", y.quantised},
                               {"settled", y.settled},
                               {"period_s", y.period_s},
                               {"memory_s", y.memory_s}});
  for (const WatchedInput& u : w.inputs)
    json["inputs"].push_back({{"name", u.name},
                              {"moves", u.moves},
                              {"feedback", u.answers},
                              {"in_loop", u.answers > kAnswers},
                              {"dead_band", u.dead_band},
                              {"stuck", u.stuck},
                              {"offset", u.offset}});
  json["remarks"] = w.remarks;
  json["grave"] = w.grave;
  return json;
}

Watched watchedOf(const OrderedJson& json) {
  Watched w;
  w.first = json.at("first_row");
  for (const auto& y : json.at("outputs"))
    w.outputs.push_back({y.at("name"), y.at("mean"), y.at("deviation"), y.at("noise"),
                         y.at("resolution"), y.at("missing"), y.at("frozen"), y.at("quantised"),
                         y.at("settled"), y.at("period_s"), y.at("memory_s")});
  for (const auto& u : json.at("inputs"))
    w.inputs.push_back({u.at("name"), u.at("moves"), u.at("feedback"), u.at("dead_band"),
                        u.at("stuck"), u.at("offset")});
  w.remarks = json.at("remarks").get<std::vector<std::string>>();
  w.grave = json.at("grave");
  return w;
}

}  // namespace fpc
