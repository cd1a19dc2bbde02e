#include "fmbpc/fuzzy/free_run_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fmbpc/fuzzy/firing_slopes.hpp"
#include "fmbpc/fuzzy/partition.hpp"
#include "fmbpc/optim/least_squares.hpp"
#include "fuzzy/knowledge_map.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kFarthest = 100.0;  // spans of the data: a run that leaves further has failed
constexpr double kEnough = 1e-6;  // relative fall of the objective below which the fit has settled
constexpr double kFirstDamping = 1e-3;  // of the number of rows
constexpr double kMostDamping = 1e6;

/// A model of one output whose coefficients are one vector, in columns scaled to mean 0 and
/// deviation 1.
class Simulator {
 public:
  Simulator(const DataSet& data, int output, const OutputModel& shape)
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

  Index unknowns() const { return static_cast<Index>(shape_.rules.size()) * x_.size(); }
  Index rows() const { return rows_; }  ///< of the last run

  Vector scaled(const std::vector<Rule>& rules) const {
    const Index p = x_.size();
    Vector theta(static_cast<Index>(rules.size()) * p);
    for (std::size_t r = 0; r < rules.size(); ++r) {
      auto part = theta.segment(static_cast<Index>(r) * p, p);
      part.head(p - 1) = rules[r].coefficients.cwiseProduct(scaling_.scale);
      part[p - 1] = rules[r].offset + rules[r].coefficients.dot(scaling_.shift);
    }
    return theta;
  }

  void write(const Vector& theta, std::vector<Rule>& rules) const {
    const Index p = x_.size();
    for (std::size_t r = 0; r < rules.size(); ++r) {
      const auto part = theta.segment(static_cast<Index>(r) * p, p);
      rules[r].coefficients = part.head(p - 1).cwiseQuotient(scaling_.scale);
      rules[r].offset = part[p - 1] - rules[r].coefficients.dot(scaling_.shift);
    }
  }

  /// Sum of squared errors of a free run, or one step ahead. With `squares`: adds a row per sample,
  /// the sensitivity of the prediction and its error, both over `unit`.
  double run(const Vector& theta, bool free, double unit, double weight, LeastSquares* squares);

 private:
  struct Source {
    Index column, lag;
    bool own;
  };
  void addSources(const std::vector<Regressor>& variables, int output,
                  std::vector<Source>& sources) {
    for (const auto& v : variables) {
      const bool own = v.kind == SignalKind::kOutput && v.index == output;
      sources.push_back({data_.column(v.kind, v.index), v.lag, own});
      longest_ = std::max(longest_, static_cast<Index>(v.lag));
      if (own) own_lags_ = std::max(own_lags_, static_cast<Index>(v.lag) + 1);
    }
  }
  double value(const Source& s, Index k) const {
    return s.own ? past_[k - s.lag] : data_.values(k - s.lag, s.column);
  }
  double predict(const Vector& theta, Index k);
  void differentiatePast(const Vector& theta);
  void differentiate(const Vector& theta, Index k, bool free);

  const DataSet& data_;
  const OutputModel& shape_;
  Index own_column_, longest_{}, own_lags_{}, rows_{};
  double span_{}, center_{};
  std::vector<Source> z_sources_, x_sources_;
  ColumnScaling scaling_;
  Vector z_, x_, past_, gradient_;
  Matrix sensitivity_;  // of the last own_lags_ predictions, a ring of columns
  Matrix slopes_;       // of the weights: rules x antecedents
  Vector consequents_, past_slope_;
  FiringResult firing_;
};

