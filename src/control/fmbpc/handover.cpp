// One model takes over from another between two samples, without a bump.
#include <utility>

#include "control/fmbpc/memory.hpp"
#include "fmbpc/fuzzy/model_match.hpp"

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

bool FmbpcLaw::Belief::inherit(const Belief& other) {
  if (canonical || twin) return false;
  if (!sameLags(local.model(), other.local.model()) || !other.measured.allFinite()) return false;
  measured = other.measured;
  const bool goes_on = other.state.allFinite() && sameRules(local.model(), other.local.model());
  state = realigned || !goes_on ? measured : other.state;
  for (Eigen::Index i = 0; i < undelayed.size(); ++i) undelayed[i] = state[local.outputState(i)];
  if (goes_on) error_filtered = other.error_filtered;
  if (observer && other.observer) {
    observer->inherit(*other.observer);
    state = observer->state();
  }
  return true;
}

void FmbpcLaw::setModel(const TsModel& model) {
  Memory& m = *memory_;
  m.retired.reset();
  auto belief = std::make_unique<Belief>(matchToPlant(model, m.plant), m.params,
                                         countOf(m.plant.outputs), countOf(m.plant.inputs));
  if (m.iterated)
    belief->planner.emplace(belief->local,
                            PathParams{m.params.horizon_steps, m.params.iterations,
                                       m.params.weight_output, m.params.weight_move},
                            m.limits);
  if (m.belief && m.running && !m.start_pending) {
    m.successor = std::move(belief);
    return;
  }
  m.successor.reset();
  m.belief = std::move(belief);
  m.start_pending = true;
  m.transfer_pending = m.transfer_pending || m.running;
}

/// The old model has just proposed an input; the new one goes on from there: its bias is what it
/// would have done otherwise. If the old one had nothing to propose, the new one goes on from the
/// applied input.
bool FmbpcLaw::handOver(const Measurement& now, bool& solvable) {
  Memory& m = *memory_;
  if (!solvable || !m.proposal.allFinite()) m.proposal = now.input_applied;
  m.wanted = m.proposal;
  m.belief.swap(m.successor);
  if (!m.belief->inherit(*m.successor)) m.belief->rest(now, m.disturbances);
  m.retired = std::move(m.successor);  // freed outside of the step
  m.bias.setZero();
  m.transfer_pending = false;
  const bool fired = think(now, solvable);
  m.bias = m.wanted - m.proposal;
  m.proposal = m.wanted;
  return fired;
}

}  // namespace fpc
