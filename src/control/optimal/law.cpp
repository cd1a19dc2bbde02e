// The fuzzy optimal predictive law. Source: Taieb, Soltani and Chaari 2017, eqs. 7-14, with the
// disturbance estimate, horizons and move weights that make it free of offset.
#include "fmbpc/control/optimal/law.hpp"

#include "control/optimal/memory.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/fuzzy/model_match.hpp"

namespace fpc {
namespace {

constexpr const char* kShortSighted =
    "controller.horizon_steps is too short: an input hardly acts within it";

bool allFinite(const Measurement& m) {
  return m.outputs.allFinite() && m.disturbances.allFinite() && m.input_applied.allFinite();
}

}  // namespace

FuzzyOptimalLaw::FuzzyOptimalLaw(FuzzyOptimalParams params, InputLimits limits, PlantInfo plant) {
  params.validate(signalCount(plant.outputs), signalCount(plant.inputs));
  limits.validate(signalCount(plant.inputs));
  require(params.disturbance_feedforward ||
              params.disturbance_nominal.size() == signalCount(plant.disturbances),
          "controller.disturbance_nominal", std::to_string(plant.disturbances.size()) + " numbers");
  memory_ = std::make_unique<Memory>(std::move(params), std::move(limits), std::move(plant));
}

FuzzyOptimalLaw::~FuzzyOptimalLaw() = default;

void FuzzyOptimalLaw::setModel(const TsModel& model) {
  Memory& m = *memory_;
  TsModel matched = matchToPlant(model, m.plant);
  auto bank = std::make_unique<Bank>(matched, m.params);
  m.model = std::move(matched);
  takeOver(std::move(bank));
}

void FuzzyOptimalLaw::check(const FuzzyOptimalParams& params, const TsModel& model) {
  Bank(model, params);
}

void FuzzyOptimalLaw::retune(FuzzyOptimalTuning tuning) {
  Memory& m = *memory_;
  tuning.validate(signalCount(m.plant.outputs), signalCount(m.plant.inputs));
  FuzzyOptimalParams params = m.params;
  params.tuning = std::move(tuning);
  std::unique_ptr<Bank> bank;
  if (m.model) bank = std::make_unique<Bank>(*m.model, params);
  m.params = std::move(params);
  if (bank) takeOver(std::move(bank));
}

const FuzzyOptimalTuning& FuzzyOptimalLaw::tuning() const { return memory_->params.tuning; }

/// A bank that comes while the loop runs waits for the next step, where both laws are known.
void FuzzyOptimalLaw::takeOver(std::unique_ptr<Bank> bank) {
  Memory& m = *memory_;
  m.retired.reset();
  if (m.bank && m.running && !m.start_pending) {
    m.successor = std::move(bank);
    return;
  }
  m.successor.reset();
  m.bank = std::move(bank);
  m.start_pending = true;
  m.transfer_pending = m.transfer_pending || m.running;
}

void FuzzyOptimalLaw::reset(const Measurement& start) {
  Memory& m = *memory_;
  if (m.successor) m.bank = std::move(m.successor);
  m.reference.reset(start.outputs);
  m.bias.setZero();
  m.start_pending = true;
  m.transfer_pending = start.header.step > 0;
  m.running = false;
}

/// From the state of sample k to a proposal; false if no rule fired.
bool FuzzyOptimalLaw::think(const Measurement& now, const SetpointSource& setpoint) {
  Memory& m = *memory_;
  Bank& b = *m.bank;
  b.estimate(now, m.past_disturbances);
  const bool fired = b.blend(m.disturbances, b.tuning.input_target);
  m.reference.predict(setpoint, now.header.step, b.future);
  b.forward(0, m.proposal);
  m.proposal.noalias() -= b.K * b.state;
  transfer(now);
  return fired;
}

bool FuzzyOptimalLaw::handOver(const Measurement& now, const SetpointSource& setpoint) {
  Memory& m = *memory_;
  if (!m.proposal.allFinite()) m.proposal = now.input_applied;
  m.wanted = m.proposal;
  m.bank.swap(m.successor);
  if (!m.bank->inherit(*m.successor)) m.bank->rest(now, m.disturbances);
  m.retired = std::move(m.successor);  // freed outside of the step
  m.bias.setZero();
  m.transfer_pending = false;
  const bool fired = think(now, setpoint);
  m.bias = m.wanted - m.proposal;
  m.proposal = m.wanted;
  return fired;
}

void FuzzyOptimalLaw::transfer(const Measurement& now) {
  Memory& m = *memory_;
  if (m.transfer_pending && m.proposal.allFinite()) {
    m.bias = now.input_applied - m.proposal;
    m.proposal = now.input_applied;
    m.transfer_pending = false;
  } else {
    m.proposal += m.bias;
  }
}

void FuzzyOptimalLaw::predict(const Measurement& now, const SetpointSource& setpoint,
                              PredictiveAction& prediction) const {
  const Memory& m = *memory_;
  const Bank& b = *m.bank;
  const Eigen::Index n_c = m.params.prediction_steps;
  prediction.header = now.header;
  prediction.state = b.state;
  prediction.A = b.local.affine().A;
  prediction.B = b.local.affine().B;
  prediction.C = b.local.affine().C;
  prediction.offset_state = b.offset_state;
  prediction.offset_output = b.offset_output;
  prediction.K = b.K;
  prediction.feedforward.resize(m.bias.size(), n_c);
  double decay = 1.0;
  for (Eigen::Index i = 0; i < n_c; ++i, decay *= m.params.transfer_decay) {
    b.forward(i, prediction.feedforward.col(i));
    prediction.feedforward.col(i) += decay * m.bias;
  }
  prediction.reference = b.future.leftCols(n_c);
  prediction.setpoint = setpoint.present();
  prediction.input_base_unclipped = m.proposal;
  prediction.input_previous = now.input_applied;
}

void FuzzyOptimalLaw::hold(const Measurement& now, const char* reason, ControllerOutput& output) {
  Memory& m = *memory_;
  if (now.input_applied.allFinite()) m.last_input = now.input_applied;
  m.limits.clip(m.last_input, m.last_input);
  output.input = m.last_input;
  output.source = ActionSource::kHeld;
  output.ok = false;
  output.remark = reason;
  m.transfer_pending = true;
  m.bias.setZero();
}

void FuzzyOptimalLaw::refreshSignals() {
  Memory& m = *memory_;
  std::size_t place = 0;
  for (const double error : m.bank->error) m.signals[place++].second = error;
  for (const double input : m.proposal) m.signals[place++].second = input;
}

void FuzzyOptimalLaw::step(const Measurement& now, const SetpointSource& setpoint,
                           ControllerOutput& output) {
  Memory& m = *memory_;
  output.reference = m.reference.present();
  output.predictive = false;
  output.ok = true;
  output.remark = "";
  m.running = true;
  if (!m.bank || !allFinite(now)) {
    m.reference.advance(setpoint, now.header.step);
    m.start_pending = true;
    return hold(now, m.bank ? "the measurement is not finite" : "no model", output);
  }
  m.past_disturbances = m.disturbances;
  if (m.params.disturbance_feedforward) m.disturbances = now.disturbances;
  if (m.start_pending) {
    m.past_disturbances = m.disturbances;
    m.bank->rest(now, m.disturbances);
  } else {
    m.bank->advance(now, m.past_disturbances);
  }
  m.start_pending = false;
  bool fired = think(now, setpoint);
  if (m.successor) fired = handOver(now, setpoint);
  m.reference.advance(setpoint, now.header.step);
  refreshSignals();
  if (!m.proposal.allFinite()) return hold(now, "the law gave no finite input", output);
  m.limits.clip(output.input = m.proposal, now.input_applied);
  m.last_input = output.input;
  output.source = output.input == m.proposal ? ActionSource::kBase : ActionSource::kClipped;
  if (m.bank->short_sighted) output.remark = kShortSighted;
  if (!fired) output.remark = "no rule fired: the nearest one was used";
  predict(now, setpoint, output.prediction);
  output.predictive = true;
  m.bias *= m.params.transfer_decay;
}

const std::vector<std::pair<std::string, double>>& FuzzyOptimalLaw::signals() const {
  return memory_->signals;
}

}  // namespace fpc
