#include "control/fmbpc_belief.hpp"

namespace fpc {
namespace {

bool sameLags(const TsModel& a, const TsModel& b) {
  for (const SignalKind kind : {SignalKind::kOutput, SignalKind::kInput, SignalKind::kDisturbance})
    for (std::size_t i = 0; i < a.signals(kind).size(); ++i)
      if (a.maxLag(kind, static_cast<int>(i)) != b.maxLag(kind, static_cast<int>(i))) return false;
  return true;
}

bool sameSets(const Rule& a, const Rule& b) {
  if (a.antecedents.size() != b.antecedents.size()) return false;
  for (std::size_t j = 0; j < a.antecedents.size(); ++j)
    if (a.antecedents[j].shape != b.antecedents[j].shape ||
        a.antecedents[j].parameters != b.antecedents[j].parameters)
      return false;
  return true;
}

/// Only the consequents differ, as those of a model that learns.
bool sameRules(const TsModel& a, const TsModel& b) {
  for (std::size_t i = 0; i < a.submodels.size(); ++i) {
    const OutputModel &one = a.submodels[i], &other = b.submodels[i];
    if (!(one.antecedents == other.antecedents) || !(one.regressors == other.regressors) ||
        one.rules.size() != other.rules.size())
      return false;
    for (std::size_t r = 0; r < one.rules.size(); ++r)
      if (!sameSets(one.rules[r], other.rules[r])) return false;
  }
  return true;
}

}  // namespace

bool FmbpcBelief::inherit(const FmbpcBelief& other, bool realigned) {
  if (!sameLags(local.model(), other.local.model()) || !other.measured.allFinite()) return false;
  measured = other.measured;
  const bool goes_on = other.state.allFinite() && sameRules(local.model(), other.local.model());
  state = realigned || !goes_on ? measured : other.state;
  for (Eigen::Index i = 0; i < outputs.size(); ++i) outputs[i] = state[local.outputState(i)];
  if (goes_on) error_filtered = other.error_filtered;
  offset_output.setZero();
  if (!realigned)
    for (Eigen::Index i = 0; i < outputs.size(); ++i)
      offset_output[i] = measured[local.outputState(i)] - outputs[i];
  return true;
}

}  // namespace fpc
