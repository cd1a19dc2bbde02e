#include "identification/clustering.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>

#include "fmbpc/base/input_error.hpp"
#include "identification/cluster_validity.hpp"

namespace fpc {
namespace fuzzy_clustering_test {

/// Normal clouds around (0, 0), (6, 0), (12, 0)...
Matrix clouds(int count, Eigen::Index each, std::uint64_t seed, double spread = 0.5) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal(0.0, spread);
  Matrix points(2, count * each);
  for (Eigen::Index k = 0; k < points.cols(); ++k)
    points.col(k) << 6.0 * static_cast<double>(k % count) + normal(generator), normal(generator);
  return points;
}

ClusteringParams paramsWith(bool adaptive, int clusters, double regularisation = 0.05) {
  ClusteringParams params;
  params.adaptive = adaptive;
  params.clusters = clusters;
  params.regularisation = regularisation;
  return params;
}

TEST(Clustering, TheObjectiveNeverRises) {
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    Matrix points(4, 400);
    for (double& value : flat(points)) value = normal(generator);
    points.row(3) = points.row(0) + 0.01 * points.row(3);  // nearly flat, as regression data are
    for (const double fuzziness : {1.3, 2.0, 3.0})
      for (const double regularisation : {-1.0, 0.0, 0.05, 0.5}) {
        ClusteringParams params =
            paramsWith(regularisation >= 0.0, 4, std::max(regularisation, 0.0));
        params.fuzziness = fuzziness;
        params.seed = seed;
        params.max_iterations = 60;
        const Clusters clusters = findClusters(points, params);
        for (std::size_t i = 1; i < clusters.objective.size(); ++i)
          ASSERT_LE(clusters.objective[i], clusters.objective[i - 1] * (1.0 + 1e-12))
              << "iteration " << i << " fuzziness " << fuzziness << " regularisation "
              << regularisation;
      }
  }
}

TEST(Clustering, CentersOfSeparateCloudsAreFound) {
  for (const bool adaptive : {false, true}) {
    ClusteringParams params = paramsWith(adaptive, 3);
    params.restarts = 5;
    const Clusters clusters = findClusters(clouds(3, 200, 8), params);
    EXPECT_TRUE(clusters.converged);
    for (const double at : {0.0, 6.0, 12.0}) {
      const double nearest = (clusters.centers.colwise() - (Vector(2) << at, 0.0).finished())
                                 .colwise()
                                 .norm()
                                 .minCoeff();
      EXPECT_LT(nearest, 0.2) << at;
    }
  }
}

TEST(Clustering, GustafsonKesselFollowsTheShapeOfACluster) {
  // Two crossing lines: round clusters cannot tell them apart, ellipsoids can.
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> along(-3.0, 3.0);
  Matrix points(2, 600);
  for (Eigen::Index k = 0; k < 600; ++k) {
    const double t = along(generator);
    points.col(k) << t + 0.05 * normal(generator), (k % 2 ? t : -t) + 0.05 * normal(generator);
  }
  ClusteringParams params = paramsWith(true, 2, 0.01);
  params.restarts = 5;
  const Clusters clusters = findClusters(points, params);
  int agree = 0;
  for (Eigen::Index k = 0; k < 600; ++k)
    agree += (clusters.memberships(0, k) > 0.5) == (k % 2 == 1) ? 1 : 0;
  EXPECT_GT(std::max(agree, 600 - agree), 540);
}

TEST(Clustering, MembershipsAreSharesOfOne) {
  const Clusters clusters = findClusters(clouds(2, 100, 3), paramsWith(true, 4));
  EXPECT_GE(clusters.memberships.minCoeff(), 0.0);
  EXPECT_LT((clusters.memberships.colwise().sum().array() - 1.0).abs().maxCoeff(), 1e-12);
  const Matrix far = Matrix::Constant(2, 3, 1e9);
  EXPECT_LT((clusters.membershipsOf(far).colwise().sum().array() - 1.0).abs().maxCoeff(), 1e-12);
}

TEST(Clustering, SameSeedSameBitsAndDataThatRepeatThemselvesAreFine) {
  Matrix points = clouds(2, 50, 4);
  points.rightCols(40).colwise() = points.col(0);
  for (const bool adaptive : {false, true}) {
    const Clusters a = findClusters(points, paramsWith(adaptive, 3)),
                   b = findClusters(points, paramsWith(adaptive, 3));
    EXPECT_EQ(a.centers, b.centers);
    EXPECT_EQ(a.memberships, b.memberships);
    EXPECT_TRUE(a.memberships.allFinite());
  }
}

/// Samples of three flat clouds in n dimensions; their number is no multiple of any block.
Matrix flatClouds(Eigen::Index n, Eigen::Index samples) {
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  Matrix points(n, samples);
  for (double& value : flat(points)) value = normal(generator);
  for (Eigen::Index k = 0; k < samples; ++k) {
    points(k % n, k) *= 0.01;
    points.col(k).array() += 3.0 * static_cast<double>(k % 3);
  }
  return points;
}

