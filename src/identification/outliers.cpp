// Samples that a sensor or a typist made up: spikes of one sample, bursts of a few.
#include <algorithm>
#include <cmath>
#include <set>

#include "base/order_statistics.hpp"
#include "identification/record_faults.hpp"
#include "identification/record_remarks.hpp"
#include "identification/spike_influence.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kSpike = 12.0;  // usual bends of a sample from its neighbours
constexpr double kAgree = 0.3;   // of the spike: how far its two sides may differ
constexpr Index kLongest = 5;    // samples of a burst
constexpr double kFar = 0.5;     // of the span of 96 % of the samples: beyond them lie bursts
constexpr double kTail = 0.02;   // left out at either end of that span
constexpr Index kReaction = 20;  // samples within which an output shows what an input did

double bendAt(const Eigen::Ref<const Vector>& y, Index k) {
  return y[k] - 0.5 * (y[k - 1] + y[k + 1]);
}

/// Usual size of a bend, of those that bend at all.
double usualBend(const Eigen::Ref<const Vector>& y) {
  std::vector<double> bends;
  for (Index k = 1; k + 1 < y.size(); ++k) {
    const double bend = bendAt(y, k);
    if (std::isfinite(bend) && bend != 0.0) bends.push_back(std::abs(bend));
  }
  return 1.4826 * sampleQuantile(std::move(bends), 0.5);
}

/// One sample far from both neighbours, where these agree.
void addSpikes(const Eigen::Ref<const Vector>& y, double usual, std::set<Index>& found) {
  // a neighbour of a spike bends the other way; those of a corner hardly bend
  const auto bendsBack = [&](Index k, double size) {
    if (k < 1 || k + 1 >= y.size() || !std::isfinite(bendAt(y, k))) return true;
    return bendAt(y, k) * size < 0.0 && std::abs(bendAt(y, k)) > kAgree * std::abs(size);
  };
  for (Index k = 1; k + 1 < y.size(); ++k) {
    const double size = bendAt(y, k);
    if (!(std::abs(size) > kSpike * usual)) continue;
    if (std::abs(y[k + 1] - y[k - 1]) > kAgree * std::abs(size)) continue;
    if (bendsBack(k - 1, size) && bendsBack(k + 1, size)) found.insert(k);
  }
}

/// 1 above and -1 below what nearly all samples span, by half of that span; 0 within.
std::vector<int> farSides(const Eigen::Ref<const Vector>& y) {
  std::vector<double> known;
  for (const double v : y)
    if (std::isfinite(v)) known.push_back(v);
  const double low = sampleQuantile(known, kTail), high = sampleQuantile(known, 1.0 - kTail);
  const double margin = kFar * (high - low);
  std::vector<int> sides;
  for (const double v : y) sides.push_back(v > high + margin ? 1 : v < low - margin ? -1 : 0);
  return sides;
}

/// A few samples far from all others that begin and end with jumps and leave the rest unmoved.
void addBursts(const Eigen::Ref<const Vector>& y, double usual, std::set<Index>& found) {
  const std::vector<int> side = farSides(y);
  const auto at = [&](Index k) { return side[static_cast<std::size_t>(k)]; };
  for (Index first = 1; first + 1 < y.size(); ++first) {
    if (at(first) == 0 || at(first - 1) != 0) continue;
    Index after = first;
    while (after < y.size() && at(after) != 0) ++after;
    if (after >= y.size() || after - first > kLongest) continue;
    const double before = y[first - 1];
    double least = kInfinity;
    for (Index k = first; k < after; ++k) least = std::min(least, std::abs(y[k] - before));
    const double jump = std::min(std::abs(y[first] - before), std::abs(y[after] - y[after - 1]));
    // the top of a smooth peak is reached by steps like those before it
    const auto moved = [&](Index k) {
      return k > 0 && k < y.size() && std::abs(y[k] - y[k - 1]) > kAgree * jump;
    };
    if (jump > kSpike * usual && std::abs(y[after] - before) < kAgree * least &&
        !moved(first - 1) && !moved(after + 1))
      for (Index k = first; k < after; ++k) found.insert(k);
  }
}

/// An input of the rows before does what the output does: a pulse and its response.
bool caused(const std::vector<std::vector<Index>>& causes, Index row) {
  return std::any_of(causes.begin(), causes.end(), [row](const std::vector<Index>& rows) {
    return std::any_of(rows.begin(), rows.end(),
                       [row](Index k) { return k <= row && k + kReaction >= row; });
  });
}

}  // namespace

std::vector<Index> outliersOf(const Eigen::Ref<const Vector>& y) {
  std::set<Index> found;
  const double usual = usualBend(y);
  if (usual > 0.0) {
    addSpikes(y, usual, found);
    addBursts(y, usual, found);
  }
  return {found.begin(), found.end()};
}

std::vector<std::vector<Index>> outliersOf(const DataSet& data) {
  const auto n_y = static_cast<Index>(data.outputs.size());
  std::vector<std::vector<Index>> pulses, found;
  for (Index c = n_y; c < data.values.cols(); ++c) pulses.push_back(outliersOf(data.values.col(c)));
  for (Index c = 0; c < n_y; ++c) {
    std::vector<Index> rows = outliersOf(data.values.col(c));
    const std::vector<Index> genuine = explained(data, c, rows);
    rows.erase(std::remove_if(rows.begin(), rows.end(),
                              [&](Index row) {
                                return caused(pulses, row) ||
                                       std::binary_search(genuine.begin(), genuine.end(), row);
                              }),
               rows.end());
    found.push_back(std::move(rows));
  }
  for (std::size_t j = 0; j < pulses.size(); ++j)
    found.push_back(unnoticed(data, n_y + static_cast<Index>(j), pulses[j], found));
  return found;
}

DataSet withoutOutliers(const DataSet& data) {
  DataSet clean = data;
  const auto found = outliersOf(data);
  const std::size_t n_y = data.outputs.size();
  for (std::size_t c = 0; c < found.size(); ++c) {
    auto column = clean.values.col(static_cast<Index>(c));
    for (const Index k : found[c]) column[k] = kNaN;
    bool changed = !found[c].empty();
    if (c < n_y)
      for (const FaultyRows frozen : frozenRows(data, static_cast<Index>(c))) {
        column.segment(frozen.first + 1, frozen.last - frozen.first - 1).setConstant(kNaN);
        changed = true;
      }
    if (!changed) continue;
    if (c >= n_y) bridge(column, found[c]);
    setRange(clean, c);
  }
  return clean;
}

}  // namespace fpc
