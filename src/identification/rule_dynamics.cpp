// Poles and steady-state gains of single rules.
#include <limits>
#include <map>

#include "identification/validation.hpp"
#include "model/rule_poles.hpp"

namespace fpc {
namespace {

bool isOwn(const Regressor& r, std::size_t output) {
  return r.kind == SignalKind::kOutput && static_cast<std::size_t>(r.index) == output;
}

void addGains(const TsModel& names, const OutputModel& model, const Rule& rule, std::size_t output,
              RuleDynamics& dynamics) {
  double own = 0.0;
  std::map<std::string, double> sums;
  for (std::size_t j = 0; j < model.regressors.size(); ++j) {
    const Regressor& r = model.regressors[j];
    const double coefficient = rule.coefficients[static_cast<Eigen::Index>(j)];
    if (isOwn(r, output)) {
      own += coefficient;
      continue;
    }
    const std::string& name = names.signals(r.kind)[static_cast<std::size_t>(r.index)].name;
    if (sums.count(name) == 0) dynamics.signals.push_back(name);
    sums[name] += coefficient;
  }
  for (const auto& name : dynamics.signals)
    dynamics.gains.push_back(own == 1.0 ? std::numeric_limits<double>::infinity()
                                        : sums[name] / (1.0 - own));
}

}  // namespace

std::vector<RuleDynamics> ruleDynamics(const TsModel& model) {
  std::vector<RuleDynamics> all;
  for (std::size_t i = 0; i < model.submodels.size(); ++i)
    for (std::size_t r = 0; r < model.submodels[i].rules.size(); ++r) {
      const Rule& rule = model.submodels[i].rules[r];
      RuleDynamics dynamics;
      dynamics.output = model.outputs[i].name;
      dynamics.rule = r + 1;
      dynamics.data_count = rule.data_count;
      dynamics.poles = rulePoles(model.submodels[i], rule, i);
      addGains(model, model.submodels[i], rule, i, dynamics);
      all.push_back(dynamics);
    }
  return all;
}

}  // namespace fpc