TEST(Clustering, TheAnswerDoesNotDependOnTheNumberOfThreads) {
  const Matrix points = flatClouds(5, 9001);
  ClusteringParams params;
  params.max_iterations = 5;
  for (const double fuzziness : {2.0, 1.5, 1.8}) {
    params.fuzziness = fuzziness;
    params.threads = 1;
    const Clusters one = findClusters(points, params);
    params.threads = 2;
    const Clusters two = findClusters(points, params);
    EXPECT_EQ(one.memberships, two.memberships);
    EXPECT_EQ(one.centers, two.centers);
    EXPECT_EQ(one.objective, two.objective);
  }
}

/// What one iteration must have made of the memberships before it, by the formulas.
TEST(Clustering, CentersShapesAndMembershipsAreThoseOfTheFormulas) {
  for (const Eigen::Index n : {1, 3, 4, 7}) {
    const Matrix points = flatClouds(n, 4500);
    ClusteringParams params;
    params.regularisation = 0.0;
    params.fuzziness = 1.7;
    params.tolerance = 1e-15;
    params.max_iterations = 3;
    const Clusters before = findClusters(points, params);
    params.max_iterations = 4;
    const Clusters after = findClusters(points, params);
    for (Eigen::Index i = 0; i < 3; ++i) {
      const Vector weight = before.memberships.row(i).array().pow(1.7).transpose();
      const Vector center = points * weight / weight.sum();
      EXPECT_LE((center - after.centers.col(i)).norm(), 1e-11);
      const Matrix away = points.colwise() - center;
      const Matrix covariance = away * weight.asDiagonal() * away.transpose() / weight.sum();
      const Matrix& shape = after.covariances[static_cast<std::size_t>(i)];
      EXPECT_LE((covariance - shape).norm(), 1e-10 * covariance.norm());
    }
    EXPECT_LE((after.membershipsOf(points) - after.memberships).cwiseAbs().maxCoeff(), 1e-11);
  }
}

TEST(Clustering, ShapesOfPointsOnALineKeepAnInverse) {
  Matrix points = flatClouds(3, 600);
  points.row(1) = 2.0 * points.row(0);
  points.row(2) = -points.row(0);
  ClusteringParams params = paramsWith(true, 2, 0.0);
  params.max_iterations = 20;
  const Clusters clusters = findClusters(points, params);
  EXPECT_TRUE(clusters.memberships.allFinite());
  for (const Matrix& shape : clusters.covariances) {
    const Vector values = shape.selfadjointView<Eigen::Lower>().eigenvalues();
    EXPECT_NEAR(values.maxCoeff() / values.minCoeff(), 1e12, 1e10);
  }
}

TEST(Clustering, IdenticalPointsDoNotBreakIt) {
  const Clusters clusters = findClusters(Matrix::Ones(3, 30), paramsWith(true, 2));
  EXPECT_TRUE(clusters.memberships.allFinite());
  EXPECT_LT((clusters.memberships.colwise().sum().array() - 1.0).abs().maxCoeff(), 1e-12);
}

TEST(Clustering, ProgressIsShownAndCanCancel) {
  int calls = 0;
  const Clusters clusters =
      findClusters(clouds(3, 100, 2), paramsWith(true, 3), [&](int iteration, double objective) {
        EXPECT_EQ(iteration, ++calls);
        EXPECT_GT(objective, 0.0);
        return calls < 2;
      });
  EXPECT_EQ(calls, 2);
  EXPECT_TRUE(clusters.cancelled);
}

TEST(Clustering, BadArgumentsAreNamed) {
  EXPECT_THROW(findClusters(Matrix::Random(2, 3), paramsWith(true, 4)), InputError);
  EXPECT_THROW(findClusters(Matrix::Constant(2, 9, NAN), paramsWith(true, 2)), InputError);
  EXPECT_THROW(paramsWith(true, 0).validate(), InputError);
  EXPECT_THROW(paramsWith(true, 2, 1.0).validate(), InputError);
}

TEST(ClusterValidity, BothIndicesPreferTheTrueNumberOfCloudsOnHeldOutPoints) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Matrix points = clouds(4, 150, seed), held_out = clouds(4, 60, seed + 100);
    int best_xie_beni = 0, best_density = 0;
    double lowest = 1e300, highest = 0.0;
    for (int number = 2; number <= 7; ++number) {
      ClusteringParams params = paramsWith(false, number);
      params.restarts = 6;
      const ClusterValidity validity = clusterValidity(findClusters(points, params), held_out);
      if (validity.xie_beni < lowest) lowest = validity.xie_beni, best_xie_beni = number;
      if (validity.partition_density > highest)
        highest = validity.partition_density, best_density = number;
    }
    EXPECT_EQ(best_xie_beni, 4);
    EXPECT_EQ(best_density, 4);
  }
}

}  // namespace fuzzy_clustering_test
}  // namespace fpc
