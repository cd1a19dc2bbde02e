// Alternating optimisation of centres, shapes and memberships, in blocks of samples.
#include "fmbpc/fuzzy/clustering.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr Index kBlock = 1024;
constexpr double kLargestCondition = 1e12;  // of a cluster's covariance

double uniform(std::mt19937_64& generator) {
  return static_cast<double>(generator() >> 11U) * 0x1.0p-53;
}

/// Eigenvalues from below, so that a flat cluster keeps an invertible covariance.
Matrix bounded(const Matrix& covariance) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(covariance);
  Vector values = eigen.eigenvalues();
  const double floor =
      std::max(values.maxCoeff() / kLargestCondition, std::numeric_limits<double>::min());
  if (values.minCoeff() >= floor) return covariance;
  values = values.cwiseMax(floor);
  return eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
}

/// det(F)^(1/n)
double meanSpread(const Matrix& covariance) {
  const Vector values =
      Eigen::SelfAdjointEigenSolver<Matrix>(covariance, Eigen::EigenvaluesOnly).eigenvalues();
  return std::exp(values.array().max(std::numeric_limits<double>::min()).log().mean());
}

/// Weighted sum of squared distances to a cluster of this shape: tr(A S), S the weighted scatter.
double distanceSum(const Matrix& covariance, const Matrix& scatter) {
  return meanSpread(covariance) * covariance.llt().solve(scatter).trace();
}

/// Squared distances of one point into its memberships; a point in a centre belongs to it alone.
void toMemberships(Eigen::Ref<Vector> squared, double exponent) {
  const double nearest = squared.minCoeff();
  for (double& value : squared)
    value = value <= nearest ? 1.0 : (nearest > 0.0 ? std::pow(nearest / value, exponent) : 0.0);
  squared /= squared.sum();
}

class Iteration {
 public:
  Iteration(MatrixRef points, const ClusteringParams& params) : points_(points), params_(params) {
    const Vector mean = points.rowwise().mean();
    Matrix spread = Matrix::Zero(points.rows(), points.rows());
    for (Index k = 0; k < points.cols(); ++k) {
      const Vector away = points.col(k) - mean;
      spread.noalias() += away * away.transpose();
    }
    spread_ = meanSpread(bounded(spread / static_cast<double>(points.cols())));
  }

  void start(std::mt19937_64& generator) {
    const Index n = points_.rows();
    clusters_ = {};
    clusters_.fuzziness = params_.fuzziness;
    clusters_.covariances.assign(static_cast<std::size_t>(params_.clusters),
                                 Matrix::Identity(n, n));
    spreadCenters(generator);
    moveMemberships();
  }

  /// Centres, shapes, memberships. @return the objective after it, for the present memberships.
  double step() {
    moveCenters();
    if (params_.adaptive) reshape();
    return moveMemberships();
  }

  double change() const { return change_; }
  Clusters& clusters() { return clusters_; }

 private:
  /// Far from each other: each new centre is drawn with the squared distance to the nearest one as
  /// its chance (Arthur and Vassilvitskii 2007).
  void spreadCenters(std::mt19937_64& generator) {
    const Index samples = points_.cols();
    clusters_.centers.resize(points_.rows(), params_.clusters);
    Vector nearest = Vector::Constant(samples, std::numeric_limits<double>::infinity());
    Index chosen = std::min(samples - 1,
                            static_cast<Index>(uniform(generator) * static_cast<double>(samples)));
    for (Index i = 0; i < params_.clusters; ++i) {
      clusters_.centers.col(i) = points_.col(chosen);
      nearest = nearest.cwiseMin(
          (points_.colwise() - points_.col(chosen)).colwise().squaredNorm().transpose());
      double left = uniform(generator) * nearest.sum();
      for (chosen = 0; chosen + 1 < samples && (left -= nearest[chosen]) > 0.0;) ++chosen;
    }
  }

  void moveCenters() {
    const Index c = clusters_.count();
    Matrix sums = Matrix::Zero(points_.rows(), c);
    weight_ = Vector::Zero(c);
    for (Index from = 0; from < points_.cols(); from += kBlock) {
      const Index n = std::min(kBlock, points_.cols() - from);
      const Matrix weights = weightsOf(from, n);
      sums.noalias() += points_.middleCols(from, n) * weights.transpose();
      weight_ += weights.rowwise().sum();
    }
    for (Index i = 0; i < c; ++i)
      if (weight_[i] > 0.0) clusters_.centers.col(i) = sums.col(i) / weight_[i];
  }