/// Prediction of k + 1 from past_; leaves x_ (scaled, with 1) and firing_ for differentiate().
double Simulator::predict(const Vector& theta, Index k) {
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
void Simulator::differentiatePast(const Vector& theta) {
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
void Simulator::differentiate(const Vector& theta, Index k, bool free) {
  const Index p = x_.size(), ring = sensitivity_.cols();
  for (Index r = 0; r < firing_.weights.size(); ++r)
    gradient_.segment(r * p, p) = firing_.weights[r] * x_;
  if (!free || own_lags_ == 0) return;
  differentiatePast(theta);
  for (Index lag = 0; lag < own_lags_; ++lag)
    gradient_ += past_slope_[lag] * sensitivity_.col((k - lag) % ring);
}

double Simulator::run(const Vector& theta, bool free, double unit, double weight,
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

/// The objective and its Gauss-Newton steps.
class Fit {
 public:
  using Admit = std::function<bool(const Matrix& metric, Vector& theta)>;

  Fit(Simulator& simulator, const ConsequentParams& params, const Vector& linear, Admit admit)
      : simulator_(simulator), params_(params), linear_(linear), admit_(std::move(admit)) {
    const double free = simulator.run(linear, true, 1.0, 1.0, nullptr);
    const double rows = static_cast<double>(std::max<Index>(simulator.rows(), 1));
    free_unit_ = unitOf(free, rows);
    step_unit_ = unitOf(simulator.run(linear, false, 1.0, 1.0, nullptr), rows);
  }

  double objective(const Vector& theta) {
    const double free = simulator_.run(theta, true, 1.0, 1.0, nullptr) / (free_unit_ * free_unit_);
    if (!std::isfinite(free)) return free;
    double sum = free + pull() * (theta - linear_).squaredNorm();
    if (params_.one_step_weight > 0.0)
      sum += params_.one_step_weight * simulator_.run(theta, false, 1.0, 1.0, nullptr) /
             (step_unit_ * step_unit_);
    return sum;
  }

  LeastSquares linearise(const Vector& theta) {
    LeastSquares squares(simulator_.unknowns());
    simulator_.run(theta, true, free_unit_, 1.0, &squares);
    if (params_.one_step_weight > 0.0)
      simulator_.run(theta, false, step_unit_, params_.one_step_weight, &squares);
    Vector row = Vector::Zero(simulator_.unknowns());
    for (Index i = 0; i < row.size(); ++i) {
      row[i] = 1.0;
      squares.add(row, linear_[i] - theta[i], pull());
      row[i] = 0.0;
    }
    return squares;
  }

  /// One damped step that lowers the objective. @return false if there is none.
  bool improve(Vector& theta, double& best) {
    LeastSquares squares = linearise(theta);
    const double rows = static_cast<double>(squares.rows());
    for (; damping_ < kMostDamping; damping_ *= 8.0) {
      Vector next = theta + squares.solve(damping_ * rows).theta;
      if (admit_ && !admit_(squares.metric(), next)) continue;
      const double reached = objective(next);
      if (!(reached < best)) continue;
      const bool settled = reached > (1.0 - kEnough) * best;
      theta = next;
      best = reached;
      damping_ = std::max(damping_ / 8.0, 1e-12);
      return !settled;
    }
    return false;
  }

 private:
  static double unitOf(double sum, double rows) {
    const double rms = std::sqrt(sum / rows);
    return std::isfinite(rms) && rms > 0.0 ? rms : 1.0;
  }

  /// The ridge in the units of the objective.
  double pull() const { return params_.ridge / (step_unit_ * step_unit_); }

  Simulator& simulator_;
  const ConsequentParams& params_;
  Vector linear_;
  Admit admit_;
  double free_unit_{1.0}, step_unit_{1.0}, damping_{kFirstDamping};
};

/// Moves coefficients to the nearest that agree with what is known; empty if nothing is.
Fit::Admit admission(const DataSet& data, int output, const OutputModel& model,
                     const Simulator& simulator, const PriorKnowledge& known) {
  if (known.empty()) return {};
  const auto consequents = [&simulator, own = model](const Vector& theta) mutable {
    simulator.write(theta, own.rules);
    return stackedConsequents(own.rules);
  };
  const KnowledgeRows rows =
      inParameters(knowledgeRows(model, output, data, known), simulator.unknowns(), consequents);
  return
      [&simulator, &known, rows, own = model, output](const Matrix& metric, Vector& theta) mutable {
        const double little = 1e-9 * metric.trace() + 1e-300;
        const Matrix H = metric + little * Matrix::Identity(metric.rows(), metric.cols());
        if (!nearestInside(rows, H, theta)) return false;
        simulator.write(theta, own.rules);
        return keepsPoles(own, output, known);
      };
}

}  // namespace

FreeRunFit fitFreeRun(const DataSet& data, int output, const OutputModel& linear,
                      const ConsequentParams& params, OutputModel& model,
                      const std::function<bool()>& proceed, const PriorKnowledge& known) {
  Simulator simulator(data, output, model);
  const std::vector<Rule> same(model.rules.size(), linear.rules.front());
  const Vector start = simulator.scaled(same);
  Fit fit(simulator, params, start, admission(data, output, model, simulator, known));
  const auto rms = [&](const Vector& theta) {
    const double sum = simulator.run(theta, true, 1.0, 1.0, nullptr);
    return std::sqrt(sum / static_cast<double>(std::max<Index>(simulator.rows(), 1)));
  };
  FreeRunFit result;
  Vector theta = simulator.scaled(model.rules);
  result.before = rms(theta);
  double best = fit.objective(theta);
  const double best_linear = fit.objective(start);
  if (best_linear < best) {
    theta = start;
    best = best_linear;
  }
  if (!std::isfinite(best)) return result;
  bool going = true;
  while (going && result.iterations < params.free_run_iterations) {
    result.cancelled = proceed && !proceed();
    if (result.cancelled) return result;
    going = fit.improve(theta, best);
    ++result.iterations;
  }
  result.after = rms(theta);
  simulator.write(theta, model.rules);
  return result;
}

}  // namespace fpc
