#include "identification/record_faults.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/decompositions.hpp"
#include "base/order_statistics.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr Index kShortestFrozen = 20;
constexpr double kFrozenTimes = 5.0;  // of the longest usual repetition
constexpr double kRestless = 0.8;     // share of rows in which a signal changes
constexpr Index kMovesWhileFrozen = 3;
constexpr Index kFewestSideRows = 20;     // on either side of a change of unit
constexpr double kFewestSideShare = 0.1;  // of the record
constexpr double kAlikeFactor = 1.4;
constexpr Index kNearby = 10;  // rows beside a change of unit that must show it
constexpr double kNearbyFactor = 2.5;
constexpr double kExplained = 0.98;
constexpr Index kMostCollinearRows = 4000;

std::string nameOf(const DataSet& data, Index column) {
  auto i = static_cast<std::size_t>(column);
  for (const auto* signals : {&data.outputs, &data.inputs, &data.disturbances}) {
    if (i < signals->size()) return (*signals)[i].name;
    i -= signals->size();
  }
  return "";
}

/// Runs of equal known values, longer than one row.
std::vector<FaultyRows> repetitions(const Eigen::Ref<const Vector>& y) {
  std::vector<FaultyRows> runs;
  for (Index k = 0; k < y.size();) {
    Index last = k + 1;
    while (last < y.size() && y[last] == y[k]) ++last;
    if (last - k > 1) runs.push_back({k, last});
    k = last;
  }
  return runs;
}

Index movesWithin(const Eigen::Ref<const Vector>& u, FaultyRows rows) {
  Index moves = 0;
  for (Index k = rows.first + 1; k < rows.last; ++k)
    if (std::isfinite(u[k] - u[k - 1]) && u[k] != u[k - 1]) ++moves;
  return moves;
}

double meanSize(const std::vector<double>& sums, Index first, Index last) {
  const auto at = [&](Index k) { return sums[static_cast<std::size_t>(k)]; };
  return (at(last) - at(first)) / static_cast<double>(last - first);
}

/// The usual factor between two units nearest to `ratio`; 0: none is near.
double unitFactor(double ratio) {
  static const std::array<double, 7> factors{10.0, 60.0, 100.0, 1e3, 3.6e3, 1e4, 1e6};
  double best = 0.0, nearest = std::log(kAlikeFactor);
  for (const double f : factors)
    for (const double g : {f, 1.0 / f})
      if (std::abs(std::log(ratio / g)) < nearest) {
        nearest = std::abs(std::log(ratio / g));
        best = g;
      }
  return best;
}

double medianSize(const Eigen::Ref<const Vector>& values) {
  std::vector<double> sizes;
  for (const double v : values)
    if (std::isfinite(v)) sizes.push_back(std::abs(v));
  return sizes.empty() ? 0.0 : upperMedian(std::move(sizes));
}

}  // namespace

std::vector<FaultyRows> frozenRows(const DataSet& data, Index column) {
  const auto n_y = static_cast<Index>(data.outputs.size()),
             n_u = static_cast<Index>(data.inputs.size());
  const bool is_output = column < n_y;
  if (!is_output && column < n_y + n_u) return {};
  const auto y = data.values.col(column);
  std::vector<FaultyRows> frozen, usual;
  Index repeated = 0, longest_usual = 1;
  double lowest = kInfinity, highest = -kInfinity, known = 0.0;
  for (const double v : y)
    if (std::isfinite(v))
      lowest = std::min(lowest, v), highest = std::max(highest, v), known += 1.0;
  for (const FaultyRows run : repetitions(y)) {
    const bool inside = y[run.first] > lowest && y[run.first] < highest;
    (inside && run.last - run.first >= kShortestFrozen ? frozen : usual).push_back(run);
  }
  double of_frozen = 0.0;
  for (const FaultyRows run : frozen) of_frozen += static_cast<double>(run.last - run.first);
  for (const FaultyRows run : usual) {
    repeated += run.last - run.first - 1;
    longest_usual = std::max(longest_usual, run.last - run.first);
  }
  const double others = known - of_frozen;
  if (!(others > 0.0) || static_cast<double>(repeated) > (1.0 - kRestless) * others) return {};
  frozen.erase(std::remove_if(frozen.begin(), frozen.end(),
                              [&](FaultyRows run) {
                                Index moves = 0;
                                for (Index j = n_y; j < n_y + n_u; ++j)
                                  moves += movesWithin(data.values.col(j), run);
                                return static_cast<double>(run.last - run.first) <
                                           kFrozenTimes * static_cast<double>(longest_usual) ||
                                       (is_output && moves < kMovesWhileFrozen);
                              }),
               frozen.end());
  return frozen;
}

