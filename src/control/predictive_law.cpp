#include "fmbpc/control/predictive_law.hpp"

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"

namespace fpc {

template <>
void requireSameLayout<LawLayout>() {}

PredictiveLaw::PredictiveLaw(const PredictiveLawParams& params, const InputLimits& limits,
                             const PlantInfo& plant, const std::vector<std::string>& output_signals,
                             const std::vector<std::string>& estimated)
    : limits_(limits),
      plant_(plant),
      preview_(params.preview),
      holdback_(params.reference_holdback.size() > 0
                    ? params.reference_holdback
                    : Vector(Vector::Constant(countOf(plant_.outputs), kInfinity))),
      output_signals_(output_signals.size()),
      reference_(params.reference_pole, params.preview),
      transfer_(countOf(plant_.inputs), params.transfer_decay),
      disturbances_(Vector::Zero(countOf(plant_.disturbances))),
      past_disturbances_(disturbances_),
      proposal_(Vector::Zero(countOf(plant_.inputs))),
      last_input_(limits_.lower) {
  limits_.validate(countOf(plant_.inputs));
  for (const auto& output : plant_.outputs)
    for (const auto& name : output_signals) signals_.emplace_back(output.name + "_" + name, 0.0);
  for (const auto& input : plant_.inputs) signals_.emplace_back(input.name + "_unclipped", 0.0);
  for (const auto& name : estimated) signals_.emplace_back(name + "_estimate", 0.0);
}

void PredictiveLaw::reset(const Measurement& start) {
  if (successor_ || tuning_waits_) adopt();
  reference_.reset(start.outputs);
  transfer_.reset(start.header.step > 0);
  start_pending_ = true;
  running_ = false;
}

void PredictiveLaw::forget() {
  for (LawCore* core : {core_.get(), successor_.get()})
    if (core) core->forget();
}

/// What waits counts. The core before is freed later, not in a step.
void PredictiveLaw::adopt() {
  if (successor_) {
    core_.swap(successor_);
    retired_ = std::move(successor_);
  } else {
    core_->adoptTuning();
  }
  tuning_waits_ = false;
  next_reference_->goOnFrom(reference_);
  std::swap(reference_, *next_reference_);
}

/// Outside of a step, as it allocates.
void PredictiveLaw::prepareReference(const Vector& pole) {
  next_reference_.emplace(pole, preview_);
}

/// A core that comes while the loop runs waits for the next step, where both laws are known.
void PredictiveLaw::takeOver(std::unique_ptr<LawCore> core) {
  retired_.reset();
  successor_ = std::move(core);
  successor_->setTrustThreshold(trust_heeded_, trust_least_);
  prepareReference(successor_->referencePole());
  if (inRun()) return;
  adopt();
  retired_.reset();
  start_pending_ = true;
  if (running_) transfer_.reset(true);
}

void PredictiveLaw::setTrustThreshold(double threshold, Eigen::Index least) {
  trust_heeded_ = threshold;
  trust_least_ = least;
  for (LawCore* core : {core_.get(), successor_.get()})
    if (core) core->setTrustThreshold(threshold, least);
}

void PredictiveLaw::tuningPrepared(const Vector& reference_pole) {
  prepareReference(reference_pole);
  if (successor_) return successor_->adoptTuning();
  tuning_waits_ = core_ != nullptr;
  if (tuning_waits_ && !inRun()) adopt();
}

void PredictiveLaw::estimate(const LawSample& sample) {
  past_disturbances_ = disturbances_;
  disturbances_ = sample.now.disturbances;
  if (start_pending_) {
    past_disturbances_ = disturbances_;
    core_->rest(sample);
  } else {
    core_->advance(sample);
  }
  start_pending_ = false;
  note(sample);
}

/// disturbances_ are still those of the sample before.
bool PredictiveLaw::foresee(const Measurement& now, Eigen::Ref<Vector> outputs) {
  if (!inRun() || !core_->finite()) return false;
  core_->foresee(now.input_applied, disturbances_, outputs);
  return true;
}

Proposal PredictiveLaw::propose(const LawSample& sample) {
  const Proposal proposal = core_->propose(sample, proposal_);
  transfer_.apply(sample.now.input_applied, proposal_);
  return proposal;
}

/// The old law has just proposed an input; the new one goes on from there: its bias is what it
/// would have done otherwise. If the old one had nothing to propose, the new one goes on from the
/// applied input.
void PredictiveLaw::handOver(const LawSample& sample, bool& fired, Proposal& proposal) {
  if (proposal.trouble != EventCode::kNone || !proposal_.allFinite())
    proposal_ = sample.now.input_applied;
  transfer_.begin(proposal_);
  const bool other_core = successor_ != nullptr;
  adopt();
  if (other_core) {
    if (!core_->inherit(*retired_)) core_->rest(sample);
    fired = core_->look(sample);
  }
  proposal = propose(sample);
  transfer_.finish(proposal_);
}

void PredictiveLaw::hold(const Measurement& now, const Notice& why, ControllerOutput& output) {
  if (now.input_applied.allFinite()) last_input_ = now.input_applied;
  limits_.clip(last_input_, last_input_);
  output.input = last_input_;
  output.source = ActionSource::kHeld;
  output.ok = false;
  output.events.add(why);
  transfer_.reset(true);
}

void PredictiveLaw::refreshSignals() {
  std::size_t place = 0;
  for (Eigen::Index i = 0; i < countOf(plant_.outputs); ++i)
    for (std::size_t which = 0; which < output_signals_; ++which)
      signals_[place++].second = core_->signal(i, which);
  for (Eigen::Index i = 0; i < proposal_.size(); ++i) signals_[place++].second = proposal_[i];
  for (std::size_t i = 0; place < signals_.size(); ++i)
    signals_[place++].second = core_->estimated(i);
}

void PredictiveLaw::predict(const LawSample& sample, PredictiveAction& prediction) const {
  prediction.header = sample.now.header;
  core_->predict(prediction);
  transfer_.addTo(prediction.feedforward);
  prediction.setpoint = sample.setpoint.present();
  prediction.input_base_unclipped = proposal_;
  prediction.input_previous = sample.now.input_applied;
  prediction.input_lower = limits_.lower;
  prediction.input_upper = limits_.upper;
}

void PredictiveLaw::act(const LawSample& sample, ControllerOutput& output) {
  const Measurement& now = sample.now;
  if (!core_ || !allFinite(now)) {
    start_pending_ = true;
    return hold(now, {EventCode::kLawFailed, core_ ? "the measurement is not finite" : "no model"},
                output);
  }
  estimate(sample);
  bool fired = core_->look(sample);
  Proposal proposal = propose(sample);
  if (successor_ || tuning_waits_) handOver(sample, fired, proposal);
  refreshSignals();
  if (!core_->finite()) start_pending_ = true;
  if (proposal.trouble != EventCode::kNone) return hold(now, {proposal.trouble}, output);
  if (!proposal_.allFinite()) return hold(now, {EventCode::kLawFailed}, output);
  limits_.clip(output.input = proposal_, now.input_applied);
  last_input_ = output.input;
  output.source = output.input == proposal_ ? ActionSource::kBase : ActionSource::kClipped;
  if (!fired) output.events.add({EventCode::kNoRuleFired});
  if (proposal.notice.code != EventCode::kNone) output.events.add(proposal.notice);
  predict(sample, output.prediction);
  output.predictive = true;
  transfer_.fade();
}

bool PredictiveLaw::holdBack(const Measurement& now) {
  return now.outputs.allFinite() && reference_.holdBack(now.outputs, holdback_);
}

void PredictiveLaw::step(const Measurement& now, const SetpointSource& setpoint,
                         ControllerOutput& output) {
  const bool held_back = holdBack(now);
  output.begin();
  output.reference = reference_.asked();
  running_ = true;
  act({now, setpoint, reference_, disturbances_, past_disturbances_}, output);
  if (held_back) output.events.add({EventCode::kReferenceHeldBack});
  reference_.advance(setpoint, now.header.step);
}

}  // namespace fpc
