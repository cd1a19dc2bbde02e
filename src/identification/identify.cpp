// Regression rows, partition and consequents of every output, in this order.
#include "identification/identify.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "identification/contradiction.hpp"
#include "identification/rule_finder.hpp"

namespace fpc {
namespace {

using Eigen::Index;

/// Variables of columns that never move say nothing.
std::vector<Regressor> moving(const std::vector<Regressor>& variables, const DataSet& data) {
  std::vector<Regressor> kept;
  for (const auto& v : variables)
    if (data.constant.empty() ||
        !data.constant[static_cast<std::size_t>(data.column(v.kind, v.index))])
      kept.push_back(v);
  return kept;
}

void checkEnough(const Regression& rows, const std::string& where, Index n_regressors,
                 int clusters) {
  const Index needed = std::max<Index>(2 * (n_regressors + 1), 5 * Index{clusters});
  require(rows.rows() >= needed, where,
          "at least " + std::to_string(needed) + " complete rows for " +
              std::to_string(n_regressors) + " regressors and " + std::to_string(clusters) +
              " clusters, got " + std::to_string(rows.rows()));
}

std::string provenance(const DataSet& data, const Structure& s) {
  static const std::vector<std::string> methods{"Gustafson-Kessel", "fuzzy c-means", "grid"};
  static const std::vector<std::string> fits{"local", "global", "recursive"};
  std::string text = "Identified from " + data.source + ", structure " + s.name + ": " +
                     methods.at(static_cast<std::size_t>(s.partition.method)) + ", " +
                     fits.at(static_cast<std::size_t>(s.consequents.method)) +
                     " least squares, ridge " + exactText(s.consequents.ridge);
  const auto add = [&text](const std::string& words, double value) {
    text += ", " + words + " " + exactText(value);
  };
  if (s.partition.method != PartitionMethod::kGrid) {
    text += ", " + (s.partition.multivariate ? "multivariate" : fpc::name(s.partition.membership)) +
            " sets";
    add("fuzziness", s.partition.fuzziness);
    add("regularisation", s.partition.regularisation);
    add("width", s.partition.width);
  }
  if (s.consequents.method == ConsequentMethod::kRecursive)
    add("forgetting", s.consequents.forgetting);
  if (s.consequents.free_run_iterations > 0) {
    add("free-run iterations", s.consequents.free_run_iterations);
    add("one-step weight", s.consequents.one_step_weight);
  }
  text += ", seed " + std::to_string(s.partition.seed) + ".";
  for (const auto& repair : data.repairs) text += " " + repair + ".";
  return text;
}

void addRemarks(const OutputIdentification& found, std::vector<std::string>& remarks) {
  if (!found.converged)
    remarks.push_back(found.output +
                      ": the clustering stopped at partition.max_iterations before it settled");
  for (std::size_t i = 0; i < found.rules.size(); ++i) {
    const RuleFit& fit = found.rules[i];
    if (fit.status == RuleStatus::kFitted) continue;
    remarks.push_back(found.output + " rule " + std::to_string(i + 1) + ": " + fit.remark +
                      (fit.status == RuleStatus::kDropped ? "; dropped"
                       : fit.lender < 0
                           ? "; the linear model stands in"
                           : "; rule " + std::to_string(fit.lender + 1) + " stands in"));
  }
}

IdentifyProgress freeRunProgress() {
  IdentifyProgress progress;
  progress.stage = "free run";
  progress.share = 0.95;
  return progress;
}

/// The model of output i; false when cancelled.
bool identifyOutput(const DataSet& data, const Structure& structure, std::size_t i,
                    const IdentifyCallback& callback, const PriorKnowledge& known,
                    Identification& result) {
  OutputStructure s = structure.submodels[i];
  s.regressors = moving(s.regressors, data);
  if (structure.partition.method != PartitionMethod::kGrid)
    s.antecedents = moving(s.antecedents, data);
  const std::string& name = data.outputs[i].name;
  require(!s.regressors.empty(), "submodels." + name, "a regressor that moves in the data");
  require(!s.antecedents.empty() || s.clusters_max == 1, "submodels." + name,
          "an antecedent that moves in the data");
  const Regression rows = makeRegression(data, s.regressors, s.antecedents, static_cast<int>(i));
  checkEnough(rows, data.source + ": output '" + name + "'",
              static_cast<Index>(s.regressors.size()), s.clusters_max);
  OutputIdentification found;
  found.output = name;
  found.samples = rows.rows();
  result.linear.submodels.push_back(fitLinear(rows, s.regressors, found.linear));
  const auto report = [&](IdentifyProgress progress) {
    progress.output = name;
    progress.samples = rows.rows();
    progress.share =
        (static_cast<double>(i) + progress.share) / static_cast<double>(structure.submodels.size());
    return !callback || callback(progress);
  };
  OutputModel submodel;
  if (s.clusters_min < s.clusters_max && !s.antecedents.empty() &&
      structure.partition.method != PartitionMethod::kGrid) {
    s.clusters_max =
        chooseClusterNumber(data, static_cast<int>(i), s, structure, report, found.trials);
    s.clusters_min = s.clusters_max;
    if (s.clusters_max == 0) return false;
  }
  bool completed =
      findRules(rows, s, structure, result.linear.submodels.back(), report, found, submodel);
  if (!known.empty()) {
    const std::string words = contradiction(data, static_cast<int>(i), s.regressors, known);
    if (!words.empty()) result.remarks.insert(result.remarks.begin(), name + ": " + words);
  }
  imposeKnowledge(data, static_cast<int>(i), known, result.linear.submodels.back());
  if (completed) imposeKnowledge(data, static_cast<int>(i), known, submodel);
  if (completed && structure.consequents.free_run_iterations > 0) {
    found.free_run = fitFreeRun(
        data, static_cast<int>(i), result.linear.submodels.back(), structure.consequents, submodel,
        [&] { return report(freeRunProgress()); }, known);
    completed = !found.free_run.cancelled;
  }
  result.model.submodels.push_back(submodel);
  addRemarks(found, result.remarks);
  result.outputs.push_back(std::move(found));
  return completed;
}

}  // namespace

Identification identify(const DataSet& data, const Structure& structure,
                        const IdentifyCallback& callback,
                        const std::vector<PriorKnowledge>& known) {
  structure.validate();
  require(known.empty() || known.size() == structure.submodels.size(), "known",
          "one for each output");
  Identification result;
  result.remarks = data.repairs;
  result.model.name = structure.name;
  result.model.source = provenance(data, structure);
  result.model.sample_time_s = data.sample_time_s;
  result.model.outputs = data.outputs;
  result.model.inputs = data.inputs;
  result.model.disturbances = data.disturbances;
  result.linear = result.model;
  result.linear.name += "_linear";
  for (std::size_t i = 0; i < structure.submodels.size() && !result.cancelled; ++i)
    result.cancelled = !identifyOutput(data, structure, i, callback,
                                       known.empty() ? PriorKnowledge{} : known[i], result);
  if (result.cancelled) return result;
  result.model.domain = result.linear.domain = makeDomain(data.values);
  result.model.validate();
  result.linear.validate();
  return result;
}

}  // namespace fpc