  void reshape() {
    const Index n = points_.rows();
    std::vector<Matrix> scatter(clusters_.covariances.size(), Matrix::Zero(n, n));
    for (Index from = 0; from < points_.cols(); from += kBlock) {
      const Index size = std::min(kBlock, points_.cols() - from);
      const Matrix weights = weightsOf(from, size);
      for (std::size_t i = 0; i < scatter.size(); ++i) {
        const auto row = static_cast<Index>(i);
        const Matrix away = points_.middleCols(from, size).colwise() - clusters_.centers.col(row);
        scatter[i].noalias() += (away * weights.row(row).asDiagonal()) * away.transpose();
      }
    }
    for (std::size_t i = 0; i < scatter.size(); ++i) {
      const double weight = weight_[static_cast<Index>(i)];
      if (!(weight > 0.0)) continue;
      Matrix covariance = (1.0 - params_.regularisation) * scatter[i] / weight;
      covariance.diagonal().array() += params_.regularisation * spread_;
      covariance = bounded(covariance);
      // A regularised shape is not the best one for the objective: it is taken only where it lowers
      // it.
      if (distanceSum(covariance, scatter[i]) <= distanceSum(clusters_.covariances[i], scatter[i]))
        clusters_.covariances[i] = covariance;
    }
  }

  double moveMemberships() {
    const double exponent = 1.0 / (params_.fuzziness - 1.0);
    if (clusters_.memberships.size() == 0)
      clusters_.memberships = Matrix::Zero(clusters_.count(), points_.cols());
    double objective = 0.0;
    change_ = 0.0;
    for (Index from = 0; from < points_.cols(); from += kBlock) {
      const Index n = std::min(kBlock, points_.cols() - from);
      const Matrix squared = clusters_.distances(points_.middleCols(from, n));
      Matrix fresh = squared;
      for (Index k = 0; k < n; ++k) toMemberships(fresh.col(k), exponent);
      auto present = clusters_.memberships.middleCols(from, n);
      change_ = std::max(change_, (fresh - present).cwiseAbs().maxCoeff());
      present = fresh;
      objective += weightsOf(from, n).cwiseProduct(squared).sum();
    }
    return objective;
  }

  /// u^m
  Matrix weightsOf(Index from, Index n) const {
    const auto u = clusters_.memberships.middleCols(from, n).array();
    return params_.fuzziness == 2.0 ? Matrix(u.square()) : Matrix(u.pow(params_.fuzziness));
  }

  MatrixRef points_;
  ClusteringParams params_;
  double spread_{}, change_{};
  Vector weight_;
  Clusters clusters_;
};

}  // namespace

void ClusteringParams::validate() const {
  require(clusters >= 1, "clusters", "a number >= 1");
  require(fuzziness > 1.0 && std::isfinite(fuzziness), "fuzziness", "a number > 1");
  require(regularisation >= 0.0 && regularisation < 1.0, "regularisation", "a number in [0, 1)");
  require(max_iterations >= 1, "max_iterations", "a number >= 1");
  require(tolerance > 0.0, "tolerance", "a number > 0");
  require(restarts >= 1, "restarts", "a number >= 1");
}

Matrix Clusters::distances(MatrixRef points) const {
  Matrix squared(count(), points.cols());
  for (Index i = 0; i < count(); ++i) {
    const Matrix away = points.colwise() - centers.col(i);
    const Eigen::LLT<Matrix> root(covariances[static_cast<std::size_t>(i)]);
    const double volume = 2.0 * Vector(Matrix(root.matrixL()).diagonal()).array().log().mean();
    squared.row(i) = std::exp(volume) * root.matrixL().solve(away).colwise().squaredNorm();
  }
  return squared;
}

Matrix Clusters::membershipsOf(MatrixRef points) const {
  Matrix values = distances(points);
  for (Index k = 0; k < values.cols(); ++k) toMemberships(values.col(k), 1.0 / (fuzziness - 1.0));
  return values;
}

Clusters findClusters(MatrixRef points, const ClusteringParams& params,
                      const ClusteringProgress& progress) {
  params.validate();
  require(points.cols() >= params.clusters, "clusters", "at least as many samples as clusters");
  require(points.allFinite(), "points", "finite values");
  std::mt19937_64 generator(params.seed);
  Iteration iteration(points, params);
  Clusters best;
  int iterations = 0;
  for (int restart = 0; restart < params.restarts && !best.cancelled; ++restart) {
    iteration.start(generator);
    Clusters& now = iteration.clusters();
    for (int i = 0; i < params.max_iterations && !now.converged && !now.cancelled; ++i) {
      now.objective.push_back(iteration.step());
      now.converged = iteration.change() <= params.tolerance;
      now.cancelled = progress && !progress(++iterations, now.objective.back());
    }
    if (best.objective.empty() || now.objective.back() < best.objective.back()) best = now;
    best.cancelled = now.cancelled;
  }
  return best;
}

}  // namespace fpc
