// From clusters to rules: fuzzy sets on single variables, as models and their readers want them.
#pragma once

#include <vector>

#include "identification/clustering.hpp"
#include "identification/structure.hpp"

namespace fpc {

/// Columns shifted and divided: scaled = (value - shift) / scale.
struct ColumnScaling {
  Vector shift, scale;
  Matrix apply(MatrixRef values) const;  ///< rows are samples
};
/// @throws nothing: a constant column gets scale 1.
ColumnScaling columnScaling(MatrixRef values, Scaling scaling);

/// The fuzzy set that a cluster casts on one variable. `values` are the variable at the samples,
/// `memberships` the cluster's. Gaussian: mean and deviation weighted by u^m. Exponential: the
/// shoulders span what belongs to the cluster almost fully, the flanks are fitted to the upper
/// envelope of the memberships. `width` stretches both.
Membership projectCluster(const Eigen::Ref<const Vector>& values,
                          const Eigen::Ref<const Vector>& memberships, MembershipShape shape,
                          double fuzziness, double width);

/// One rule per cluster, consequents still zero. antecedents: samples x variables, in their own
/// units.
std::vector<Rule> projectClusters(MatrixRef antecedents, const Clusters& clusters,
                                  const PartitionParams& params, Eigen::Index n_regressors);

/// One rule per cluster, its membership the cluster's ellipsoid over the antecedents in their own
/// units: S = (width^2 F)^-1, F the antecedents' block of the cluster's covariance (c-means: of the
/// scatter weighted by u^m). `scaling` is that of the cluster space, whose first variables are the
/// antecedents (samples x variables). A variable that does not move gets no weight.
std::vector<Rule> multivariateRules(MatrixRef antecedents, const Clusters& clusters,
                                    const ColumnScaling& scaling, const PartitionParams& params,
                                    Eigen::Index n_regressors);

/// One rule per combination of the sets, the last variable's sets changing fastest.
std::vector<Rule> gridRules(const std::vector<std::vector<Membership>>& sets,
                            Eigen::Index n_regressors);

}  // namespace fpc
