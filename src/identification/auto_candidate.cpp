#include "identification/auto_candidate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/number.hpp"
#include "identification/auto_knowledge.hpp"
#include "identification/auto_start.hpp"
#include "identification/auto_stress.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kUnit = 0.05;  // error that counts as one, in deviations of the output
constexpr double kOneStepWeight = 0.1;
constexpr int kRandomStarts = 16;
constexpr int kProbe = 8;        // iterations that tell a good start from a bad one
constexpr double kBeyond = 0.5;  // of the states' span: how far a run may leave them

/// Inputs, disturbances, each from its delay on, none that tell nothing; then other outputs.
std::vector<Regressor> exogenousOf(const AutoData& p, const Candidate& c) {
  const DataSet& data = *p.data;
  std::vector<Regressor> v;
  const int n_u = static_cast<int>(data.inputs.size());
  for (int j = 0; j < n_u + static_cast<int>(data.disturbances.size()); ++j) {
    const auto cause = static_cast<std::size_t>(j);
    if (p.isLeftOut(cause)) continue;
    const auto kind = j < n_u ? SignalKind::kInput : SignalKind::kDisturbance;
    const int terms = c.hidden ? 1 : c.input_terms, first = std::max(c.delay[cause] + c.later, 0);
    for (int lag = 0; lag < terms; ++lag) v.push_back({kind, j < n_u ? j : j - n_u, first + lag});
    if (c.second.empty() || c.hidden) continue;
    for (int lag = std::max(c.second[cause], first + terms); lag < c.second[cause] + terms; ++lag)
      v.push_back({kind, j < n_u ? j : j - n_u, lag});
  }
  for (const int other : c.partners)
    for (int lag = 0; lag < c.input_terms; ++lag) v.push_back({SignalKind::kOutput, other, lag});
  return v;
}

std::vector<Index> antecedentsOf(const Candidate& c, const std::vector<Regressor>& v) {
  std::vector<Index> z;
  const auto exogenous = static_cast<Index>(v.size());
  const Index n = c.order, step = c.hidden ? 1 : c.input_terms;
  const auto a = c.antecedents;
  if (a == AntecedentChoice::kOutput || a == AntecedentChoice::kOutputAndInputs) z.push_back(0);
  if (a == AntecedentChoice::kOutputs || a == AntecedentChoice::kState ||
      a == AntecedentChoice::kStateAndInputs)
    for (Index i = 0; i < n; ++i) z.push_back(i);
  if (a == AntecedentChoice::kInputs || a == AntecedentChoice::kOutputAndInputs ||
      a == AntecedentChoice::kStateAndInputs)
    for (Index j = 0; j < exogenous; ++j) {
      const auto i = static_cast<std::size_t>(j);  // the newest value of each signal
      if (i == 0 || v[i].kind != v[i - 1].kind || v[i].index != v[i - 1].index) z.push_back(n + j);
    }
  if (a == AntecedentChoice::kPartners)
    for (auto p = static_cast<Index>(c.partners.size()); p > 0; --p)
      z.push_back(n + exogenous - p * step);
  return z;
}

RecurrentShape shapeOf(const AutoData& data, const Candidate& c, const std::vector<Regressor>& v) {
  const auto exogenous = static_cast<Index>(v.size());
  RecurrentShape s;
  s.states = c.order;
  s.exogenous = exogenous;
  s.companion = !c.hidden;
  for (Index i = 0; i < s.states + exogenous; ++i) s.regressors.push_back(i);
  s.rules = c.rules;
  s.absolute = c.absolute;
  const double zero = c.absolute ? data.shift[data.output] / data.scale[data.output] : 0.0;
  if (data.lower < data.upper) {
    s.lower = data.lower + zero;
    s.upper = data.upper + zero;
  }
  if (c.rules > 1) s.antecedents = antecedentsOf(c, v);
  return s;
}

class CandidateFit {
 public:
  CandidateFit(const AutoData& data, const Candidate& c, const std::vector<Stretch>& stretches,
               const std::function<bool()>& proceed)
      : data_(data), c_(c), stretches_(stretches) {
    fitted_.exogenous = exogenousOf(data, c);
    record_ = recurrentData(data, fitted_.exogenous, c.absolute);
    fitted_.shape = shapeOf(data, c, fitted_.exogenous);
    linear_ = fitted_.shape;
    linear_.rules = 1;
    linear_.antecedents.clear();
    params_.free_unit = kUnit;
    params_.step_unit = kUnit * data.rate;
    params_.one_step_weight = c.hidden ? 0.0 : kOneStepWeight * data.rate * data.rate;
    if (proceed) proceed_ = [proceed](const Vector&) { return proceed(); };
  }

