// The fuzzy model-based predictive law. Source: Vallejo 2019 eqs. 19-37; the prediction form is
// Vallejo 2022 eqs. 1-10.
#include "fmbpc/control/fmbpc/law.hpp"

#include <algorithm>
#include <utility>

#include "control/fmbpc/memory.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

bool allFinite(const Measurement& m) {
  return m.outputs.allFinite() && m.disturbances.allFinite() && m.input_applied.allFinite();
}

}  // namespace

FmbpcLaw::FmbpcLaw(FmbpcParams params, InputLimits limits, PlantInfo plant) {
  params.validate(countOf(plant.outputs), countOf(plant.inputs));
  limits.validate(countOf(plant.inputs));
  if (!params.disturbance_feedforward)
    require(params.disturbance_nominal.size() == countOf(plant.disturbances),
            "controller.disturbance_nominal",
            std::to_string(plant.disturbances.size()) + " numbers");
  memory_ = std::make_unique<Memory>(std::move(params), std::move(limits), std::move(plant));
}

FmbpcLaw::~FmbpcLaw() = default;

void FmbpcLaw::reset(const Measurement& start) {
  Memory& m = *memory_;
  if (m.successor) m.belief = std::move(m.successor);
  m.reference.reset(start.outputs);
  m.bias.setZero();
  m.forecast.forget();
  m.start_pending = true;
  m.transfer_pending = start.header.step > 0;
  m.running = false;
}

void FmbpcLaw::estimate(const Measurement& now) {
  Memory& m = *memory_;
  Belief& b = *m.belief;
  if (!m.start_pending) {
    if (m.iterated) b.local.blend(b.state, now.input_applied, m.disturbances);
    b.advance(now, m.disturbances);  // matrices still of sample k-1
  }
  if (m.params.disturbance_feedforward) m.disturbances = now.disturbances;
  if (m.start_pending) {
    b.rest(now, m.disturbances);
    if (b.planner) b.planner->forget();
  }
  m.start_pending = false;
  m.forecast.add(now.header.step, m.disturbances);
}

bool FmbpcLaw::computeGains() {
  Memory& m = *memory_;
  const AffineModel& model = m.belief->affine();
  CoincidenceGains& gains = m.belief->gains;
  if (m.published) return gains.computePublished(model, m.params.coincidence_steps);
  return gains.computeWeighted(model, m.params.coincidence_steps, m.params.weight_output,
                               m.params.weight_move);
}

void FmbpcLaw::propose(const Measurement& now) {
  Memory& m = *memory_;
  Belief& b = *m.belief;
  b.lacking = m.future.col(m.aim) - b.offset_output;
  b.lacking.noalias() -= b.gains.sum() * b.offset_state;
  b.lacking.noalias() -= b.gains.free() * b.state;
  m.proposal.noalias() = b.gains.gain() * b.lacking;
  m.proposal.noalias() += b.gains.moveGain() * now.input_applied;
}

/// The first input of the best path; the local model is then that of its first sample.
bool FmbpcLaw::proposePath(const Measurement& now) {
  Memory& m = *memory_;
  Belief& b = *m.belief;
  b.correction = b.offset_state - b.local.affine().g;
  if (!b.planner->plan(b.state, b.correction, b.offset_output, m.forecast.predict(), m.future,
                       now.input_applied))
    return false;
  m.proposal = b.planner->inputs().col(0);
  b.local.blend(b.state, m.proposal, m.disturbances);
  b.offset_state = b.local.affine().g + b.correction;
  return true;
}

void FmbpcLaw::transfer(const Measurement& now) {
  Memory& m = *memory_;
  if (m.transfer_pending && m.proposal.allFinite()) {
    m.bias = now.input_applied - m.proposal;
    m.proposal = now.input_applied;
    m.transfer_pending = false;
  } else {
    m.proposal += m.bias;
  }
}

