// The fuzzy model-based predictive law. Source: Vallejo 2019 eqs. 19-37; the prediction form is
// Vallejo 2022 eqs. 1-10.
#include "fmbpc/control/fmbpc_law.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "control/fmbpc_belief.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/fuzzy/model_file.hpp"

namespace fpc {
namespace {

Eigen::Index count(const std::vector<SignalInfo>& signals) {
  return static_cast<Eigen::Index>(signals.size());
}

bool allFinite(const Measurement& m) {
  return m.outputs.allFinite() && m.disturbances.allFinite() && m.input_applied.allFinite();
}

}  // namespace

struct FmbpcLaw::Belief : FmbpcBelief {
  using FmbpcBelief::FmbpcBelief;
};

struct FmbpcLaw::Memory {
  Memory(FmbpcParams p, InputLimits l, PlantInfo i)
      : params(std::move(p)),
        limits(std::move(l)),
        plant(std::move(i)),
        published(params.law == "published"),
        realigned(params.realisation == "realigned"),
        antecedent_measured(params.antecedent == "measured"),
        reference(params.reference_pole, params.preview),
        future(Matrix::Zero(count(plant.outputs),
                            params.prediction_steps + params.coincidence_steps - 1)),
        disturbances(params.disturbance_feedforward
                         ? Vector(Vector::Zero(count(plant.disturbances)))
                         : params.disturbance_nominal),
        bias(Vector::Zero(count(plant.inputs))),
        proposal(bias),
        wanted(bias),
        last_input(limits.lower) {
    for (const auto& output : plant.outputs) {
      signals.emplace_back(output.name + "_model", 0.0);
      signals.emplace_back(output.name + "_correction", 0.0);
    }
    for (const auto& input : plant.inputs) signals.emplace_back(input.name + "_unclipped", 0.0);
  }