  Fitted run() {
    if (c_.absolute && !data_.known.empty()) return std::move(fitted_);  // its gains have no sign
    const RecurrentFitResult line = fitLinear();
    RecurrentFitResult best = line;
    if (c_.rules > 1 && line.finite) best = fitRules(line);
    fitted_.work = work_;
    fitted_.parameters = best.parameters;
    fitted_.finite = best.finite;
    if (c_.rules > 1 && best.finite && data_.reach == 0) {  // else all runs leave the data
      Fitted straight = fitted_;
      straight.shape = linear_;
      straight.parameters = line.parameters;
      fitted_.finite = endures(fitted_, straight, record_, stretches_);
      fitted_.wild = !fitted_.finite;
    }
    if (c_.hidden && best.finite) {
      settlePrior(best);
      fitted_.finite = fitted_.finite && restsAsKnown(data_, fitted_);
    }
    return std::move(fitted_);
  }

 private:
  RecurrentFitResult fit(const RecurrentShape& shape, const Vector& anchor, const Vector& start,
                         double ridge, int iterations) const {
    RecurrentFitParams params = params_;
    params.ridge = ridge;
    params.iterations = iterations;
    Fitted form = fitted_;
    form.shape = shape;
    params.admit = admission(data_, form);
    RecurrentFitResult result =
        fitRecurrent(shape, record_, stretches_, anchor, start, params, proceed_);
    work_ += result.work;
    return result;
  }

  /// A start that runs away is damped until it does not.
  RecurrentFitResult fitDamped(const Vector& start, int iterations) const {
    RecurrentFitResult result = fit(linear_, start, start, c_.linear_ridge, iterations);
    Vector damped = start;
    for (int i = 0; i < 60 && !result.finite; ++i) {
      for (Index r = 0; r < linear_.rows(); ++r)
        for (Index j = 0; j < linear_.states; ++j)
          damped[linear_.at(0, r) + j] *=
              linear_.companion ? std::pow(0.98, static_cast<double>(j + 1)) : 0.97;
      result = fit(linear_, start, damped, c_.linear_ridge, iterations);
    }
    return result;
  }

  RecurrentFitResult bestOf(const std::vector<Vector>& starts) const {
    RecurrentFitResult best;
    best.objective = std::numeric_limits<double>::infinity();
    for (const auto& start : starts) {
      RecurrentFitResult result = fitDamped(start, starts.size() > 1 ? kProbe : c_.iterations);
      if (result.finite && result.objective < best.objective) best = std::move(result);
    }
    if (starts.size() == 1 || !best.finite) return best;
    const Vector start = best.parameters;
    return fit(linear_, start, start, c_.linear_ridge, c_.iterations);
  }

  RecurrentFitResult fitLinear() const {
    if (!c_.hidden) {
      const Vector start = arxStart(linear_, record_, stretches_);
      return fitDamped(start, c_.free_run ? c_.iterations : 0);
    }
    std::vector<Vector> starts;
    if (c_.absolute) {
      for (int i = 0; i < kRandomStarts; ++i)
        starts.push_back(randomStart(linear_, c_.seed * 1000 + static_cast<std::uint64_t>(i)));
    } else if (c_.chain) {
      for (const double samples : {2.0, 6.0, 20.0, 60.0, 200.0})
        starts.push_back(chainStart(linear_, samples));
    } else {
      starts.push_back(observerStart(linear_, record_, stretches_));
    }
    return bestOf(starts);
  }

  /// Values of the antecedents along the record: measured outputs, or states of the linear model.
  Matrix antecedentValues(const RecurrentFitResult& line) const {
    const auto& z = fitted_.shape.antecedents;
    const Index n = linear_.states;
    std::vector<Vector> columns;
    for (std::size_t s = 0; s < stretches_.size(); ++s) {
      Matrix states;
      if (c_.hidden)
        states = statesOf(linear_, record_, stretches_[s], line.parameters,
                          line.starts.col(static_cast<Index>(s)));
      for (Index k = stretches_[s].first + n; k < stretches_[s].last; ++k) {
        Vector value(static_cast<Index>(z.size()));
        for (std::size_t j = 0; j < z.size(); ++j)
          value[static_cast<Index>(j)] = z[j] >= n   ? record_.v(z[j] - n, k)
                                         : c_.hidden ? states(z[j], k - stretches_[s].first)
                                                     : record_.y[k - z[j]];
        if (value.allFinite()) columns.push_back(value);
      }
    }
    Matrix values(static_cast<Index>(z.size()), static_cast<Index>(columns.size()));
    for (std::size_t k = 0; k < columns.size(); ++k) values.col(static_cast<Index>(k)) = columns[k];
    return values;
  }

  RecurrentFitResult fitRules(const RecurrentFitResult& line) {
    const RecurrentShape& shape = fitted_.shape;
    const Matrix z = antecedentValues(line);
    if (z.cols() < 5 * shape.rules) return {};
    if (!c_.hidden) {  // the states of a hidden model move with its rules
      params_.centre_lower = z.rowwise().minCoeff().replicate(shape.rules, 1);
      params_.centre_upper = z.rowwise().maxCoeff().replicate(shape.rules, 1);
    }
    Vector start = ruleStart(shape, z, line.parameters, 0.1 * data_.rate, c_.seed);
    Vector anchor = Vector::Zero(shape.parameterCount());
    for (Index r = 0; r < shape.rules; ++r)
      anchor.segment(shape.at(r, 0), line.parameters.size()) = line.parameters;
    const double ridge = c_.ridge / (data_.rate * data_.rate);
    RecurrentFitResult result = fit(shape, anchor, start, ridge, c_.iterations);
    if (result.finite) return result;
    start.head(shape.linearCount()) = anchor.head(shape.linearCount());
    return fit(shape, anchor, start, ridge, c_.iterations);
  }

