// Checks of an identification structure, and regressors from orders and transport delays.
#include "identification/structure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr int kMostClusters = 200;
constexpr std::size_t kMostGridRules = 5000;

void checkPartition(const PartitionParams& p) {
  require(p.fuzziness > 1.0 && p.fuzziness <= 10.0, "partition.fuzziness", "a number in (1, 10]");
  require(p.regularisation >= 0.0 && p.regularisation < 1.0, "partition.regularisation",
          "a number in [0, 1)");
  require(p.width > 0.0 && std::isfinite(p.width), "partition.width", "a number > 0");
  require(p.max_iterations > 0, "partition.max_iterations", "a number > 0");
  require(p.tolerance > 0.0, "partition.tolerance", "a number > 0");
  require(p.restarts > 0, "partition.restarts", "a number > 0");
  require(p.held_out > 0.0 && p.held_out < 0.9, "partition.held_out", "a share in (0, 0.9)");
  require(p.method == PartitionMethod::kGrid || p.membership == MembershipShape::kGaussian ||
              p.membership == MembershipShape::kExponential,
          "partition.membership", "gaussian, exponential or multivariate");
  require(p.method != PartitionMethod::kGrid || !p.multivariate, "partition.membership",
          "gaussian or exponential with a grid: multivariate needs clusters");
}

void checkConsequents(const ConsequentParams& c) {
  require(c.ridge >= 0.0 && std::isfinite(c.ridge), "consequents.ridge", "a number >= 0");
  require(c.samples_per_coefficient >= 0.0, "consequents.samples_per_coefficient", "a number >= 0");
  require(c.max_condition > 1.0, "consequents.max_condition", "a number > 1");
  require(c.forgetting > 0.0 && c.forgetting <= 1.0, "consequents.forgetting",
          "a number in (0, 1]");
}

void checkSets(const std::string& where, const OutputStructure& s) {
  require(s.sets.size() == s.antecedents.size(), where + ".sets", "a list of sets per antecedent");
  std::size_t n_rules = 1;
  for (const auto& sets : s.sets) {
    require(!sets.empty(), where + ".sets", "at least one set per antecedent");
    for (const auto& set : sets) set.validate(where + ".sets");
    n_rules *= sets.size();
    require(n_rules <= kMostGridRules, where + ".sets", "at most 5000 combinations");
  }
}

}  // namespace

TsModel Structure::emptyModel() const {
  TsModel model;
  model.name = name;
  model.sample_time_s = sample_time_s;
  const auto names = [](const std::vector<StructureSignal>& from, std::vector<SignalInfo>& to) {
    for (const auto& signal : from) to.push_back(signal.info);
  };
  names(outputs, model.outputs);
  names(inputs, model.inputs);
  names(disturbances, model.disturbances);
  return model;
}

void Structure::validate() const {
  checkPartition(partition);
  checkConsequents(consequents);
  require(validation.correlation_lags >= 1, "validation.correlation_lags", "a number >= 1");
  require(validation.confidence > 0.5 && validation.confidence < 1.0, "validation.confidence",
          "a number in (0.5, 1)");
  require(submodels.size() == outputs.size(), "submodels", "one for each output");
  TsModel model = emptyModel();
  for (std::size_t i = 0; i < submodels.size(); ++i) {
    const OutputStructure& s = submodels[i];
    const std::string where = "submodels." + outputs[i].info.name;
    require(!s.regressors.empty(), where, "at least one regressor");
    require(
        s.clusters_min >= 1 && s.clusters_min <= s.clusters_max && s.clusters_max <= kMostClusters,
        where + ".clusters", "a number or a range within 1..200");
    require(s.clusters_max == 1 || !s.antecedents.empty(), where + ".antecedents",
            "at least one variable");
    if (partition.method == PartitionMethod::kGrid) checkSets(where, s);
    OutputModel submodel;
    submodel.antecedents = s.antecedents;
    submodel.regressors = s.regressors;
    Rule rule;
    rule.antecedents.assign(s.antecedents.size(), {MembershipShape::kGaussian, {0.0, 1.0}});
    rule.coefficients = Vector::Zero(static_cast<Eigen::Index>(s.regressors.size()));
    submodel.rules = {rule};
    model.submodels.push_back(submodel);
  }
  model.validate();
}

std::vector<Regressor> regressorsOf(const std::vector<int>& N_y, const std::vector<int>& N_u,
                                    const std::vector<int>& N_d, int n_inputs) {
  std::vector<Regressor> regressors;
  for (std::size_t j = 0; j < N_y.size(); ++j)
    for (int lag = 0; lag < N_y[j]; ++lag)
      regressors.push_back({SignalKind::kOutput, static_cast<int>(j), lag});
  for (std::size_t j = 0; j < N_u.size(); ++j) {
    const int channel = static_cast<int>(j);
    const bool input = channel < n_inputs;
    for (int i = 0; i < N_u[j]; ++i)
      regressors.push_back({input ? SignalKind::kInput : SignalKind::kDisturbance,
                            input ? channel : channel - n_inputs, N_d[j] - 1 + i});
  }
  return regressors;
}

}  // namespace fpc
