// How many clusters: by free runs over blocks that a fit did not see.
#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "identification/auto_identify.hpp"
#include "identification/rule_finder.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr Index kMostRows = 8000;  // of longer records windows are looked at
constexpr int kMostFreeRunSteps = 20;

/// A block, and what a model for it is fitted to.
struct Fold {
  Regression training, held;
  DataSet rest, block;
  OutputModel linear;
};

Fold foldOf(const DataSet& data, int output, const OutputStructure& structure, Index first,
            Index count) {
  Fold fold;
  fold.rest = data;
  fold.rest.values.middleRows(first, count).setConstant(std::numeric_limits<double>::quiet_NaN());
  fold.block = data;
  fold.block.values = data.values.middleRows(first, count);
  fold.training = makeRegression(fold.rest, structure.regressors, structure.antecedents, output);
  fold.held = makeRegression(fold.block, structure.regressors, structure.antecedents, output);
  RuleFit ignored;
  if (fold.training.rows() > 0)
    fold.linear = fitLinear(fold.training, structure.regressors, ignored);
  return fold;
}

double squaredOneStep(const Regression& rows, const OutputModel& model) {
  FiringResult firing;
  Vector z(rows.antecedents.cols()), x(rows.regressors.cols());
  double sum = 0.0;
  for (Index k = 0; k < rows.rows(); ++k) {
    z = rows.antecedents.row(k).transpose();
    x = rows.regressors.row(k).transpose();
    firingWeights(model, z, firing);
    double error = rows.target[k];
    for (std::size_t i = 0; i < model.rules.size(); ++i)
      error -= firing.weights[static_cast<Index>(i)] *
               (model.rules[i].coefficients.dot(x) + model.rules[i].offset);
    sum += error * error;
  }
  return sum;
}

/// rms of a free run of this output alone.
double freeRunError(const DataSet& block, int output, const OutputModel& linear,
                    OutputModel model) {
  ConsequentParams none;
  none.free_run_iterations = 0;
  return fitFreeRun(block, output, linear, none, model).before;
}

class NumberSearch {
 public:
  NumberSearch(const DataSet& data, int output, const OutputStructure& structure,
               const Structure& settings, const IdentifyCallback& report)
      : output_(output), structure_(structure), settings_(settings), report_(report) {
    const auto blocks =
        static_cast<Index>(std::clamp(std::round(1.0 / settings.partition.held_out), 2.0, 10.0));
    for (Index b = 0; b < blocks; ++b) {
      const Index first = data.rows() * b / blocks, next = data.rows() * (b + 1) / blocks;
      Fold fold = foldOf(data, output, structure, first, next - first);
      if (fold.held.rows() > structure.clusters_max && fold.training.rows() > 0)
        folds_.push_back(std::move(fold));
    }
    require(folds_.size() >= 2, "partition.held_out", "more held-out rows than clusters");
  }

  /// false: cancelled.
  bool judge(int number, double from, double to, ClusterTrial& trial) {
    OutputStructure fixed = structure_;
    fixed.clusters_min = fixed.clusters_max = number;
    double free = 0.0, one = 0.0, rows = 0.0;
    std::vector<double> errors;
    Index parameters = 0;
    for (std::size_t b = 0; b < folds_.size(); ++b) {
      const double part = (to - from) / static_cast<double>(folds_.size());
      OutputModel model;
      FoundClusters clusters;
      if (!fit(folds_[b], fixed, from + part * static_cast<double>(b), part, model, clusters))
        return false;
      const Fold& f = folds_[b];
      errors.push_back(freeRunError(f.block, output_, f.linear, model));
      const auto n = static_cast<double>(f.held.rows());
      free += n * errors.back() * errors.back();
      one += squaredOneStep(f.held, model);
      rows += n;
      parameters = static_cast<Index>(model.rules.size()) *
                   static_cast<Index>(model.regressors.size() + 1 + 2 * model.antecedents.size());
      if (b + 1 == folds_.size())
        trial.validity = validityOn(clusters, f.held, settings_.partition);
    }
    trial.clusters = number;
    trial.one_step_rmse = std::sqrt(one / rows);
    trial.free_run_rmse = std::sqrt(free / rows);
    trial.spread = deviationOf(errors);
    const double share = std::min(0.9, static_cast<double>(parameters) / rows);
    trial.score = trial.free_run_rmse * std::sqrt((1.0 + share) / (1.0 - share));
    return true;
  }

 private:
  static double deviationOf(const std::vector<double>& values) {
    const auto n = static_cast<double>(values.size());
    double mean = 0.0, square = 0.0;
    for (const double v : values) mean += v / n;
    for (const double v : values) square += (v - mean) * (v - mean) / n;
    return std::sqrt(square);
  }

  bool fit(const Fold& fold, const OutputStructure& fixed, double from, double part,
           OutputModel& model, FoundClusters& clusters) const {
    OutputIdentification ignored;
    const auto report = [&](IdentifyProgress progress) {
      progress.share = from + part * progress.share;
      return report_(progress);
    };
    if (!findRules(fold.training, fixed, settings_, fold.linear, report, ignored, model, &clusters))
      return false;
    if (settings_.consequents.free_run_iterations == 0) return true;
    return fitFreely(fold, model);
  }

  bool fitFreely(const Fold& fold, OutputModel& model) const {
    ConsequentParams params = settings_.consequents;
    params.free_run_iterations = std::min(params.free_run_iterations, kMostFreeRunSteps);
    IdentifyProgress progress;
    progress.stage = "free run";
    return !fitFreeRun(fold.rest, output_, fold.linear, params, model, [&] {
              return report_(progress);
            }).cancelled;
  }

  int output_;
  const OutputStructure& structure_;
  const Structure& settings_;
  const IdentifyCallback& report_;
  std::vector<Fold> folds_;
};

}  // namespace

int chooseClusterNumber(const DataSet& full, int output, const OutputStructure& structure,
                        const Structure& settings, const IdentifyCallback& report,
                        std::vector<ClusterTrial>& trials) {
  const DataSet data = full.rows() > kMostRows ? subsample(full, kMostRows, 8) : full;
  NumberSearch search(data, output, structure, settings, report);
  const double tries = structure.clusters_max - structure.clusters_min + 2.0;
  for (int n = structure.clusters_min; n <= structure.clusters_max; ++n) {
    const double done = n - structure.clusters_min;
    ClusterTrial trial;
    if (!search.judge(n, done / tries, (done + 1.0) / tries, trial)) return 0;
    trials.push_back(trial);
  }
  return std::min_element(trials.begin(), trials.end(),
                          [](const auto& a, const auto& b) { return a.score < b.score; })
      ->clusters;
}

}  // namespace fpc
