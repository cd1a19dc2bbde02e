#include "identification/rule_finder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "identification/partition.hpp"

namespace fpc {
namespace {

using Eigen::Index;

ClusteringParams clusteringParams(const PartitionParams& p, int clusters) {
  ClusteringParams params;
  params.adaptive = p.method == PartitionMethod::kGustafsonKessel;
  params.clusters = clusters;
  params.fuzziness = p.fuzziness;
  params.regularisation = p.regularisation;
  params.max_iterations = p.max_iterations;
  params.tolerance = p.tolerance;
  params.restarts = p.restarts;
  params.seed = p.seed;
  return params;
}

/// Antecedents, and the output if it takes part (samples x dimensions).
Matrix clusterSpace(const Regression& rows, const PartitionParams& p) {
  const Index n_a = rows.antecedents.cols();
  Matrix space(rows.rows(), n_a + (p.with_output ? 1 : 0));
  space.leftCols(n_a) = rows.antecedents;
  if (p.with_output) space.col(n_a) = rows.target;
  return space;
}

class Finder {
 public:
  Finder(const OutputStructure& structure, const Structure& settings, const OutputModel& linear,
         const IdentifyCallback& report)
      : structure_(structure), settings_(settings), linear_(linear), report_(report) {}

  bool cancelled() const { return cancelled_; }

  /// Clusters of scaled rows; progress runs from `from` to `to`.
  Clusters cluster(const Matrix& points, int number, double from, double to) {
    const auto& p = settings_.partition;
    const double most = static_cast<double>(p.max_iterations) * p.restarts;
    Clusters clusters =
        findClusters(points, clusteringParams(p, number), [&](int iteration, double objective) {
          IdentifyProgress progress;
          progress.stage = "clusters " + std::to_string(number);
          progress.iteration = iteration;
          progress.objective = objective;
          progress.share = from + (to - from) * static_cast<double>(iteration) / most;
          return report_(progress);
        });
    cancelled_ = cancelled_ || clusters.cancelled;
    return clusters;
  }

  OutputModel emptyModel() const {
    OutputModel model;
    model.antecedents = structure_.antecedents;
    model.regressors = structure_.regressors;
    return model;
  }

  OutputModel modelOf(const Regression& rows, const Clusters& clusters,
                      const ColumnScaling& scaling) const {
    OutputModel model = emptyModel();
    const PartitionParams& p = settings_.partition;
    const Index n = rows.regressors.cols();
    model.rules = p.multivariate ? multivariateRules(rows.antecedents, clusters, scaling, p, n)
                                 : projectClusters(rows.antecedents, clusters, p, n);
    return model;
  }

 private:
  const OutputStructure& structure_;
  const Structure& settings_;
  const OutputModel& linear_;
  const IdentifyCallback& report_;
  bool cancelled_{false};
};

}  // namespace

ClusterValidity validityOn(const FoundClusters& found, const Regression& rows,
                           const PartitionParams& params) {
  return clusterValidity(found.clusters,
                         found.scaling.apply(clusterSpace(rows, params)).transpose());
}

bool findRules(const Regression& rows, const OutputStructure& structure, const Structure& settings,
               const OutputModel& linear, const IdentifyCallback& report,
               OutputIdentification& found, OutputModel& model, FoundClusters* clusters_found) {
  Finder finder(structure, settings, linear, report);
  model = finder.emptyModel();
  if (settings.partition.method == PartitionMethod::kGrid) {
    model.rules = gridRules(structure.sets, rows.regressors.cols());
  } else if (structure.antecedents.empty()) {
    model.rules = linear.rules;
  } else {
    const Matrix space = clusterSpace(rows, settings.partition);
    const ColumnScaling scaling = columnScaling(space, settings.partition.scaling);
    const Clusters clusters =
        finder.cluster(scaling.apply(space).transpose(), structure.clusters_max, 0.0, 0.9);
    if (finder.cancelled()) return false;
    if (clusters_found != nullptr) *clusters_found = {clusters, scaling};
    found.objective = clusters.objective;
    found.converged = clusters.converged;
    model = finder.modelOf(rows, clusters, scaling);
  }
  IdentifyProgress progress;
  progress.stage = "consequents";
  progress.share = 0.9;
  if (!report(progress)) return false;
  found.rules = fitConsequents(rows, linear, settings.consequents, model);
  progress.stage = "done";
  progress.share = 1.0;
  return report(progress);
}

}  // namespace fpc
