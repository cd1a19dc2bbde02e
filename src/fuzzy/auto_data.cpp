#include "fuzzy/auto_data.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fuzzy/known_stretches.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr int kLimitRun = 4;        // equal extreme values in a row mean a sensor at its limit
constexpr double kNearZero = 0.05;  // of the span
constexpr Index kShortestStretch = 12;

double meanOf(const Eigen::Ref<const Vector>& values) {
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
    p.shift[j] = meanOf(data.values.col(j));
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
  return kept;
}

namespace {

/// Mean squared one-step error of y(k), y(k-1) and u_j(k - d_j), u_j(k - d_j - 1) for all j, from
/// where even the longest delay has a past.
double oneStepError(const AutoData& p, const std::vector<int>& delay, Index longest) {
  const Index m = static_cast<Index>(delay.size()), q = 3 + 2 * m;
  const Index n_y = static_cast<Index>(p.data->outputs.size());
  Matrix H = 1e-6 * Matrix::Identity(q, q);
  Vector g = Vector::Zero(q), x(q);
  double yy = 0.0, n = 0.0;
  for (const auto& w : p.windows)
    for (Index k = std::max(w.first, longest) + 1; k + 1 < w.last; ++k) {
      x[0] = p.y(k), x[1] = p.y(k - 1), x[2] = 1.0;
      for (Index j = 0; j < m; ++j)
        for (Index lag = 0; lag < 2; ++lag)
          x[3 + 2 * j + lag] =
              p.scaled(std::max<Index>(k - delay[static_cast<std::size_t>(j)] - lag, 0), n_y + j);
      const double y = p.y(k + 1);
      if (!x.allFinite() || !std::isfinite(y)) continue;
      H.selfadjointView<Eigen::Lower>().rankUpdate(x);
      g += x * y;
      yy += y * y, n += 1.0;
    }
  if (n == 0.0) return 0.0;
  const Vector theta = H.selfadjointView<Eigen::Lower>().ldlt().solve(g);
  return std::max(yy - g.dot(theta), 0.0) / n;
}

}  // namespace

DelayGuess guessDelays(const AutoData& p, int longest) {
  constexpr double kAlike = 1.005;  // two delays within it are not told apart
  // a delay must lower the error by more than chance does
  const double worth = 1.0 - std::max(0.03, 10.0 / static_cast<double>(p.scaled.rows()));
  const std::size_t m = p.data->inputs.size() + p.data->disturbances.size();
  DelayGuess guess{std::vector<int>(m, 0), std::vector<bool>(m, false)};
  double best = oneStepError(p, guess.delay, longest);
  for (int pass = 0; pass < 2; ++pass)
    for (std::size_t j = 0; j < m; ++j) {
      std::vector<double> errors;
      auto trial = guess.delay;
      for (trial[j] = 0; trial[j] <= longest; ++trial[j])
        errors.push_back(oneStepError(p, trial, longest));
      const auto lowest = std::min_element(errors.begin(), errors.end());
      if (*lowest < worth * best) {
        guess.delay[j] = static_cast<int>(lowest - errors.begin());
        best = *lowest;
      }
      const double chosen = errors[static_cast<std::size_t>(guess.delay[j])];
      guess.doubt[j] = false;
      for (std::size_t d = 0; d < errors.size(); ++d)
        if (std::abs(static_cast<int>(d) - guess.delay[j]) > 1 && errors[d] < kAlike * chosen &&
            errors.front() > 1.02 * chosen)
          guess.doubt[j] = true;
    }
  return guess;
}

}  // namespace fpc
