// Clusters as sets on all antecedents at once. Source: babuska1998,
// sec. 4.4.
#include <algorithm>
#include <cmath>

#include "base/decompositions.hpp"
#include "identification/partition.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kThinnest = 1e-3;  // of a variable's deviation, in any direction

/// Deviations, 0 for what does not move beyond rounding.
Vector deviations(MatrixRef values) {
  Vector found(values.cols());
  for (Index j = 0; j < values.cols(); ++j) {
    const double mean = values.col(j).mean();
    found[j] = std::sqrt((values.col(j).array() - mean).square().mean());
    if (found[j] <= 1e-12 * std::abs(mean)) found[j] = 0.0;
  }
  return found;
}

/// Covariance of the antecedents in a cluster, in their own units.
Matrix covarianceOf(MatrixRef antecedents, const Clusters& clusters, Index cluster,
                    const Vector& center, const ColumnScaling& scaling, bool adaptive) {
  const Index n = antecedents.cols();
  if (adaptive) {
    const auto scale = scaling.scale.head(n).asDiagonal();
    return scale * clusters.covariances[static_cast<std::size_t>(cluster)].topLeftCorner(n, n) *
           scale;
  }
  Matrix sum = Matrix::Zero(n, n);
  double total = 0.0;
  Vector away(n);
  for (Index k = 0; k < antecedents.rows(); ++k) {
    const double weight = std::pow(clusters.memberships(cluster, k), clusters.fuzziness);
    away = antecedents.row(k).transpose() - center;
    sum.selfadjointView<Eigen::Lower>().rankUpdate(away, weight);
    total += weight;
  }
  return Matrix(sum.selfadjointView<Eigen::Lower>()) / std::max(total, 1e-300);
}

/// Inverse in units of the deviations, where directions can be compared; exactly symmetric.
Matrix boundedInverse(const Matrix& covariance, const Vector& deviation) {
  const Vector unit = deviation.unaryExpr([](double d) { return d > 0.0 ? 1.0 / d : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen =
      symmetricEigenOf(unit.asDiagonal() * covariance * unit.asDiagonal());
  const Vector inverse = eigen.eigenvalues().cwiseMax(kThinnest * kThinnest).cwiseInverse();
  const Matrix S = unit.asDiagonal() * eigen.eigenvectors() * inverse.asDiagonal() *
                   eigen.eigenvectors().transpose() * unit.asDiagonal();
  return 0.5 * (S + S.transpose());
}

}  // namespace

std::vector<Rule> multivariateRules(MatrixRef antecedents, const Clusters& clusters,
                                    const ColumnScaling& scaling, const PartitionParams& params,
                                    Index n_regressors) {
  const Index n = antecedents.cols();
  const Vector deviation = deviations(antecedents);
  const bool adaptive = params.method == PartitionMethod::kGustafsonKessel;
  std::vector<Rule> rules;
  for (Index i = 0; i < clusters.count(); ++i) {
    MultivariateMembership set;
    set.center =
        scaling.shift.head(n) + clusters.centers.col(i).head(n).cwiseProduct(scaling.scale.head(n));
    const Matrix F = covarianceOf(antecedents, clusters, i, set.center, scaling, adaptive);
    set.inverse_covariance = boundedInverse(F, deviation) / (params.width * params.width);
    Rule rule;
    rule.coefficients = Vector::Zero(n_regressors);
    rule.multivariate = set;
    rules.push_back(rule);
  }
  return rules;
}

}  // namespace fpc
