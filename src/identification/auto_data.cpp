#include "identification/auto_data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "identification/known_stretches.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr int kLimitRun = 4;        // equal extreme values in a row mean a sensor at its limit
constexpr double kNearZero = 0.05;  // of the span
constexpr Index kShortestStretch = 12;

double knownMean(const Eigen::Ref<const Vector>& values) {
  double sum = 0.0, n = 0.0;
  for (const double v : values)
    if (std::isfinite(v)) sum += v, n += 1.0;
  return n > 0.0 ? sum / n : 0.0;
}

double deviationOf(const Eigen::Ref<const Vector>& values, double mean) {
  double sum = 0.0, n = 0.0;
  for (const double v : values)
    if (std::isfinite(v)) sum += (v - mean) * (v - mean), n += 1.0;
  return n > 0.0 && sum > 0.0 ? std::sqrt(sum / n) : 1.0;
}

/// Longest run of values equal to `extreme`, and how often the value is left and reached again.
bool sticksAt(const Eigen::Ref<const Vector>& y, double extreme) {
  int longest = 0, run = 0;
  for (const double v : y) {
    run = v == extreme ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest >= kLimitRun;
}

void findLimits(AutoData& p) {
  const auto y = p.data->values.col(p.output);
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (const double v : y)
    if (std::isfinite(v)) lowest = std::min(lowest, v), highest = std::max(highest, v);
  const double span = highest - lowest, far = 1e6;
  const auto scaled = [&](double v) { return (v - p.shift[p.output]) / p.scale[p.output]; };
  const bool above = sticksAt(y, highest), below = sticksAt(y, lowest);
  if (above || below) {
    p.upper = above ? scaled(highest) : far;
    p.lower = below ? scaled(lowest) : -far;
  }
  p.may_be_absolute = lowest >= -kNearZero * span && lowest <= kNearZero * span;
}

void findRate(AutoData& p) {
  double change = 0.0, bend = 0.0, n = 0.0, m = 0.0;
  for (Index k = 1; k < p.scaled.rows(); ++k) {
    const double step = p.y(k) - p.y(k - 1);
    if (!std::isfinite(step)) continue;
    change += step * step, n += 1.0;
    if (k < 3) continue;
    const double third = p.y(k) - 3.0 * p.y(k - 1) + 3.0 * p.y(k - 2) - p.y(k - 3);
    if (std::isfinite(third)) bend += third * third, m += 1.0;
  }
  p.rate = n > 0.0 ? std::clamp(std::sqrt(change / n), 1e-3, 1.0) : 1.0;
  p.noise = m > 0.0 ? std::clamp(std::sqrt(bend / m / 20.0), 1e-3, 0.3) : 0.01;
}

/// `count` windows of `length` rows, equally spaced over rows 0..rows.
std::vector<Stretch> spread(Index rows, Index count, Index length) {
  std::vector<Stretch> windows;
  for (Index i = 0; i < count; ++i) {
    const Index room = rows * (i + 1) / count - rows * i / count;
    const Index first = rows * i / count + std::max<Index>(0, (room - length) / 2);
    windows.push_back({first, std::min(first + std::min(room, length), rows)});
  }
  return windows;
}

/// The parts of `a` inside stretches of `b`.
std::vector<Stretch> cut(const std::vector<Stretch>& a, const std::vector<Stretch>& b) {
  std::vector<Stretch> parts;
  for (const auto& x : a)
    for (const auto& y : b) {
      const Stretch part{std::max(x.first, y.first), std::min(x.last, y.last)};
      if (part.last - part.first >= kShortestStretch) parts.push_back(part);
    }
  return parts;
}

}  // namespace

AutoData prepareAuto(const DataSet& data, int output, int blocks, Index most, Index most_last) {
  AutoData p;
  p.data = &data;
  p.output = output;
  const Index columns = data.values.cols(), rows = data.rows();
  p.shift.resize(columns);
  p.scale.resize(columns);
  for (Index j = 0; j < columns; ++j) {
    p.shift[j] = knownMean(data.values.col(j));
    p.scale[j] = deviationOf(data.values.col(j), p.shift[j]);
  }
  p.scaled =
      (data.values.rowwise() - p.shift.transpose()).array().rowwise() / p.scale.transpose().array();
  findLimits(p);
  findRate(p);
  const Index length = std::max<Index>(1, (std::min(rows, most) + blocks - 1) / blocks);
  const auto known = knownStretches(data, kShortestStretch);
  p.windows = cut(spread(rows, blocks, rows <= most ? rows : length), known);
  p.all =
      rows <= most_last ? known : cut(spread(rows, 2 * blocks, most_last / (2 * blocks)), known);
  return p;
}

RecurrentData recurrentData(const AutoData& p, const std::vector<Regressor>& exogenous,
                            bool absolute) {
  RecurrentData r;
  r.y = p.scaled.col(p.output);
  if (absolute) r.y.array() += p.shift[p.output] / p.scale[p.output];
  r.v.resize(static_cast<Index>(exogenous.size()), p.scaled.rows());
  for (std::size_t j = 0; j < exogenous.size(); ++j) {
    const Index column = p.data->column(exogenous[j].kind, exogenous[j].index);
    for (Index k = 0; k < p.scaled.rows(); ++k)
      r.v(static_cast<Index>(j), k) = p.scaled(std::max<Index>(k - exogenous[j].lag, 0), column);
  }
  return r;
}

Index rowsOf(const std::vector<Stretch>& stretches) {
  Index rows = 0;
  for (const auto& s : stretches) rows += s.last - s.first;
  return rows;
}

std::vector<Stretch> trainingStretches(const AutoData& p, int left_out) {
  std::vector<Stretch> kept;
  for (int b = 0; b < static_cast<int>(p.windows.size()); ++b) {
    const Stretch& w = p.windows[static_cast<std::size_t>(b)];
    if (b == left_out) continue;
    if (!kept.empty() && kept.back().last == w.first)
      kept.back().last = w.last;
    else
      kept.push_back(w);
  }
  return runsOf(p, kept);
}

std::vector<Stretch> runsOf(const AutoData& p, const std::vector<Stretch>& stretches) {
  if (p.reach == 0) return stretches;
  std::vector<Stretch> runs;
  for (const Stretch& s : stretches)
    for (Index first = s.first + kRunStart; first < s.last; first += p.reach)
      runs.push_back({first - kRunStart, std::min(first + p.reach, s.last)});
  return runs;
}

}  // namespace fpc
