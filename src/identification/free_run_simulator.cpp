#include "identification/free_run_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/firing_slopes.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kFarthest = 100.0;  // spans of the data: a run that leaves further has failed

}  // namespace

FreeRunSimulator::FreeRunSimulator(const DataSet& data, int output, const OutputModel& shape)
    : data_(data), shape_(shape), own_column_(data.column(SignalKind::kOutput, output)) {
  const Regression rows = makeRegression(data, shape.regressors, shape.antecedents, output);
  scaling_ = columnScaling(rows.regressors, Scaling::kDeviation);
  addSources(shape.antecedents, output, z_sources_);
  addSources(shape.regressors, output, x_sources_);
  const SignalInfo& signal = data.outputs[static_cast<std::size_t>(output)];
  span_ = signal.upper - signal.lower;
  center_ = 0.5 * (signal.upper + signal.lower);
  z_.resize(static_cast<Index>(z_sources_.size()));
  x_.resize(static_cast<Index>(x_sources_.size()) + 1);
  gradient_.resize(unknowns());
  slopes_.resize(static_cast<Index>(shape.rules.size()), z_.size());
  consequents_.resize(slopes_.rows());
  past_slope_.resize(own_lags_);
}

Vector FreeRunSimulator::scaled(const std::vector<Rule>& rules) const {
  const Index p = x_.size();
  Vector theta(static_cast<Index>(rules.size()) * p);
  for (std::size_t r = 0; r < rules.size(); ++r) {
    auto part = theta.segment(static_cast<Index>(r) * p, p);
    part.head(p - 1) = rules[r].coefficients.cwiseProduct(scaling_.scale);
    part[p - 1] = rules[r].offset + rules[r].coefficients.dot(scaling_.shift);
  }
  return theta;
}

void FreeRunSimulator::write(const Vector& theta, std::vector<Rule>& rules) const {
  const Index p = x_.size();
  for (std::size_t r = 0; r < rules.size(); ++r) {
    const auto part = theta.segment(static_cast<Index>(r) * p, p);
    rules[r].coefficients = part.head(p - 1).cwiseQuotient(scaling_.scale);
    rules[r].offset = part[p - 1] - rules[r].coefficients.dot(scaling_.shift);
  }
}

void FreeRunSimulator::addSources(const std::vector<Regressor>& variables, int output,
                                  std::vector<Source>& sources) {
  for (const auto& v : variables) {
    const bool own = v.kind == SignalKind::kOutput && v.index == output;
    sources.push_back({data_.column(v.kind, v.index), v.lag, own});
    longest_ = std::max(longest_, static_cast<Index>(v.lag));
    if (own) own_lags_ = std::max(own_lags_, static_cast<Index>(v.lag) + 1);
  }
}

/// Prediction of k + 1 from past_; leaves x_ (scaled, with 1) and firing_ for differentiate().
double FreeRunSimulator::predict(const Vector& theta, Index k) {
  for (std::size_t j = 0; j < z_sources_.size(); ++j)
    z_[static_cast<Index>(j)] = value(z_sources_[j], k);
  const Index p = x_.size();
  for (Index j = 0; j < p - 1; ++j)
    x_[j] =
        (value(x_sources_[static_cast<std::size_t>(j)], k) - scaling_.shift[j]) / scaling_.scale[j];
  x_[p - 1] = 1.0;
  if (!z_.allFinite() || !x_.allFinite()) return std::numeric_limits<double>::quiet_NaN();
  firingWeights(shape_, z_, firing_);
  double sum = 0.0;
  for (Index r = 0; r < firing_.weights.size(); ++r)
    if (firing_.weights[r] > 0.0) sum += firing_.weights[r] * x_.dot(theta.segment(r * p, p));
  return sum;
}

/// Into past_slope_: the derivatives of the prediction just made by the own past, lag by lag.
void FreeRunSimulator::differentiatePast(const Vector& theta) {
  const Index p = x_.size();
  past_slope_.setZero();
  for (Index r = 0; r < firing_.weights.size(); ++r)
    consequents_[r] = x_.dot(theta.segment(r * p, p));
  for (std::size_t j = 0; j < x_sources_.size(); ++j) {
    if (!x_sources_[j].own) continue;
    double blended = 0.0;
    for (Index r = 0; r < firing_.weights.size(); ++r)
      blended += firing_.weights[r] * theta[r * p + static_cast<Index>(j)];
    past_slope_[x_sources_[j].lag] += blended / scaling_.scale[static_cast<Index>(j)];
  }
  firingSlopes(shape_, z_, firing_, slopes_);
  for (std::size_t i = 0; i < z_sources_.size(); ++i)
    if (z_sources_[i].own)
      past_slope_[z_sources_[i].lag] += slopes_.col(static_cast<Index>(i)).dot(consequents_);
}

/// gradient_ of the prediction just made: its own rules, and in free run what they did to the past.
void FreeRunSimulator::differentiate(const Vector& theta, Index k, bool free) {
  const Index p = x_.size(), ring = sensitivity_.cols();
  for (Index r = 0; r < firing_.weights.size(); ++r)
    gradient_.segment(r * p, p) = firing_.weights[r] * x_;
  if (!free || own_lags_ == 0) return;
  differentiatePast(theta);
  for (Index lag = 0; lag < own_lags_; ++lag)
    gradient_ += past_slope_[lag] * sensitivity_.col((k - lag) % ring);
}

double FreeRunSimulator::run(const Vector& theta, bool free, double unit, double weight,
                             LeastSquares* squares) {
  past_ = data_.values.col(own_column_);
  sensitivity_ = Matrix::Zero(unknowns(), std::max<Index>(own_lags_, 1));
  const Index ring = sensitivity_.cols();
  double sum = 0.0;
  rows_ = 0;
  for (Index k = longest_; k + 1 < past_.size(); ++k) {
    auto newest = sensitivity_.col((k + 1) % ring);
    const double predicted = predict(theta, k);
    const double measured = data_.values(k + 1, own_column_);
    if (!std::isfinite(predicted)) {
      newest.setZero();
      continue;
    }
    if (std::abs(predicted - center_) > kFarthest * span_)
      return std::numeric_limits<double>::infinity();
    if (squares != nullptr) {
      differentiate(theta, k, free);
      newest = gradient_;
    }
    if (free) past_[k + 1] = predicted;
    if (!std::isfinite(measured)) continue;
    const double error = measured - predicted;
    sum += error * error;
    ++rows_;
    if (squares != nullptr) squares->add(gradient_ / unit, error / unit, weight);
  }
  return sum;
}

}  // namespace fpc
