#include "identification/spike_influence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/decompositions.hpp"
#include "base/order_statistics.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr Index kReach = 13;            // samples of an input that a prediction looks at
constexpr Index kMostSpikeRows = 4000;  // that the model is fitted to
constexpr double kBetter = 0.5;  // of the squared error: the record is the better without a spike

struct Group {
  Index first{}, last{};  ///< both included
};

std::vector<Group> groupsOf(const std::vector<Index>& rows) {
  std::vector<Group> groups;
  for (const Index k : rows) {
    if (!groups.empty() && groups.back().last + 1 == k)
      groups.back().last = k;
    else
      groups.push_back({k, k});
  }
  return groups;
}

/// y(k+1) by y(k), y(k-1), kReach values of one input and two of each other.
class Judge {
 public:
  Judge(const DataSet& data, Index output, Index input, const std::vector<Index>& outliers)
      : values_(data.values),
        n_y_(static_cast<Index>(data.outputs.size())),
        output_(output),
        input_(input) {
    for (const Index k : outliers) values_(k, output) = std::numeric_limits<double>::quiet_NaN();
  }

  void fit(const std::vector<Group>& groups) {
    std::vector<Index> kept;
    const Index last = std::min(values_.rows() - 1, kMostSpikeRows);
    for (Index k = kReach; k < last; ++k)
      if (!near(groups, k) && rowAt(values_, k).allFinite() &&
          std::isfinite(values_(k + 1, output_)))
        kept.push_back(k);
    const auto n = static_cast<Index>(kept.size());
    Matrix a(n, size());
    Vector b(n);
    for (Index i = 0; i < n; ++i) {
      const Index k = kept[static_cast<std::size_t>(i)];
      a.row(i) = rowAt(values_, k).transpose();
      b[i] = values_(k + 1, output_);
    }
    if (n < 2 * size()) return;
    theta_ = solvedByPivotedQr(a, b);
    variance_ = (b - a * theta_).squaredNorm() / static_cast<double>(n);
  }

  /// Squared errors after a spike over their usual size, as the record has it and without it.
  void judge(const Group& g, double& recorded, double& without) const {
    if (theta_.size() == 0 || !(variance_ > 0.0)) return;
    const Index from = std::max<Index>(0, g.first - kReach - 1);
    const Index last = std::min(g.last + kReach, values_.rows() - 1);
    const Matrix part = values_.middleRows(from, last - from + 1);
    Matrix bridged = part;
    std::vector<Index> rows;
    for (Index k = g.first; k <= g.last; ++k) rows.push_back(k - from);
    bridge(bridged.col(input_), rows);
    for (Index k = std::max(g.first - from, kReach); k + 1 < part.rows(); ++k) {
      const double y = part(k + 1, output_), a = y - rowAt(part, k).dot(theta_),
                   b = y - rowAt(bridged, k).dot(theta_);
      if (!std::isfinite(a) || !std::isfinite(b)) continue;
      recorded += a * a / variance_;
      without += b * b / variance_;
    }
  }

 private:
  Index size() const { return 3 + kReach + 2 * (values_.cols() - n_y_ - 1); }
  static bool near(const std::vector<Group>& groups, Index k) {
    return std::any_of(groups.begin(), groups.end(),
                       [k](const Group& g) { return k + 1 >= g.first && k <= g.last + kReach; });
  }
  Vector rowAt(const Matrix& values, Index k) const {
    Vector row(size());
    row[0] = 1.0;
    row[1] = values(k, output_);
    row[2] = values(k - 1, output_);
    row.segment(3, kReach) = values.col(input_).segment(k - kReach + 1, kReach);
    Index at = 3 + kReach;
    for (Index c = n_y_; c < values.cols(); ++c) {
      if (c == input_) continue;
      row[at++] = values(k, c);
      row[at++] = values(k - 1, c);
    }
    return row;
  }

  Matrix values_;
  Index n_y_, output_, input_;
  Vector theta_;
  double variance_{};
};

}  // namespace

namespace {

constexpr Index kPeakLags = 6;      // samples of each input that may make a peak, the row's own too
constexpr double kExplains = 0.25;  // of the squares that a straight line leaves
constexpr int kPeakPasses = 3;
constexpr double kPeakTrim = 8.0;      // median errors
constexpr std::size_t kPeakFolds = 5;  // peaks are told by models that did not see them

/// y(k) by y(k-1), y(k-2) and values and squares of all inputs of the rows k-5..k.
class PeakModel {
 public:
  PeakModel(const DataSet& data, Index output) : values_(data.values), output_(output) {
    n_y_ = static_cast<Index>(data.outputs.size());
    for (Index c = n_y_; c < values_.cols(); ++c) {
      double n = 0.0, sum = 0.0;
      for (const double v : values_.col(c))
        if (std::isfinite(v)) n += 1.0, sum += v;
      values_.col(c).array() -= n > 0.0 ? sum / n : 0.0;
    }
  }

