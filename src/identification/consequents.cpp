// Source: babuska1998, sec. 4.5 (local and global weighted least
// squares).
#include "identification/consequents.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "identification/partition.hpp"
#include "identification/rule_neighbour.hpp"
#include "optim/least_squares.hpp"
#include "optim/rls.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kFaintestWeight = 1e-9;  // rows that weigh less do not enter a fit
constexpr double kRecursiveRidge = 1e-6;  // a recursion needs some start

/// Scaled rows [x 1] and what the linear model leaves over of the target.
class ScaledRows {
 public:
  ScaledRows(const Regression& data, const OutputModel& linear)
      : scaling_(columnScaling(data.regressors, Scaling::kDeviation)),
        rows_(scaling_.apply(data.regressors)),
        base_(linear.rules.front()),
        rest_(data.target - data.regressors * base_.coefficients -
              Vector::Constant(data.target.size(), base_.offset)),
        row_(rows_.cols() + 1) {
    row_[rows_.cols()] = 1.0;
  }

  Index unknowns() const { return row_.size(); }
  const Vector& row(Index k) {
    row_.head(rows_.cols()) = rows_.row(k).transpose();
    return row_;
  }
  double rest(Index k) const { return rest_[k]; }

  /// Writes the linear model plus a deviation in scaled columns into a rule.
  void write(const Eigen::Ref<const Vector>& deviation, Rule& rule) const {
    const Vector slopes = deviation.head(rows_.cols()).cwiseQuotient(scaling_.scale);
    rule.coefficients = base_.coefficients + slopes;
    rule.offset = base_.offset + deviation[rows_.cols()] - slopes.dot(scaling_.shift);
  }

 private:
  ColumnScaling scaling_;
  Matrix rows_;
  Rule base_;
  Vector rest_, row_;
};

/// Firing weights of all rules at every sample (rules x samples).
Matrix firingMatrix(const Regression& data, const OutputModel& model) {
  Matrix weights(static_cast<Index>(model.rules.size()), data.rows());
  FiringResult firing;
  Vector antecedents(data.antecedents.cols());
  for (Index k = 0; k < data.rows(); ++k) {
    antecedents = data.antecedents.row(k).transpose();
    firingWeights(model, antecedents, firing);
    weights.col(k) = firing.weights;
  }
  return weights;
}

std::vector<RuleFit> countEvidence(const Matrix& weights) {
  std::vector<RuleFit> fits(static_cast<std::size_t>(weights.rows()));
  for (Index k = 0; k < weights.cols(); ++k) {
    Index strongest = 0;
    weights.col(k).maxCoeff(&strongest);
    ++fits[static_cast<std::size_t>(strongest)].samples;
  }
  for (Index i = 0; i < weights.rows(); ++i)
    fits[static_cast<std::size_t>(i)].evidence = weights.row(i).sum();
  return fits;
}

void fitLocal(ScaledRows& rows, const Matrix& weights, const ConsequentParams& params,
              OutputModel& model, std::vector<RuleFit>& fits) {
  for (std::size_t i = 0; i < fits.size(); ++i) {
    LeastSquares squares(rows.unknowns());
    for (Index k = 0; k < weights.cols(); ++k) {
      const double weight = weights(static_cast<Index>(i), k);
      if (weight < std::max(kFaintestWeight, params.weight_threshold)) continue;
      squares.add(rows.row(k), rows.rest(k),
                  params.weight_power == 1.0 ? weight : std::pow(weight, params.weight_power));
    }
    const auto solution = squares.solve(params.ridge);
    fits[i].condition = solution.condition;
    rows.write(solution.theta, model.rules[i]);
  }
}

void fitGlobal(ScaledRows& rows, const Matrix& weights, const ConsequentParams& params,
               OutputModel& model, std::vector<RuleFit>& fits) {
  const Index p = rows.unknowns();
  LeastSquares squares(p * weights.rows());
  Vector wide(p * weights.rows());
  for (Index k = 0; k < weights.cols(); ++k) {
    const Vector& row = rows.row(k);
    for (Index i = 0; i < weights.rows(); ++i) wide.segment(i * p, p) = weights(i, k) * row;
    squares.add(wide, rows.rest(k));
  }
  const auto solution = squares.solve(params.ridge);
  for (std::size_t i = 0; i < fits.size(); ++i) {
    fits[i].condition = solution.condition;
    rows.write(solution.theta.segment(static_cast<Index>(i) * p, p), model.rules[i]);
  }
}