/// With A, B, g and y - y_m frozen, the law at k+i is affine in x(k+i): K = F P - V E, where E
/// picks u(k+i-1) from the state; what is left is the feedforward. The iterated law hands over its
/// plan: K = 0.
void FmbpcLaw::predict(const Measurement& now, const SetpointSource& setpoint,
                       PredictiveAction& prediction) const {
  const Memory& m = *memory_;
  Belief& b = *m.belief;
  prediction.header = now.header;
  prediction.state = b.state;
  prediction.A = b.affine().A;
  prediction.B = b.affine().B;
  prediction.C = b.affine().C;
  prediction.offset_state = b.offset_state;
  prediction.offset_output = b.offset_output;
  prediction.K.noalias() = b.gains.gain() * b.gains.free();
  for (Eigen::Index j = 0; j < m.bias.size() && !m.published; ++j)
    prediction.K.col(b.local.inputState(j, 1)) -= b.gains.moveGain().col(j);
  if (m.iterated) prediction.K.setZero();
  prediction.feedforward.resize(m.bias.size(), m.params.prediction_steps);
  double decay = 1.0;
  for (Eigen::Index i = 0; i < m.params.prediction_steps; ++i, decay *= m.params.transfer_decay) {
    if (m.iterated) {
      const Matrix& plan = b.planner->inputs();
      prediction.feedforward.col(i) = plan.col(std::min(i, plan.cols() - 1)) + decay * m.bias;
      continue;
    }
    b.lacking = m.future.col(i + m.aim) - b.offset_output;
    b.lacking.noalias() -= b.gains.sum() * b.offset_state;
    prediction.feedforward.col(i).noalias() = b.gains.gain() * b.lacking;
    prediction.feedforward.col(i) += decay * m.bias;
  }
  prediction.reference =
      m.future.middleCols(m.params.reference_lead_steps, m.params.prediction_steps);
  prediction.setpoint = setpoint.present();
  prediction.input_base_unclipped = m.proposal;
  prediction.input_previous = now.input_applied;
}

/// From the state of sample k to a proposal; false if no rule fired.
bool FmbpcLaw::think(const Measurement& now, bool& solvable) {
  Memory& m = *memory_;
  Belief& b = *m.belief;
  const bool fired = b.blend(m.disturbances);
  b.compare(now);
  solvable = m.iterated ? proposePath(now) : computeGains();
  if (!m.iterated) propose(now);
  transfer(now);
  return fired;
}

void FmbpcLaw::hold(const Measurement& now, const char* reason, ControllerOutput& output) {
  Memory& m = *memory_;
  if (now.input_applied.allFinite()) m.last_input = now.input_applied;
  m.limits.clip(m.last_input, m.last_input);
  output.input = m.last_input;
  output.source = ActionSource::kHeld;
  output.ok = false;
  output.remark = reason;
  m.transfer_pending = true;
}

void FmbpcLaw::refreshSignals(const Measurement& now) {
  Memory& m = *memory_;
  const Belief& b = *m.belief;
  std::size_t place = 0;
  for (Eigen::Index i = 0; i < now.outputs.size(); ++i) {
    m.signals[place++].second = b.outputs[i];
    m.signals[place++].second = b.correctionOf(i);
    if (m.params.delay_steps > 0) m.signals[place++].second = b.undelayed[i] + b.offset_output[i];
  }
  for (Eigen::Index i = 0; i < m.proposal.size(); ++i) m.signals[place++].second = m.proposal[i];
}

void FmbpcLaw::step(const Measurement& now, const SetpointSource& setpoint,
                    ControllerOutput& output) {
  Memory& m = *memory_;
  output.reference = m.reference.present();
  output.predictive = false;
  output.ok = true;
  output.remark = "";
  m.reference.predict(setpoint, now.header.step, m.future);
  m.reference.advance(setpoint, now.header.step);
  m.running = true;
  if (!m.belief) return hold(now, "no model", output);
  if (!allFinite(now)) {
    m.start_pending = true;
    return hold(now, "the measurement is not finite", output);
  }

  estimate(now);
  bool solvable = false;
  bool fired = think(now, solvable);
  if (m.successor) fired = handOver(now, solvable);
  const Belief& b = *m.belief;
  refreshSignals(now);
  if (!b.state.allFinite()) m.start_pending = true;
  if (!solvable || !m.proposal.allFinite()) {
    m.bias.setZero();
    const bool no_effect = !solvable && !m.iterated;
    return hold(
        now, no_effect ? "the input has no effect at the horizon" : "the law gave no finite input",
        output);
  }
  m.limits.clip(output.input = m.proposal, now.input_applied);
  m.last_input = output.input;
  output.source = output.input == m.proposal ? ActionSource::kBase : ActionSource::kClipped;
  if (!fired) output.remark = "no rule fired: the nearest one was used";
  predict(now, setpoint, output.prediction);
  output.predictive = true;
  m.bias *= m.params.transfer_decay;
}

const std::vector<std::pair<std::string, double>>& FmbpcLaw::signals() const {
  return memory_->signals;
}

}  // namespace fpc
