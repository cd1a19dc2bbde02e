#include "identification/cluster_validity.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace fpc {
namespace {

using Eigen::Index;

double closestCenters(const Matrix& centers) {
  double closest = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < centers.cols(); ++i)
    for (Index j = 0; j < i; ++j)
      closest = std::min(closest, (centers.col(i) - centers.col(j)).squaredNorm());
  return closest;
}

/// Memberships of the points within one deviation of the cluster, over its volume sqrt(det F).
double density(MatrixRef points, const Vector& center,
               const Eigen::Ref<const Eigen::RowVectorXd>& membership) {
  const Index n = points.rows();
  const Matrix away = points.colwise() - center;
  const double weight = membership.sum();
  Matrix covariance =
      (away * membership.asDiagonal()) * away.transpose() / std::max(weight, 1e-300);
  covariance.diagonal().array() +=
      1e-9 * std::max(covariance.trace() / static_cast<double>(n), 1e-300);
  const Eigen::LLT<Matrix> root(covariance);
  const double log_volume = Vector(Matrix(root.matrixL()).diagonal()).array().log().sum();
  const Eigen::RowVectorXd squared = root.matrixL().solve(away).colwise().squaredNorm();
  const double inside = (squared.array() < static_cast<double>(n)).select(membership, 0.0).sum();
  return inside / std::exp(log_volume);
}

}  // namespace

ClusterValidity clusterValidity(const Clusters& clusters, MatrixRef points) {
  const Matrix u = clusters.membershipsOf(points);
  const auto samples = static_cast<double>(points.cols());
  ClusterValidity validity;
  double within = 0.0;
  for (Index i = 0; i < clusters.count(); ++i) {
    const auto away = (points.colwise() - clusters.centers.col(i)).colwise().squaredNorm();
    within += (u.row(i).array().pow(clusters.fuzziness) * away.array()).sum();
    validity.partition_density += density(points, clusters.centers.col(i), u.row(i));
  }
  validity.xie_beni = clusters.count() > 1 ? within / (samples * closestCenters(clusters.centers))
                                           : std::numeric_limits<double>::infinity();
  validity.partition_density /= static_cast<double>(clusters.count());
  validity.partition_coefficient = u.squaredNorm() / samples;
  return validity;
}

}  // namespace fpc