  void settlePrior(const RecurrentFitResult& best) {
    const Index n = fitted_.shape.states;
    std::vector<Matrix> parts;
    Index count = 0;
    for (std::size_t s = 0; s < stretches_.size(); ++s) {
      parts.push_back(statesOf(fitted_.shape, record_, stretches_[s], best.parameters,
                               best.starts.col(static_cast<Index>(s))));
      count += parts.back().cols();
    }
    Matrix all(n, count);
    Index at = 0;
    for (const auto& part : parts) {
      all.middleCols(at, part.cols()) = part;
      at += part.cols();
    }
    StartPrior& prior = fitted_.prior;
    prior.mean = all.rowwise().mean();
    const Matrix away = all.colwise() - prior.mean;
    prior.covariance =
        away * away.transpose() / static_cast<double>(count) + 1e-6 * Matrix::Identity(n, n);
    prior.noise = std::max(data_.noise, 0.01);
    const Vector lowest = all.rowwise().minCoeff(), highest = all.rowwise().maxCoeff();
    prior.lower = lowest - kBeyond * (highest - lowest);
    prior.upper = highest + kBeyond * (highest - lowest);
  }

  const AutoData& data_;
  const Candidate& c_;
  const std::vector<Stretch>& stretches_;
  std::function<bool(const Vector&)> proceed_;
  RecurrentData record_;
  RecurrentShape linear_;
  RecurrentFitParams params_;
  mutable double work_{};
  Fitted fitted_;
};

Vector inOwnUnit(const AutoData& data, const Fitted& fitted, Vector y) {
  if (!fitted.shape.absolute) y.array() += data.shift[data.output] / data.scale[data.output];
  return y * data.scale[data.output];
}

}  // namespace

std::string Candidate::text() const {
  static const char* const on[] = {"y",         "all past y",       "inputs", "y and inputs",
                                   "the state", "state and inputs", "them"};
  std::string words = hidden ? "hidden state " + std::to_string(order)
                             : "y " + std::to_string(order) + ", u " + std::to_string(input_terms);
  if (absolute) words += ", size of";
  if (hidden && chain) words += ", chain";
  if (!partners.empty()) words += ", with other outputs";
  if (!second.empty()) words += " and later";
  if (later != 0) words += ", delays " + std::string(later > 0 ? "+" : "") + std::to_string(later);
  if (rules == 1) {
    if (!free_run) words += ", one-step fit";
    if (linear_ridge > 0.01) words += ", ridge " + printNumber(linear_ridge);
    return words;
  }
  return words + ", " + std::to_string(rules) + " rules on " +
         on[static_cast<std::size_t>(antecedents)] + ", ridge " + printNumber(ridge) +
         (seed > 1 ? ", seed " + std::to_string(seed) : "");
}

std::string Candidate::structure() const {
  Candidate first = *this;
  first.seed = 1;
  return first.text();
}

Fitted fitCandidate(const AutoData& data, const Candidate& candidate,
                    const std::vector<Stretch>& stretches, const std::function<bool()>& proceed) {
  return CandidateFit(data, candidate, stretches, proceed).run();
}

Vector freeRunOf(const AutoData& data, const Fitted& fitted, Stretch stretch, int window) {
  const RecurrentData record = recurrentData(data, fitted.exogenous, fitted.shape.absolute);
  const auto run = [&](Stretch s) {
    return runRecurrent(fitted.shape, record, s, fitted.parameters, fitted.prior, window);
  };
  if (data.reach == 0) return inOwnUnit(data, fitted, run(stretch));
  Vector all = Vector::Constant(record.y.size(), kNaN);
  for (const Stretch& piece : runsOf(data, {stretch})) {
    // the last measured rows of the start are all that it is to see
    const Index first = std::min(piece.first + kRunStart, piece.last);
    const Vector own = run({std::max(piece.first, first - fitted.shape.states), piece.last});
    all.segment(first, piece.last - first) = own.segment(first, piece.last - first);
  }
  return inOwnUnit(data, fitted, all);
}

Vector oneStepOf(const AutoData& data, const Fitted& fitted, Stretch stretch) {
  const RecurrentData record = recurrentData(data, fitted.exogenous, fitted.shape.absolute);
  const Index n = fitted.shape.states;
  Vector y = Vector::Constant(record.y.size(), std::numeric_limits<double>::quiet_NaN());
  RecurrentStep step(fitted.shape);
  Vector x(n), next(n);
  for (Index k = stretch.first + n - 1; k + 1 < stretch.last; ++k) {
    for (Index j = 0; j < n; ++j) x[j] = record.y[k - j];
    if (!x.allFinite() || !record.v.col(k).allFinite()) continue;
    step.predict(fitted.parameters, x, record.v.col(k), next);
    y[k + 1] = fitted.shape.output(next[0]);
  }
  return inOwnUnit(data, fitted, y);
}

}  // namespace fpc
