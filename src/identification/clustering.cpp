// Alternating optimisation of centres, shapes and memberships, one pass over the data each time.
#include "identification/clustering.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "base/decompositions.hpp"
#include "fmbpc/base/input_error.hpp"
#include "identification/cluster_pass.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kLargestCondition = 1e12;  // of a cluster's covariance

double uniform(std::mt19937_64& generator) {
  return static_cast<double>(generator() >> 11U) * 0x1.0p-53;
}

/// Eigenvalues from below, so that a flat cluster keeps an invertible covariance.
Matrix bounded(const Matrix& covariance) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen = symmetricEigenOf(covariance);
  Vector values = eigen.eigenvalues();
  const double floor =
      std::max(values.maxCoeff() / kLargestCondition, std::numeric_limits<double>::min());
  if (values.minCoeff() >= floor) return covariance;
  values = values.cwiseMax(floor);
  return eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
}

/// det(F)^(1/n)
double meanSpread(const Matrix& covariance) {
  const Vector values = symmetricEigenOf(covariance, Eigen::EigenvaluesOnly).eigenvalues();
  return std::exp(values.array().max(std::numeric_limits<double>::min()).log().mean());
}

/// Squared distances of one point into its memberships; a point in a centre belongs to it alone.
void toMemberships(Eigen::Ref<Vector> squared, double exponent) {
  const double nearest = squared.minCoeff();
  for (double& value : squared)
    value = value <= nearest ? 1.0 : (nearest > 0.0 ? std::pow(nearest / value, exponent) : 0.0);
  squared /= squared.sum();
}

/// F and what distances are measured by: R lower triangular with |R (z - v)|^2 = (z - v)' A (z -
/// v), A = det(F)^(1/n) F^-1.
struct Shape {
  Matrix covariance, root;
};

/// The inverse of F's triangular factor; not a number where F has none.
Matrix inverseFactor(const Matrix& covariance) {
  const Eigen::LLT<Matrix> factor(covariance);
  Matrix inverse = Matrix::Identity(covariance.rows(), covariance.cols());
  if (factor.info() == Eigen::Success)
    factor.matrixL().solveInPlace(inverse);
  else
    inverse.setConstant(std::numeric_limits<double>::quiet_NaN());
  return inverse;
}

/// No eigenvalue is below the floor of bounded(): the least is at least 1 / tr(F^-1), the largest
/// at most tr(F). False where that cannot be told without eigenvalues.
bool surelyBounded(const Matrix& covariance, const Matrix& inverse_factor) {
  const double least = 1.0 / inverse_factor.squaredNorm();
  return least >= covariance.trace() / kLargestCondition &&
         least >= std::numeric_limits<double>::min();
}

Shape shapeOf(const Matrix& covariance) {
  Shape shape{covariance, inverseFactor(covariance)};
  if (!surelyBounded(shape.covariance, shape.root)) {
    shape.covariance = bounded(covariance);
    shape.root = inverseFactor(shape.covariance);
  }
  shape.root *= std::exp(-shape.root.diagonal().array().log().mean());
  return shape;
}

/// Weighted sum of squared distances to a cluster of this shape: tr(A S), S the weighted scatter.
double distanceSum(const Matrix& root, const Matrix& scatter) {
  return root.lazyProduct(scatter).cwiseProduct(root).sum();
}

class Iteration {
 public:
  Iteration(MatrixRef points, const ClusteringParams& params)
      : points_(points),
        params_(params),
        pass_(points, params.clusters, params.fuzziness, params.threads) {
    const Vector mean = points.rowwise().mean();
    const Matrix spread = pass_.scatterAround(mean);
    spread_ = meanSpread(bounded(spread / static_cast<double>(points.cols())));
  }

  void start(std::mt19937_64& generator) {
    const Index n = points_.rows();
    clusters_ = {};
    clusters_.fuzziness = params_.fuzziness;
    const auto count = static_cast<std::size_t>(params_.clusters);
    clusters_.covariances.assign(count, Matrix::Identity(n, n));
    metric_.root = clusters_.covariances;
    spreadCenters(generator);
    moveMemberships();
  }

  /// Centres, shapes, memberships. @return the objective after it, for the present memberships.
  double step() {
    moveCenters();
    if (params_.adaptive) reshape();
    moveMemberships();
    return moments_->objective;
  }

  void copyMemberships() { pass_.copyMemberships(clusters_.memberships); }
  double change() const { return moments_->change; }
  Clusters& clusters() { return clusters_; }

 private:
  /// Far from each other: each new centre is drawn with the squared distance to the nearest one as
  /// its chance (arthur2007).
  void spreadCenters(std::mt19937_64& generator) {
    const Index samples = points_.cols();
    clusters_.centers.resize(points_.rows(), params_.clusters);
    pass_.restart();
    Index chosen = std::min(samples - 1,
                            static_cast<Index>(uniform(generator) * static_cast<double>(samples)));
    for (Index i = 0; i < params_.clusters; ++i) {
      clusters_.centers.col(i) = points_.col(chosen);
      chosen = pass_.sampleAt(uniform(generator) * pass_.approach(points_.col(chosen)));
    }
  }

  /// The weighted means: away from the old centres by `shift_`.
  void moveCenters() {
    shift_.setZero(points_.rows(), clusters_.count());
    for (Index i = 0; i < clusters_.count(); ++i) {
      if (!(moments_->weight[i] > 0.0)) continue;
      shift_.col(i) = moments_->offset.col(i) / moments_->weight[i];
      clusters_.centers.col(i) += shift_.col(i);
    }
  }

  void reshape() {
    for (std::size_t i = 0; i < clusters_.covariances.size(); ++i) {
      const auto column = static_cast<Index>(i);
      const double weight = moments_->weight[column];
      if (!(weight > 0.0)) continue;
      const Matrix scatter =
          moments_->scatter[i] - weight * shift_.col(column) * shift_.col(column).transpose();
      Matrix covariance = (1.0 - params_.regularisation) * scatter / weight;
      covariance.diagonal().array() += params_.regularisation * spread_;
      Shape shape = shapeOf(covariance);
      // A regularised shape is not the best one for the objective: it is taken only where it lowers
      // it. Along a line no distance knows the shape, and rounding must not decide.
      if (points_.rows() == 1 ||
          distanceSum(shape.root, scatter) <= distanceSum(metric_.root[i], scatter)) {
        clusters_.covariances[i].swap(shape.covariance);
        metric_.root[i].swap(shape.root);
      }
    }
  }

  void moveMemberships() {
    metric_.centers = clusters_.centers;
    moments_ = &pass_.run(metric_, params_.adaptive);
  }

  MatrixRef points_;
  ClusteringParams params_;
  clusters::Pass pass_;
  clusters::Metric metric_;
  const clusters::Moments* moments_{};
  double spread_{};
  Matrix shift_;
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
  require(threads >= 0, "threads", "a number >= 0 (0: all cores)");
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
    const bool cancelled = now.cancelled;
    if (best.objective.empty() || now.objective.back() < best.objective.back()) {
      iteration.copyMemberships();
      best = std::move(now);
    }
    best.cancelled = cancelled;
  }
  return best;
}

}  // namespace fpc