  /// Fitted to all rows but those of `hidden` peaks, then without those that it errs most in.
  bool fit(const std::vector<Group>& hidden) {
    std::vector<Index> kept;
    const Index last = std::min(values_.rows(), kMostSpikeRows);
    for (Index k = kPeakLags; k < last; ++k) {
      const bool near = std::any_of(hidden.begin(), hidden.end(), [k](const Group& g) {
        return k >= g.first && k <= g.last + 2;
      });
      if (!near && std::isfinite(values_(k, output_)) && rowAt(values_.col(output_), k).allFinite())
        kept.push_back(k);
    }
    for (int pass = 0; pass < kPeakPasses; ++pass) {
      const auto n = static_cast<Index>(kept.size());
      if (n < 3 * size()) return false;
      Matrix a(n, size());
      Vector b(n);
      for (Index i = 0; i < n; ++i) {
        a.row(i) = rowAt(values_.col(output_), kept[static_cast<std::size_t>(i)]).transpose();
        b[i] = values_(kept[static_cast<std::size_t>(i)], output_);
      }
      theta_ = solvedByPivotedQr(a, b);
      const Vector sizes = (b - a * theta_).cwiseAbs();
      const double most =
          kPeakTrim * upperMedian(std::vector<double>(sizes.data(), sizes.data() + n));
      if (!(most > 0.0)) return true;
      std::vector<Index> usual;
      for (Index i = 0; i < n; ++i)
        if (sizes[i] < most) usual.push_back(kept[static_cast<std::size_t>(i)]);
      kept = std::move(usual);
    }
    return true;
  }

  bool explains(const Group& g) const {
    if (g.first < kPeakLags || g.last + 1 >= values_.rows()) return false;
    Vector y = values_.col(output_), line = y;
    std::vector<Index> rows;
    for (Index k = g.first; k <= g.last; ++k) rows.push_back(k);
    bridge(line, rows);
    double own = 0.0, straight = 0.0;
    for (const Index k : rows) {
      const double measured = y[k];
      y[k] = rowAt(y, k).dot(theta_);
      own += (measured - y[k]) * (measured - y[k]);
      straight += (measured - line[k]) * (measured - line[k]);
    }
    return own < kExplains * straight;
  }

 private:
  Index size() const { return 3 + 2 * kPeakLags * (values_.cols() - n_y_); }
  Vector rowAt(const Eigen::Ref<const Vector>& y, Index k) const {
    Vector row(size());
    row.head(3) << 1.0, y[k - 1], y[k - 2];
    Index at = 3;
    for (Index c = n_y_; c < values_.cols(); ++c)
      for (Index lag = 0; lag < kPeakLags; ++lag) {
        const double u = values_(k - lag, c);
        row[at++] = u;
        row[at++] = u * u;
      }
    return row;
  }

  Matrix values_;
  Index n_y_{}, output_;
  Vector theta_;
};

}  // namespace

std::vector<Index> explained(const DataSet& data, Index output, const std::vector<Index>& rows) {
  std::vector<Index> found;
  if (rows.empty()) return found;
  const std::vector<Group> peaks = groupsOf(rows);
  PeakModel model(data, output);
  for (std::size_t fold = 0; fold < std::min(kPeakFolds, peaks.size()); ++fold) {
    std::vector<Group> hidden;
    for (std::size_t i = fold; i < peaks.size(); i += kPeakFolds) hidden.push_back(peaks[i]);
    if (!model.fit(hidden)) return {};
    for (const Group& g : hidden)
      for (Index k = g.first; model.explains(g) && k <= g.last; ++k) found.push_back(k);
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<Index> unnoticed(const DataSet& data, Index column, const std::vector<Index>& rows,
                             const std::vector<std::vector<Index>>& outliers) {
  std::vector<Index> found;
  if (rows.empty()) return found;
  const std::vector<Group> groups = groupsOf(rows);
  std::vector<Judge> judges;
  for (std::size_t i = 0; i < data.outputs.size(); ++i) {
    judges.emplace_back(data, static_cast<Index>(i), column, outliers[i]);
    judges.back().fit(groups);
  }
  for (const Group& g : groups) {
    double recorded = 0.0, without = 0.0;
    for (const Judge& judge : judges) judge.judge(g, recorded, without);
    if (without < kBetter * recorded)
      for (Index k = g.first; k <= g.last; ++k) found.push_back(k);
  }
  return found;
}

void bridge(Eigen::Ref<Vector> values, const std::vector<Index>& rows) {
  for (const Group& g : groupsOf(rows)) {
    if (g.first < 1 || g.last + 1 >= values.size()) continue;
    const double from = values[g.first - 1], to = values[g.last + 1];
    const auto steps = static_cast<double>(g.last - g.first + 2);
    for (Index k = g.first; k <= g.last; ++k)
      values[k] = from + (to - from) * static_cast<double>(k - g.first + 1) / steps;
  }
}

void setRange(DataSet& data, std::size_t column) {
  const std::size_t n_y = data.outputs.size(), n_u = data.inputs.size();
  SignalInfo& signal = column < n_y         ? data.outputs[column]
                       : column < n_y + n_u ? data.inputs[column - n_y]
                                            : data.disturbances[column - n_y - n_u];
  double lower = std::numeric_limits<double>::infinity(), upper = -lower;
  for (const double v : data.values.col(static_cast<Index>(column)))
    if (std::isfinite(v)) lower = std::min(lower, v), upper = std::max(upper, v);
  if (!(lower < upper)) return;
  signal.lower = lower;
  signal.upper = upper;
}

}  // namespace fpc
