#include "model/same_rules.hpp"

namespace fpc {
namespace {

bool sameSets(const Rule& a, const Rule& b) {
  if (a.antecedents.size() != b.antecedents.size()) return false;
  if (a.multivariate.has_value() != b.multivariate.has_value()) return false;
  if (a.multivariate && (a.multivariate->center != b.multivariate->center ||
                         a.multivariate->inverse_covariance != b.multivariate->inverse_covariance))
    return false;
  for (std::size_t j = 0; j < a.antecedents.size(); ++j)
    if (a.antecedents[j].shape != b.antecedents[j].shape ||
        a.antecedents[j].parameters != b.antecedents[j].parameters)
      return false;
  return true;
}

}  // namespace

bool sameLags(const TsModel& a, const TsModel& b) {
  if (a.unmeasured.size() != b.unmeasured.size()) return false;
  for (const SignalKind kind :
       {SignalKind::kOutput, SignalKind::kInput, SignalKind::kDisturbance, SignalKind::kUnmeasured})
    for (std::size_t i = 0; i < a.signals(kind).size(); ++i)
      if (a.maxLag(kind, static_cast<int>(i)) != b.maxLag(kind, static_cast<int>(i))) return false;
  return true;
}

bool sameWeights(const OutputModel& a, const OutputModel& b) {
  if (!(a.antecedents == b.antecedents) || a.rules.size() != b.rules.size()) return false;
  for (std::size_t r = 0; r < a.rules.size(); ++r)
    if (!sameSets(a.rules[r], b.rules[r])) return false;
  return true;
}

bool sameRules(const TsModel& a, const TsModel& b) {
  for (std::size_t i = 0; i < a.submodels.size(); ++i) {
    const OutputModel &one = a.submodels[i], &other = b.submodels[i];
    if (!(one.regressors == other.regressors) || !sameWeights(one, other)) return false;
  }
  return true;
}

}  // namespace fpc
