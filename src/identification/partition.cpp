// Projection of clusters on single variables, and grids. Source:
// babuska1998, sec. 4.4.
#include "identification/partition.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kSmallestWidth = 1e-3;  // of the variable's deviation: no set is thinner
constexpr double kShoulder = 0.85;       // of the highest membership: counts as belonging fully
constexpr double kFaintest = 0.02;       // memberships below say nothing about a flank
constexpr double kFootDecay = 7.0;  // mu = exp(-7) at the feet, see MembershipShape::kExponential
constexpr Index kBins = 60;

double deviation(const Eigen::Ref<const Vector>& values) {
  return std::sqrt((values.array() - values.mean()).square().mean());
}

/// Highest membership in bins of equally many samples, ordered by the variable.
struct Envelope {
  std::vector<double> at, level;
};

Envelope envelopeOf(const Eigen::Ref<const Vector>& values,
                    const Eigen::Ref<const Vector>& memberships) {
  std::vector<Index> order(static_cast<std::size_t>(values.size()));
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return values[a] < values[b]; });
  const Index bins = std::min(kBins, values.size());
  Envelope envelope;
  for (Index b = 0; b < bins; ++b) {
    Index best = order[static_cast<std::size_t>(b * values.size() / bins)];
    for (Index i = b * values.size() / bins; i < (b + 1) * values.size() / bins; ++i) {
      const Index k = order[static_cast<std::size_t>(i)];
      if (memberships[k] > memberships[best]) best = k;
    }
    envelope.at.push_back(values[best]);
    envelope.level.push_back(memberships[best]);
  }
  const double highest = *std::max_element(envelope.level.begin(), envelope.level.end());
  for (double& level : envelope.level) level /= std::max(highest, 1e-300);
  return envelope;
}

/// Distance from shoulder to foot: least squares on sqrt(-log mu) = sqrt(7) beyond / width.
double flankWidth(const Envelope& envelope, double shoulder, double direction, double fallback) {
  double numerator = 0.0, denominator = 0.0;
  for (std::size_t i = 0; i < envelope.at.size(); ++i) {
    const double beyond = direction * (envelope.at[i] - shoulder);
    if (beyond <= 0.0 || envelope.level[i] < kFaintest || envelope.level[i] >= 1.0) continue;
    const double root = std::sqrt(-std::log(envelope.level[i]) / kFootDecay);
    numerator += beyond * beyond;
    denominator += beyond * root;
  }
  return denominator > 0.0 ? numerator / denominator : fallback;
}

Membership exponentialSet(const Eigen::Ref<const Vector>& values,
                          const Eigen::Ref<const Vector>& memberships, double width) {
  const Envelope envelope = envelopeOf(values, memberships);
  double left = envelope.at.back(), right = envelope.at.front();
  for (std::size_t i = 0; i < envelope.at.size(); ++i) {
    if (envelope.level[i] < kShoulder) continue;
    left = std::min(left, envelope.at[i]);
    right = std::max(right, envelope.at[i]);
  }
  const double thinnest = kSmallestWidth * deviation(values);
  const double span = std::max(values.maxCoeff() - values.minCoeff(), thinnest);
  const double left_width = std::max(flankWidth(envelope, left, -1.0, span), thinnest);
  const double right_width = std::max(flankWidth(envelope, right, 1.0, span), thinnest);
  return {MembershipShape::kExponential,
          {left - width * left_width, left, right, right + width * right_width}};
}

Membership gaussianSet(const Eigen::Ref<const Vector>& values,
                       const Eigen::Ref<const Vector>& memberships, double fuzziness,
                       double width) {
  const Eigen::ArrayXd weights = memberships.array().pow(fuzziness);
  const double total = std::max(weights.sum(), 1e-300);
  const double center = (weights * values.array()).sum() / total;
  const double spread = std::sqrt((weights * (values.array() - center).square()).sum() / total);
  const double thinnest =
      std::max(kSmallestWidth * deviation(values), 1e-12 * (1.0 + std::abs(center)));
  return {MembershipShape::kGaussian, {center, width * std::max(spread, thinnest)}};
}

}  // namespace

Matrix ColumnScaling::apply(MatrixRef values) const {
  return (values.rowwise() - shift.transpose()) * scale.cwiseInverse().asDiagonal();
}

ColumnScaling columnScaling(MatrixRef values, Scaling scaling) {
  ColumnScaling result{Vector::Zero(values.cols()), Vector::Ones(values.cols())};
  if (scaling == Scaling::kNone || values.rows() == 0) return result;
  for (Index j = 0; j < values.cols(); ++j) {
    const auto column = values.col(j);
    const bool range = scaling == Scaling::kRange;
    result.shift[j] = range ? column.minCoeff() : column.mean();
    const double scale = range ? column.maxCoeff() - column.minCoeff() : deviation(column);
    if (scale > 1e-14 * (1e-300 + std::abs(result.shift[j]))) result.scale[j] = scale;
  }
  return result;
}

Membership projectCluster(const Eigen::Ref<const Vector>& values,
                          const Eigen::Ref<const Vector>& memberships, MembershipShape shape,
                          double fuzziness, double width) {
  return shape == MembershipShape::kGaussian ? gaussianSet(values, memberships, fuzziness, width)
                                             : exponentialSet(values, memberships, width);
}

std::vector<Rule> projectClusters(MatrixRef antecedents, const Clusters& clusters,
                                  const PartitionParams& params, Index n_regressors) {
  std::vector<Rule> rules;
  for (Index i = 0; i < clusters.count(); ++i) {
    Rule rule;
    rule.coefficients = Vector::Zero(n_regressors);
    const Vector memberships = clusters.memberships.row(i).transpose();
    for (Index j = 0; j < antecedents.cols(); ++j)
      rule.antecedents.push_back(projectCluster(antecedents.col(j), memberships, params.membership,
                                                params.fuzziness, params.width));
    rules.push_back(rule);
  }
  return rules;
}

std::vector<Rule> gridRules(const std::vector<std::vector<Membership>>& sets, Index n_regressors) {
  std::vector<Rule> rules(1);
  rules.front().coefficients = Vector::Zero(n_regressors);
  for (const auto& of_variable : sets) {
    std::vector<Rule> longer;
    for (const auto& rule : rules)
      for (const auto& set : of_variable) {
        longer.push_back(rule);
        longer.back().antecedents.push_back(set);
      }
    rules = std::move(longer);
  }
  return rules;
}

}  // namespace fpc
