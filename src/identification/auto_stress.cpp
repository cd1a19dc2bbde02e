#include "identification/auto_stress.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kStretch = 1.2;        // of the inputs' moves
constexpr double kStressBeyond = 0.15;  // of an input's range, below and above it
constexpr Index kHeld = 150;            // samples
constexpr double kAllowed = 3.0;        // ranges of y beyond it
constexpr double kNearStress = 1.0;     // the same, under the inputs as they were
constexpr double kTimes = 5.0;          // the linear model's excursion

struct Excursion {
  double lower{std::numeric_limits<double>::infinity()}, upper{-lower};
  void add(double v) {
    if (std::isfinite(v)) lower = std::min(lower, v), upper = std::max(upper, v);
  }
  double span() const { return upper - lower; }
};

/// Lowest and highest output of a run from the mean of the data; infinite if it runs away.
Excursion excursion(const Fitted& fitted, const Matrix& inputs, double start) {
  constexpr double kAway = 1e3;
  const Index n = fitted.shape.states;
  RecurrentStep step(fitted.shape);
  Vector x = fitted.shape.companion ? Vector::Constant(n, start) : Vector::Zero(n), next(n);
  Excursion range;
  for (Index k = 0; k < inputs.cols(); ++k) {
    if (!inputs.col(k).allFinite()) continue;
    step.predict(fitted.parameters, x, inputs.col(k), next);
    x = next;
    range.add(fitted.shape.output(x[0]));  // a sensor at its limit hides what is beyond
    if (!(std::abs(x[0]) < kAway))
      return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
  return range;
}

/// The stretches' inputs behind each other.
Matrix joinedInputs(const RecurrentData& record, const std::vector<Stretch>& stretches) {
  Index length = 0, at = 0;
  for (const auto& s : stretches) length += s.last - s.first;
  Matrix inputs(record.v.rows(), length);
  for (const auto& s : stretches) {
    inputs.middleCols(at, s.last - s.first) = record.v.middleCols(s.first, s.last - s.first);
    at += s.last - s.first;
  }
  return inputs;
}

/// The stretches' inputs made larger, then each input at its edges.
Matrix stressInputs(const Matrix& joined) {
  const Index m = joined.rows(), length = joined.cols();
  Matrix inputs(m, length + 2 * m * kHeld);
  inputs.leftCols(length) = joined;
  Vector mean = Vector::Zero(m);
  std::vector<Excursion> ranges(static_cast<std::size_t>(m));
  Index at = length;
  for (Index j = 0; j < m; ++j) {
    double count = 0.0;
    for (Index k = 0; k < length; ++k)
      if (std::isfinite(inputs(j, k))) {
        mean[j] += inputs(j, k);
        count += 1.0;
        ranges[static_cast<std::size_t>(j)].add(inputs(j, k));
      }
    mean[j] /= std::max(count, 1.0);
  }
  inputs.leftCols(length) =
      ((inputs.leftCols(length).colwise() - mean) * kStretch).colwise() + mean;
  for (Index j = 0; j < m; ++j)
    for (const bool above : {false, true}) {
      const Excursion& r = ranges[static_cast<std::size_t>(j)];
      auto held = inputs.middleCols(at, kHeld);
      held.colwise() = mean;
      held.row(j).setConstant(above ? r.upper + kStressBeyond * r.span()
                                    : r.lower - kStressBeyond * r.span());
      at += kHeld;
    }
  return inputs;
}

/// The run stays within `room` of the data, or within kTimes the linear model's excursion.
bool staysNear(const Excursion& run, const Excursion& line, const Excursion& data, double mean,
               double room) {
  const double lowest = std::min(data.lower - room, mean + kTimes * (line.lower - mean));
  const double highest = std::max(data.upper + room, mean + kTimes * (line.upper - mean));
  return run.lower >= lowest && run.upper <= highest && std::isfinite(run.span());
}

/// From the lowest and the highest y of the data the inputs as they were bring the output back.
bool comesBack(const Fitted& fitted, const Matrix& inputs, const Excursion& data) {
  if (!fitted.shape.companion) return true;  // no state belongs to an output alone
  for (const double start : {data.lower, data.upper}) {
    const Excursion run = excursion(fitted, inputs, start);
    if (!(run.lower >= data.lower - kNearStress * data.span() &&
          run.upper <= data.upper + kNearStress * data.span()))
      return false;
  }
  return true;
}

}  // namespace

bool endures(const Fitted& fitted, const Fitted& linear, const RecurrentData& record,
             const std::vector<Stretch>& stretches) {
  Excursion data;
  double sum = 0.0, count = 0.0;
  for (const auto& s : stretches)
    for (Index k = s.first; k < s.last; ++k) {
      data.add(record.y[k]);
      if (std::isfinite(record.y[k])) sum += record.y[k], count += 1.0;
    }
  if (!(count > 0.0)) return false;
  const Matrix own = joinedInputs(record, stretches), larger = stressInputs(own);
  const double mean = sum / count;
  return staysNear(excursion(fitted, larger, mean), excursion(linear, larger, mean), data, mean,
                   kAllowed * data.span()) &&
         (comesBack(fitted, own, data) || !comesBack(linear, own, data));
}

}  // namespace fpc