UnitChange unitChange(const Eigen::Ref<const Vector>& values) {
  std::vector<double> known;
  std::vector<Index> rows;
  for (Index k = 0; k < values.size(); ++k)
    if (std::isfinite(values[k])) known.push_back(values[k]), rows.push_back(k);
  const auto n = static_cast<Index>(known.size());
  const Index side =
      std::max(kFewestSideRows, static_cast<Index>(kFewestSideShare * static_cast<double>(n)));
  if (n < 2 * side) return {};
  std::vector<double> sizes(known.size() + 1, 0.0), moves(known.size() + 1, 0.0);
  for (std::size_t k = 0; k < known.size(); ++k) {
    sizes[k + 1] = sizes[k] + std::abs(known[k]);
    moves[k + 1] = moves[k] + (k > 0 ? std::abs(known[k] - known[k - 1]) : 0.0);
  }
  UnitChange change;
  double largest = std::log(5.0);
  Index at = 0;
  for (Index s = side; s + side <= n; ++s) {
    const double value = meanSize(sizes, s, n) / meanSize(sizes, 0, s);
    const double move = meanSize(moves, s + 1, n) / meanSize(moves, 0, s);
    const double size = std::abs(std::log(value));
    if (!(size > largest) || !(std::abs(std::log(value / move)) < std::log(2.0))) continue;
    largest = size;
    change.factor = unitFactor(value);
    at = s;
  }
  if (at == 0 || change.factor == 0.0) return {};
  const Eigen::Map<const Vector> all(known.data(), n);
  const double near =
      medianSize(all.segment(at, kNearby)) / medianSize(all.segment(at - kNearby, kNearby));
  if (!(std::abs(std::log(near / change.factor)) < std::log(kNearbyFactor))) return {};
  change.row = rows[static_cast<std::size_t>(at)];
  return change;
}

std::vector<Collinear> collinearCauses(const DataSet& data) {
  std::vector<Collinear> found;
  const auto n_y = static_cast<Index>(data.outputs.size());
  std::vector<Index> causes;
  for (Index c = n_y; c < data.values.cols(); ++c) {
    const bool still = static_cast<std::size_t>(c) < data.constant.size() &&
                       data.constant[static_cast<std::size_t>(c)];
    const auto column = data.values.col(c);
    if (!still && column.array().isFinite().any()) causes.push_back(c);
  }
  if (causes.size() < 2) return found;
  const Index rows = std::min(data.rows(), kMostCollinearRows);
  for (const Index c : causes) {
    const auto width = static_cast<Index>(3 * (causes.size() - 1) + 1);
    std::vector<Index> kept;
    for (Index k = 1; k + 1 < rows; ++k)
      if (data.values.block(k - 1, n_y, 3, data.values.cols() - n_y).allFinite()) kept.push_back(k);
    const auto n = static_cast<Index>(kept.size());
    if (n < 5 * width) continue;
    Matrix a(n, width);
    Vector b(n);
    for (Index i = 0; i < n; ++i) {
      const Index k = kept[static_cast<std::size_t>(i)];
      Index j = 0;
      for (const Index other : causes)
        for (Index lag = -1; other != c && lag <= 1; ++lag) a(i, j++) = data.values(k + lag, other);
      a(i, j) = 1.0;
      b[i] = data.values(k, c);
    }
    const Vector about = b.array() - b.mean();
    const double total = about.squaredNorm();
    if (!(total > 0.0)) continue;
    const double left = (b - a * solvedByPivotedQr(a, b)).squaredNorm();
    if (!(1.0 - left / total > kExplained)) continue;
    Collinear pair{c, -1, 1.0 - left / total};
    double strongest = -1.0;
    Index j = 0;
    for (const Index other : causes) {
      if (other == c) continue;
      const Vector x = a.col(j + 1).array() - a.col(j + 1).mean();
      j += 3;
      const double like = std::abs(x.dot(about)) / std::max(x.norm() * about.norm(), 1e-300);
      if (like > strongest) strongest = like, pair.partner = other;
    }
    found.push_back(pair);
  }
  return found;
}

std::vector<std::string> faultRemarks(const DataSet& data) {
  std::vector<std::string> remarks;
  const auto n_y = static_cast<Index>(data.outputs.size());
  for (Index c = 0; c < data.values.cols(); ++c) {
    const std::string name = nameOf(data, c);
    for (const FaultyRows run : frozenRows(data, c))
      remarks.push_back(name + ": frozen at " + shortText(data.values(run.first, c)) + " in rows " +
                        std::to_string(run.first + 1) + ":" + std::to_string(run.last) +
                        ", while it changes in nearly all others" +
                        (c < n_y ? ": left out of fits and figures" : ""));
    const UnitChange change = unitChange(data.values.col(c));
    if (change.row > 0)
      remarks.push_back(name + ": from row " + std::to_string(change.row + 1) +
                        " on values and moves are " +
                        (change.factor > 1.0 ? shortText(change.factor) + " times larger"
                                             : shortText(1.0 / change.factor) + " times smaller") +
                        ": another unit? (--rows takes a part)");
  }
  for (const Collinear& pair : collinearCauses(data)) {
    char share[16];
    std::snprintf(share, sizeof share, "%.1f", 100.0 * pair.share);
    remarks.push_back(nameOf(data, pair.column) + " moves with " + nameOf(data, pair.partner) +
                      " (" + share +
                      " % of it): the effects of the two cannot be told apart, and a gain "
                      "of one alone means nothing");
  }
  return remarks;
}

}  // namespace fpc
