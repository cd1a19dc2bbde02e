// Fuzzy clusters in data: c-means (round) and Gustafson-Kessel (ellipsoids of their own shape).
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

struct ClusteringParams {
  bool adaptive{true};  ///< true: Gustafson-Kessel, false: c-means
  int clusters{3};
  double fuzziness{2.0};        ///< m > 1
  double regularisation{0.05};  ///< gamma in [0, 1), Gustafson-Kessel only
  int max_iterations{200};
  double tolerance{1e-4};  ///< stops when no membership moves by more
  int restarts{1};
  std::uint64_t seed{1};
  int threads{0};         ///< 0: all cores; the answer does not depend on it
  void validate() const;  ///< @throws InputError naming the field
};

struct Clusters {
  Matrix centers;                   ///< dimensions x c
  std::vector<Matrix> covariances;  ///< of each cluster, fuzzy, regularised; identity for c-means
  double fuzziness{2.0};
  Matrix memberships;             ///< c x samples, columns sum to 1
  std::vector<double> objective;  ///< after each iteration; never rises
  bool converged{false};
  bool cancelled{false};

  Eigen::Index count() const { return centers.cols(); }
  /// Squared distances (c x samples) of points (dimensions x samples): (z - v)' A (z - v), A =
  /// det(F)^(1/n) F^-1.
  Matrix distances(MatrixRef points) const;
  /// Memberships of any points in these clusters (c x samples).
  Matrix membershipsOf(MatrixRef points) const;
};

/// Iteration of all restarts so far and the objective; false cancels.
using ClusteringProgress = std::function<bool(int iteration, double objective)>;

/// Clusters columns of `points` (dimensions x samples); scale the dimensions first. Same data and
/// seed, same bits. Memory: the points, two matrices
/// c x samples, and blocks. When cancelled, what
/// there is so far. Source: bezdek1981; gustafson1979; regularised as in
/// babuska2002.
/// @throws InputError naming the field; also when there are fewer points than clusters.
Clusters findClusters(MatrixRef points, const ClusteringParams& params,
                      const ClusteringProgress& progress = {});

}  // namespace fpc
