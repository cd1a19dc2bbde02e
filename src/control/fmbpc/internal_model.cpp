#include "control/fmbpc/internal_model.hpp"

#include "fmbpc/fuzzy/undelayed.hpp"

namespace fpc {

FmbpcLaw::Belief::Belief(const TsModel& model, const FmbpcParams& params, Eigen::Index n_y,
                         Eigen::Index n_u)
    : realigned(params.realisation == "realigned"),
      antecedent_measured(params.antecedent == "measured"),
      offset_gain(params.offset_gain),
      local(withoutDelay(model, params.delay_steps)),
      canonical(params.realisation == "literal" ? std::make_optional<CanonicalForm>(local.model())
                                                : std::nullopt),
      gains(affine().g.size(), n_u, n_y),
      state(Vector::Zero(affine().g.size())),
      measured(Vector::Zero(local.stateSize())),
      next(state),
      offset_state(state),
      offset_output(Vector::Zero(n_y)),
      error_filtered(offset_output),
      undelayed(offset_output),
      outputs(offset_output),
      lacking(offset_output),
      correction(state) {
  if (params.realisation == "observer")
    observer.emplace(local, params.observer, params.delay_steps);
  else if (params.delay_steps > 0)
    twin.emplace(local, canonical, params.delay_steps);
}

void FmbpcLaw::Belief::rest(const Measurement& now, VectorRef disturbances) {
  local.restState(now.outputs, now.input_applied, disturbances, measured);
  if (canonical) {
    local.blend(measured, disturbances);
    canonical->blend(local.firing().front());
    canonical->restState(now.input_applied[0], state);
  } else {
    state = measured;
  }
  if (twin) twin->rest(now.outputs, now.input_applied, disturbances);
  if (observer) observer->rest(now.outputs, now.input_applied, disturbances);
  error_filtered.setZero();
  undelayed = now.outputs;
}

void FmbpcLaw::Belief::advance(const Measurement& now, VectorRef disturbances) {
  if (observer) {
    observer->advance(now.outputs, now.input_applied, disturbances);
    local.shiftState(now.outputs, now.input_applied, disturbances, measured);
    state = observer->state();
    for (Eigen::Index i = 0; i < undelayed.size(); ++i) undelayed[i] = state[local.outputState(i)];
    return;
  }
  next = affine().g;
  next.noalias() += affine().A * state;
  next.noalias() += affine().B * now.input_applied;
  local.shiftState(now.outputs, now.input_applied, disturbances, measured);
  for (Eigen::Index i = 0; i < undelayed.size(); ++i) undelayed[i] = next[local.outputState(i)];
  if (realigned) error_filtered += offset_gain * (now.outputs - undelayed - error_filtered);
  state = realigned ? measured : next;
  if (twin) twin->advance(now.input_applied);
}

bool FmbpcLaw::Belief::blend(VectorRef disturbances) {
  const bool fired = local.blend(antecedent_measured ? measured : state, disturbances);
  if (canonical) canonical->blend(local.firing().front());
  if (twin) twin->blend(disturbances, antecedent_measured ? &measured : nullptr);
  return fired;
}

void FmbpcLaw::Belief::compare(const Measurement& now) {
  if (canonical) undelayed.noalias() = affine().C * state;
  outputs = undelayed;
  if (twin) twin->output(outputs);
  offset_output.setZero();
  offset_state = affine().g;
  if (observer) {
    outputs = now.outputs - observer->innovation();
    observer->addDisturbance(offset_state);
    return;
  }
  if (!realigned) offset_output = now.outputs - outputs;
  if (!realigned) return;
  for (Eigen::Index i = 0; i < outputs.size(); ++i)
    offset_state[local.outputState(i)] += error_filtered[i];
}

double FmbpcLaw::Belief::correctionOf(Eigen::Index output) const {
  if (observer) return observer->disturbance()[output];
  return realigned ? error_filtered[output] : offset_output[output];
}

}  // namespace fpc
