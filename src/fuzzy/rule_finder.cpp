#include "fuzzy/rule_finder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/fuzzy/partition.hpp"

namespace fpc {
namespace {

using Eigen::Index;

/// Rows first..first + count - 1.
Regression part(const Regression& rows, Index first, Index count) {
  Regression taken;
  taken.regressors = rows.regressors.middleRows(first, count);
  taken.antecedents = rows.antecedents.middleRows(first, count);
  taken.target = rows.target.segment(first, count);
  return taken;
}

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

  /// Tries every number of clusters on the first rows, judges on the held-out last ones.
  int chooseNumber(const Regression& rows, const ColumnScaling& scaling,
                   std::vector<ClusterTrial>& trials);

 private:
  ClusterTrial judge(const Regression& held_out, const Matrix& points, const Clusters& clusters,
                     const OutputModel& model) const;

  const OutputStructure& structure_;
  const Structure& settings_;
  const OutputModel& linear_;
  const IdentifyCallback& report_;
  bool cancelled_{false};
};

double oneStepRmse(const Regression& rows, const OutputModel& model) {
  FiringResult firing;
  Vector z(rows.antecedents.cols()), x(rows.regressors.cols());
  double sum = 0.0;
  for (Index k = 0; k < rows.rows(); ++k) {
    z = rows.antecedents.row(k).transpose();
    x = rows.regressors.row(k).transpose();
    firingWeights(model, z, firing);
    double predicted = 0.0;
    for (std::size_t i = 0; i < model.rules.size(); ++i)
      predicted += firing.weights[static_cast<Index>(i)] *
                   (model.rules[i].coefficients.dot(x) + model.rules[i].offset);
    sum += (rows.target[k] - predicted) * (rows.target[k] - predicted);
  }
  return std::sqrt(sum / static_cast<double>(rows.rows()));
}

ClusterTrial Finder::judge(const Regression& held_out, const Matrix& points,
                           const Clusters& clusters, const OutputModel& model) const {
  ClusterTrial trial;
  trial.clusters = static_cast<int>(clusters.count());
  trial.validity = clusterValidity(clusters, points);
  trial.one_step_rmse = oneStepRmse(held_out, model);
  return trial;
}

/// Adds to each trial's votes how many others are better by `value` (smaller is better).
template <typename Value>
void vote(std::vector<ClusterTrial>& trials, Value value) {
  for (auto& trial : trials)
    trial.votes += static_cast<double>(
        std::count_if(trials.begin(), trials.end(),
                      [&](const ClusterTrial& other) { return value(other) < value(trial); }));
}

int Finder::chooseNumber(const Regression& rows, const ColumnScaling& scaling,
                         std::vector<ClusterTrial>& trials) {
  const auto held =
      static_cast<Index>(settings_.partition.held_out * static_cast<double>(rows.rows()));
  require(held >= structure_.clusters_max, "partition.held_out",
          "more held-out rows than clusters");
  const Regression early = part(rows, 0, rows.rows() - held),
                   late = part(rows, rows.rows() - held, held);
  const Matrix early_points = scaling.apply(clusterSpace(early, settings_.partition)).transpose();
  const Matrix late_points = scaling.apply(clusterSpace(late, settings_.partition)).transpose();
  const double tries = structure_.clusters_max - structure_.clusters_min + 2.0;
  for (int number = structure_.clusters_min; number <= structure_.clusters_max && !cancelled_;
       ++number) {
    const double done = number - structure_.clusters_min;
    const Clusters clusters = cluster(early_points, number, done / tries, (done + 1.0) / tries);
    OutputModel model = modelOf(early, clusters, scaling);
    fitConsequents(early, linear_, settings_.consequents, model);
    trials.push_back(judge(late, late_points, clusters, model));
  }
  vote(trials, [](const ClusterTrial& t) { return t.validity.xie_beni; });
  vote(trials, [](const ClusterTrial& t) { return -t.validity.partition_density; });
  vote(trials, [](const ClusterTrial& t) { return t.one_step_rmse; });
  const auto best = std::min_element(
      trials.begin(), trials.end(), [](const auto& a, const auto& b) { return a.votes < b.votes; });
  return best->clusters;
}

}  // namespace

bool findRules(const Regression& rows, const OutputStructure& structure, const Structure& settings,
               const OutputModel& linear, const IdentifyCallback& report,
               OutputIdentification& found, OutputModel& model) {
  Finder finder(structure, settings, linear, report);
  model = finder.emptyModel();
  if (settings.partition.method == PartitionMethod::kGrid) {
    model.rules = gridRules(structure.sets, rows.regressors.cols());
  } else if (structure.antecedents.empty()) {
    model.rules = linear.rules;
  } else {
    const Matrix space = clusterSpace(rows, settings.partition);
    const ColumnScaling scaling = columnScaling(space, settings.partition.scaling);
    int number = structure.clusters_max;
    if (structure.clusters_min < structure.clusters_max)
      number = finder.chooseNumber(rows, scaling, found.trials);
    if (finder.cancelled()) return false;
    const Clusters clusters = finder.cluster(scaling.apply(space).transpose(), number, 0.0, 0.9);
    if (finder.cancelled()) return false;
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
