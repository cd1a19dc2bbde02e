// How well a number of clusters suits data: indices that a user may compare.
#pragma once

#include "identification/clustering.hpp"

namespace fpc {

/// Indices of clusters on points, which may be others than those they were found in.
struct ClusterValidity {
  double xie_beni{};  ///< mean weighted squared distance / closest centres' squared distance; small
                      ///< is good
  double partition_density{};      ///< mean of (memberships inside one deviation) / cluster volume;
                                   ///< large is good
  double partition_coefficient{};  ///< mean u^2, 1/c..1; large is crisp
};

/// Source: xie1991; gath1989, eqs. 17-19; bezdek1981.
ClusterValidity clusterValidity(const Clusters& clusters, MatrixRef points);

}  // namespace fpc