void fitRecursive(ScaledRows& rows, const Matrix& weights, const ConsequentParams& params,
                  OutputModel& model, std::vector<RuleFit>& fits) {
  RlsParams rls;
  rls.forgetting = params.forgetting;
  rls.initial_covariance = 1.0 / std::max(params.ridge, kRecursiveRidge);
  rls.covariance_bound = 100.0 * rls.initial_covariance;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    RecursiveLeastSquares recursion(Vector::Zero(rows.unknowns()), rls);
    LeastSquares squares(rows.unknowns());
    for (Index k = 0; k < weights.cols(); ++k) {
      const double weight = weights(static_cast<Index>(i), k);
      if (weight < kFaintestWeight) continue;
      const Vector& row = rows.row(k);
      recursion.update(row, rows.rest(k), weight);
      squares.add(row, 0.0, weight);
    }
    fits[i].condition = squares.solve().condition;
    rows.write(recursion.theta(), model.rules[i]);
  }
}

/// Words for why a rule must not be trusted; empty if it may be.
std::string scarcity(const RuleFit& fit, Index unknowns, const ConsequentParams& params) {
  const double needed = params.samples_per_coefficient * static_cast<double>(unknowns);
  if (fit.evidence < needed)
    return "evidence of " + exactText(std::round(10.0 * fit.evidence) / 10.0) +
           " samples, fewer than " + exactText(needed);
  if (params.method != ConsequentMethod::kGlobal && params.ridge == 0.0 &&
      !(fit.condition <= params.max_condition))
    return "its data do not determine all coefficients";
  return "";
}

/// The nearest rules that were fitted stand in; without any the linear model stays.
void borrowFromNeighbours(std::vector<RuleFit>& fits, OutputModel& model) {
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (fits[i].status != RuleStatus::kBorrowed) continue;
    fits[i].lender = nearestFitted(model, fits, i);
    if (fits[i].lender < 0) continue;
    const Rule& lender = model.rules[static_cast<std::size_t>(fits[i].lender)];
    model.rules[i].coefficients = lender.coefficients;
    model.rules[i].offset = lender.offset;
  }
}

void settleScarce(std::vector<RuleFit>& fits, const Rule& linear, Index unknowns,
                  const ConsequentParams& params, OutputModel& model) {
  for (std::size_t i = 0; i < fits.size(); ++i) {
    Rule& rule = model.rules[i];
    fits[i].remark = scarcity(fits[i], unknowns, params);
    if (fits[i].remark.empty() && !(rule.coefficients.allFinite() && std::isfinite(rule.offset)))
      fits[i].remark = "its fit is not finite";
    if (!fits[i].remark.empty()) {
      require(params.scarce != ScarceRule::kError, "rule " + std::to_string(i + 1),
              "enough data: " + fits[i].remark);
      fits[i].status =
          params.scarce == ScarceRule::kDrop ? RuleStatus::kDropped : RuleStatus::kBorrowed;
      rule.coefficients = linear.coefficients;
      rule.offset = linear.offset;
    }
    rule.data_count = static_cast<std::uint64_t>(std::llround(fits[i].evidence));
  }
  if (params.scarce == ScarceRule::kNeighbour) borrowFromNeighbours(fits, model);
  std::vector<Rule> kept;
  for (std::size_t i = 0; i < fits.size(); ++i)
    if (fits[i].status != RuleStatus::kDropped) kept.push_back(model.rules[i]);
  require(!kept.empty(), "rules", "data for at least one; all were dropped");
  model.rules = std::move(kept);
}

}  // namespace

OutputModel fitLinear(const Regression& data, const std::vector<Regressor>& regressors,
                      RuleFit& fit) {
  OutputModel model;
  model.regressors = regressors;
  Rule rule;
  rule.coefficients = Vector::Zero(data.regressors.cols());
  rule.data_count = static_cast<std::uint64_t>(data.rows());
  model.rules = {rule};
  ScaledRows rows(data, model);
  LeastSquares squares(rows.unknowns());
  for (Index k = 0; k < data.rows(); ++k) squares.add(rows.row(k), rows.rest(k));
  const auto solution = squares.solve();
  rows.write(solution.theta, model.rules.front());
  fit.evidence = static_cast<double>(data.rows());
  fit.samples = static_cast<std::uint64_t>(data.rows());
  fit.condition = solution.condition;
  return model;
}

std::vector<RuleFit> fitConsequents(const Regression& data, const OutputModel& linear,
                                    const ConsequentParams& params, OutputModel& model) {
  ScaledRows rows(data, linear);
  const Matrix weights = firingMatrix(data, model);
  auto fits = countEvidence(weights);
  switch (params.method) {
    case ConsequentMethod::kLocal:
      fitLocal(rows, weights, params, model, fits);
      break;
    case ConsequentMethod::kGlobal:
      fitGlobal(rows, weights, params, model, fits);
      break;
    case ConsequentMethod::kRecursive:
      fitRecursive(rows, weights, params, model, fits);
      break;
  }
  settleScarce(fits, linear.rules.front(), rows.unknowns(), params, model);
  return fits;
}

}  // namespace fpc