  FmbpcParams params;
  InputLimits limits;
  PlantInfo plant;
  bool published, realigned, antecedent_measured;
  ReferenceTrajectory reference;
  Matrix future;        ///< col(i) = y_r(k+1+i)
  Vector disturbances;  ///< d(k) as the model takes it
  Vector bias;          ///< of a bumpless transfer, dying out
  Vector proposal;      ///< u(k), unclipped
  Vector wanted;        ///< the proposal of a model that is handing over
  Vector last_input;    ///< the last finite input, applied or sent
  std::unique_ptr<Belief> belief;
  std::unique_ptr<Belief> successor;  ///< of a new model: takes over in the next step
  std::unique_ptr<Belief> retired;    ///< of the model before: freed when the next one comes
  std::vector<std::pair<std::string, double>> signals;
  bool start_pending{true};      ///< the state is to be taken from the next measurement
  bool transfer_pending{false};  ///< the next u must equal the applied input
  bool running{false};           ///< an action has been computed since the reset
};

FmbpcLaw::FmbpcLaw(FmbpcParams params, InputLimits limits, PlantInfo plant) {
  params.validate(count(plant.outputs), count(plant.inputs));
  limits.validate(count(plant.inputs));
  if (!params.disturbance_feedforward)
    require(params.disturbance_nominal.size() == count(plant.disturbances),
            "controller.disturbance_nominal",
            std::to_string(plant.disturbances.size()) + " numbers");
  memory_ = std::make_unique<Memory>(std::move(params), std::move(limits), std::move(plant));
}

FmbpcLaw::~FmbpcLaw() = default;

void FmbpcLaw::setModel(const TsModel& model) {
  Memory& m = *memory_;
  m.retired.reset();
  auto belief = std::make_unique<Belief>(matchToPlant(model, m.plant), count(m.plant.outputs),
                                         count(m.plant.inputs));
  if (m.belief && m.running && !m.start_pending) {
    m.successor = std::move(belief);
    return;
  }
  m.successor.reset();
  m.belief = std::move(belief);
  m.start_pending = true;
  m.transfer_pending = m.transfer_pending || m.running;
}

void FmbpcLaw::reset(const Measurement& start) {
  Memory& m = *memory_;
  if (m.successor) m.belief = std::move(m.successor);
  m.reference.reset(start.outputs);
  m.bias.setZero();
  m.start_pending = true;
  m.transfer_pending = start.header.step > 0;
  m.running = false;
}

void FmbpcLaw::estimate(const Measurement& now) {
  Memory& m = *memory_;
  Belief& b = *m.belief;
  const AffineModel& model = b.local.affine();  // still of sample k-1
  const Eigen::Index n_y = now.outputs.size();
  if (m.start_pending) {
    if (m.params.disturbance_feedforward) m.disturbances = now.disturbances;
    b.local.restState(now.outputs, now.input_applied, m.disturbances, b.measured);
    b.state = b.measured;
    b.error_filtered.setZero();
    b.outputs = now.outputs;
    m.start_pending = false;
  } else {
    b.next = model.g;
    b.next.noalias() += model.A * b.state;
    b.next.noalias() += model.B * now.input_applied;
    b.local.shiftState(now.outputs, now.input_applied, m.disturbances, b.measured);
    for (Eigen::Index i = 0; i < n_y; ++i) b.outputs[i] = b.next[b.local.outputState(i)];
    if (m.realigned)
      b.error_filtered += m.params.offset_gain * (now.outputs - b.outputs - b.error_filtered);
    b.state = m.realigned ? b.measured : b.next;
    if (m.params.disturbance_feedforward) m.disturbances = now.disturbances;
  }
  b.offset_output.setZero();
  if (!m.realigned) b.offset_output = now.outputs - b.outputs;
}

bool FmbpcLaw::computeGains() {
  Memory& m = *memory_;
  const AffineModel& model = m.belief->local.affine();
  CoincidenceGains& gains = m.belief->gains;
  if (m.published) return gains.computePublished(model, m.params.coincidence_steps);
  return gains.computeWeighted(model, m.params.coincidence_steps, m.params.weight_output,
                               m.params.weight_move);
}

void FmbpcLaw::propose(const Measurement& now) {
  Memory& m = *memory_;
  Belief& b = *m.belief;
  b.lacking = m.future.col(m.params.coincidence_steps - 1) - b.offset_output;
  b.lacking.noalias() -= b.gains.sum() * b.offset_state;
  b.lacking.noalias() -= b.gains.free() * b.state;
  m.proposal.noalias() = b.gains.gain() * b.lacking;
  m.proposal.noalias() += b.gains.moveGain() * now.input_applied;
  if (m.transfer_pending && m.proposal.allFinite()) {
    m.bias = now.input_applied - m.proposal;
    m.proposal = now.input_applied;
    m.transfer_pending = false;
  } else {
    m.proposal += m.bias;
  }
}

/// With A, B, g and y - y_m frozen, the law at k+i is affine in x(k+i): K = F P - V E, where E
/// picks u(k+i-1) from the state; what is left is the feedforward.
void FmbpcLaw::predict(const Measurement& now, const SetpointSource& setpoint,
                       PredictiveAction& prediction) const {
  const Memory& m = *memory_;
  Belief& b = *m.belief;
  prediction.header = now.header;
  prediction.state = b.state;
  prediction.A = b.local.affine().A;
  prediction.B = b.local.affine().B;
  prediction.C = b.local.affine().C;
  prediction.offset_state = b.offset_state;
  prediction.offset_output = b.offset_output;
  prediction.K.noalias() = b.gains.gain() * b.gains.free();
  for (Eigen::Index j = 0; j < m.bias.size(); ++j)
    prediction.K.col(b.local.inputState(j, 1)) -= b.gains.moveGain().col(j);
  prediction.feedforward.resize(m.bias.size(), m.params.prediction_steps);
  double decay = 1.0;
  for (Eigen::Index i = 0; i < m.params.prediction_steps; ++i, decay *= m.params.transfer_decay) {
    b.lacking = m.future.col(i + m.params.coincidence_steps - 1) - b.offset_output;
    b.lacking.noalias() -= b.gains.sum() * b.offset_state;
    prediction.feedforward.col(i).noalias() = b.gains.gain() * b.lacking;
    prediction.feedforward.col(i) += decay * m.bias;
  }
  prediction.reference = m.future.leftCols(m.params.prediction_steps);
  prediction.setpoint = setpoint.present();
  prediction.input_base_unclipped = m.proposal;
  prediction.input_previous = now.input_applied;
}

/// From the state of sample k to a proposal; false if no rule fired.
bool FmbpcLaw::think(const Measurement& now, bool& solvable) {
  Memory& m = *memory_;
  Belief& b = *m.belief;
  const bool fired = b.local.blend(m.antecedent_measured ? b.measured : b.state, m.disturbances);
  b.offset_state = b.local.affine().g;
  for (Eigen::Index i = 0; i < now.outputs.size(); ++i)
    b.offset_state[b.local.outputState(i)] += b.error_filtered[i];
  solvable = computeGains();
  propose(now);
  return fired;
}

/// The old model has just proposed an input; the new one goes on from there: its bias is what it
/// would have done otherwise. If the old one had nothing to propose, the new one goes on from the
/// applied input.
bool FmbpcLaw::handOver(const Measurement& now, bool& solvable) {
  Memory& m = *memory_;
  if (!solvable || !m.proposal.allFinite()) m.proposal = now.input_applied;
  m.wanted = m.proposal;
  m.belief.swap(m.successor);
  if (!m.belief->inherit(*m.successor, m.realigned)) {
    m.start_pending = true;
    estimate(now);
  }
  m.retired = std::move(m.successor);  // freed outside of the step
  m.bias.setZero();
  m.transfer_pending = false;
  const bool fired = think(now, solvable);
  m.bias = m.wanted - m.proposal;
  m.proposal = m.wanted;
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
    m.signals[place++].second = m.realigned ? b.error_filtered[i] : b.offset_output[i];
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
  m.reference.advance(setpoint.present());
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
    return hold(
        now, solvable ? "the law gave no finite input" : "the input has no effect at the horizon",
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
