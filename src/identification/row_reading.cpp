#include "identification/row_reading.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "fmbpc/base/text.hpp"
#include "identification/feedback_share.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kActsWithin = 0.9;  // of the squared error: what the same row must reach
constexpr double kExact = 1e-4;      // of it: as a law without noise gives, or a noise-free process
constexpr Index kOwnLags = 4, kCauseLags = 4;
constexpr Index kMostReadRows = 8000;

bool isStillColumn(const DataSet& data, Index column) {
  const auto c = static_cast<std::size_t>(column);
  return (c < data.constant.size() && data.constant[c]) ||
         !(data.values.col(column).array().isFinite().any());
}

/// Mean squared error of y(k+1) by y(k)..y(k-3) and four values of each cause, the newest of u(k+1)
/// where `same`, else of u(k); in-sample, with the same number of regressors.
double oneRowError(const DataSet& data, Index output, const std::vector<bool>& same) {
  const auto n_y = static_cast<Index>(data.outputs.size());
  std::vector<Index> causes;
  for (Index c = n_y; c < data.values.cols(); ++c)
    if (!isStillColumn(data, c)) causes.push_back(c);
  const Index q = 1 + kOwnLags + kCauseLags * static_cast<Index>(causes.size());
  const Index last = std::min(data.rows() - 1, kMostReadRows);
  Vector scale(data.values.cols()), shift(data.values.cols());
  for (Index c = 0; c < data.values.cols(); ++c) {
    double n = 0.0, sum = 0.0, square = 0.0;
    for (Index k = 0; k <= last; ++k)
      if (std::isfinite(data.values(k, c))) n += 1.0, sum += data.values(k, c);
    shift[c] = n > 0.0 ? sum / n : 0.0;
    for (Index k = 0; k <= last; ++k)
      if (std::isfinite(data.values(k, c)))
        square += (data.values(k, c) - shift[c]) * (data.values(k, c) - shift[c]);
    scale[c] = square > 0.0 ? std::sqrt(square / n) : 1.0;
  }
  const auto at = [&](Index k, Index c) { return (data.values(k, c) - shift[c]) / scale[c]; };
  Matrix H = 1e-6 * Matrix::Identity(q, q);
  Vector g = Vector::Zero(q), x(q);
  double squares = 0.0, n = 0.0;
  for (Index k = std::max(kOwnLags, kCauseLags); k < last; ++k) {
    Index j = 0;
    x[j++] = 1.0;
    for (Index lag = 0; lag < kOwnLags; ++lag) x[j++] = at(k - lag, output);
    for (const Index c : causes) {
      const Index newest = same[static_cast<std::size_t>(c - n_y)] ? k + 1 : k;
      for (Index lag = 0; lag < kCauseLags; ++lag) x[j++] = at(newest - lag, c);
    }
    const double y = at(k + 1, output);
    if (!x.allFinite() || !std::isfinite(y)) continue;
    H.selfadjointView<Eigen::Lower>().rankUpdate(x);
    g += x * y;
    squares += y * y;
    n += 1.0;
  }
  if (n < 3.0 * static_cast<double>(q)) return 0.0;
  return std::max(squares - g.dot(H.selfadjointView<Eigen::Lower>().ldlt().solve(g)), 0.0) / n;
}

const std::string& causeName(const DataSet& data, std::size_t j) {
  return j < data.inputs.size() ? data.inputs[j].name
                                : data.disturbances[j - data.inputs.size()].name;
}

}  // namespace

ReadRows readRows(const DataSet& data, RowReading reading) {
  const std::size_t m = data.inputs.size() + data.disturbances.size();
  const auto n_y = static_cast<Index>(data.outputs.size());
  ReadRows read{std::vector<bool>(m, reading == RowReading::kSame), {}};
  if (reading != RowReading::kFound) return read;
  for (std::size_t j = 0; j < m; ++j) {
    const Index column = n_y + static_cast<Index>(j);
    if (isStillColumn(data, column)) continue;
    std::string driven, feedback;
    bool exact = false;
    for (Index i = 0; i < n_y; ++i) {
      std::vector<bool> trial = read.same;
      const double next = oneRowError(data, i, trial);
      trial[j] = true;
      const std::string& y = data.outputs[static_cast<std::size_t>(i)].name;
      const double within = next > 0.0 ? oneRowError(data, i, trial) : 0.0;
      if (within < kActsWithin * next) driven = y;
      if (within < kExact * next) exact = true;
      if (feedbackShare(data.values.col(column), data.values.col(i), 1) > 0.0) feedback = y;
    }
    if (driven.empty()) continue;
    const std::string& u = causeName(data, j);
    read.same[j] = feedback.empty() && !exact;
    read.remarks.push_back(
        read.same[j]
            ? u + " acts within its sample (nk = 0): " + driven +
                  " follows the value in its own row, which is read as in force when the row was "
                  "measured (--input-row next reads it as acting from then on)"
            : u + " and " + driven + " move within one row" +
                  (feedback.empty()
                       ? ", exactly as a law without noise would move " + u
                       : ", and " + u + " answers to what " + feedback + " was before") +
                  ": read as a closed loop, in which " + u +
                  " acts from its row on (--input-row same reads it as in force when the row was "
                  "measured)");
  }
  return read;
}

DataSet asRead(DataSet data, const std::vector<bool>& same) {
  const auto n_y = static_cast<Index>(data.outputs.size());
  const Index rows = data.rows();
  std::vector<bool> gap(static_cast<std::size_t>(rows) + 1, true);
  for (Index k = 0; k < rows; ++k)
    gap[static_cast<std::size_t>(k)] = !data.values.row(k).array().isFinite().any();
  for (std::size_t j = 0; j < same.size(); ++j) {
    auto column = data.values.col(n_y + static_cast<Index>(j));
    for (Index k = 0; same[j] && k + 1 < rows; ++k)
      if (!gap[static_cast<std::size_t>(k)] && !gap[static_cast<std::size_t>(k) + 1])
        column[k] = column[k + 1];
  }
  return data;
}

}  // namespace fpc
