// Checks of a Takagi-Sugeno model and its firing weights: products of degrees, normalised
// (vallejo2019, eqs. 3-9).
#include "fmbpc/model/ts_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr int kLongestLag = 1000;

void checkSignals(const std::string& where, const std::vector<SignalInfo>& signals,
                  std::set<std::string>& seen) {
  for (const auto& signal : signals) {
    require(!signal.name.empty() && signal.name.find_first_of("() \t\n") == std::string::npos,
            where + " '" + signal.name + "'", "a name without blanks and parentheses");
    require(seen.insert(signal.name).second, where + " '" + signal.name + "'",
            "a name used only once");
    require(signal.lower < signal.upper, where + " '" + signal.name + "'",
            "a range with lower < upper");
  }
}

void checkRegressors(const std::string& where, const TsModel& model,
                     const std::vector<Regressor>& regressors) {
  for (std::size_t i = 0; i < regressors.size(); ++i) {
    const Regressor& r = regressors[i];
    const auto& signals = model.signals(r.kind);
    require(r.index >= 0 && static_cast<std::size_t>(r.index) < signals.size(), where,
            "signals of this model");
    require(r.lag >= 0 && r.lag <= kLongestLag, where,
            "lags from 0 to " + std::to_string(kLongestLag));
    require(std::find(regressors.begin(), regressors.begin() + static_cast<std::ptrdiff_t>(i), r) ==
                regressors.begin() + static_cast<std::ptrdiff_t>(i),
            where, "each variable only once");
  }
}

void checkAntecedents(const std::string& where, const OutputModel& model, const Rule& rule) {
  require(rule.multivariate.has_value() == model.rules.front().multivariate.has_value(), where,
          "multivariate memberships in all rules of an output or in none");
  if (rule.multivariate) {
    require(rule.antecedents.empty(), where, "either a multivariate membership or one-dimensional");
    rule.multivariate->validate(where, static_cast<Eigen::Index>(model.antecedents.size()));
    return;
  }
  require(rule.antecedents.size() == model.antecedents.size(), where,
          std::to_string(model.antecedents.size()) + " antecedents");
  for (std::size_t i = 0; i < rule.antecedents.size(); ++i)
    rule.antecedents[i].validate(where + " antecedent " + std::to_string(i + 1));
}

void checkRule(const std::string& where, const OutputModel& model, const Rule& rule) {
  checkAntecedents(where, model, rule);
  require(rule.coefficients.size() == static_cast<Eigen::Index>(model.regressors.size()), where,
          std::to_string(model.regressors.size()) + " coefficients");
  require(rule.coefficients.allFinite() && std::isfinite(rule.offset), where,
          "finite coefficients and offset");
}

double logFiring(const Rule& rule, VectorRef values) {
  if (rule.multivariate) return rule.multivariate->logDegree(values);
  double sum = 0.0;
  for (std::size_t i = 0; i < rule.antecedents.size(); ++i)
    sum += rule.antecedents[i].logDegree(values[static_cast<Eigen::Index>(i)]);
  return std::isnan(sum) ? -std::numeric_limits<double>::infinity() : sum;
}

double distanceOf(const Rule& rule, VectorRef values) {
  if (rule.multivariate) return rule.multivariate->distance(values);
  double distance = 0.0;
  for (std::size_t i = 0; i < rule.antecedents.size(); ++i)
    distance += rule.antecedents[i].distance(values[static_cast<Eigen::Index>(i)]);
  return distance;
}

Eigen::Index nearestRule(const OutputModel& model, VectorRef values) {
  Eigen::Index nearest = 0;
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t r = 0; r < model.rules.size(); ++r) {
    const double distance = distanceOf(model.rules[r], values);
    if (distance < shortest) {
      shortest = distance;
      nearest = static_cast<Eigen::Index>(r);
    }
  }
  return nearest;
}

}  // namespace

const std::vector<SignalInfo>& TsModel::signals(SignalKind kind) const {
  switch (kind) {
    case SignalKind::kOutput:
      return outputs;
    case SignalKind::kInput:
      return inputs;
    case SignalKind::kUnmeasured:
      return unmeasured;
    default:
      return disturbances;
  }
}

std::string TsModel::text(const Regressor& regressor) const {
  return signals(regressor.kind)[static_cast<std::size_t>(regressor.index)].name +
         (regressor.lag == 0 ? "(k)" : "(k-" + std::to_string(regressor.lag) + ")");
}

void TsModel::validate() const {
  require(std::isfinite(sample_time_s) && sample_time_s > 0.0, "sample_time_s", "a number > 0");
  require(!outputs.empty(), "outputs", "at least one output");
  std::set<std::string> seen;
  checkSignals("outputs", outputs, seen);
  checkSignals("inputs", inputs, seen);
  checkSignals("disturbances", disturbances, seen);
  checkSignals("unmeasured", unmeasured, seen);
  require(submodels.size() == outputs.size(), "submodels",
          "one for each of " + std::to_string(outputs.size()) + " outputs");
  for (std::size_t i = 0; i < submodels.size(); ++i) {
    const OutputModel& model = submodels[i];
    const std::string where = "submodels." + outputs[i].name;
    checkRegressors(where + ".antecedents", *this, model.antecedents);
    checkRegressors(where + ".regressors", *this, model.regressors);
    require(!model.rules.empty(), where + ".rules", "at least one rule");
    require(model.rules.size() == 1 || !model.antecedents.empty(), where + ".antecedents",
            "at least one variable to tell the rules apart");
    for (std::size_t r = 0; r < model.rules.size(); ++r)
      checkRule(where + ".rules[" + std::to_string(r) + "]", model, model.rules[r]);
  }
  domain.validate(static_cast<Eigen::Index>(outputs.size() + inputs.size() + disturbances.size()));
}

int TsModel::maxLag(SignalKind kind, int index) const {
  int lag = -1;
  for (const auto& model : submodels)
    for (const auto* list : {&model.antecedents, &model.regressors})
      for (const auto& r : *list)
        if (r.kind == kind && r.index == index) lag = std::max(lag, r.lag);
  return lag;
}

void firingWeights(const OutputModel& model, VectorRef antecedent_values, FiringResult& result) {
  const auto n_rules = static_cast<Eigen::Index>(model.rules.size());
  result.weights.resize(n_rules);
  double largest = -std::numeric_limits<double>::infinity();
  for (Eigen::Index r = 0; r < n_rules; ++r) {
    result.weights[r] = logFiring(model.rules[static_cast<std::size_t>(r)], antecedent_values);
    largest = std::max(largest, result.weights[r]);
  }
  result.fired = std::isfinite(largest);
  if (!result.fired) {
    result.weights.setZero();
    result.weights[nearestRule(model, antecedent_values)] = 1.0;
    return;
  }
  for (Eigen::Index r = 0; r < n_rules; ++r)
    result.weights[r] = std::exp(result.weights[r] - largest);
  result.weights /= result.weights.sum();
}

}  // namespace fpc
