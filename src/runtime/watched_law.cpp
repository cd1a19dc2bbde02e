#include "runtime/watched_law.hpp"

#include <algorithm>
#include <cmath>
#include <exception>

#include "base/finite_json.hpp"
#include "base/same_sample.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/model/model_match.hpp"

namespace fpc {
namespace {

constexpr double kDecayBack = 0.7;  // of the bias left by a candidate: it was wrong
constexpr double kFloor = 1e-3;     // of an output's range: errors that always pass
constexpr double kSwingMove = 0.1;  // of an input's range

/// (kFloor of the range)^2; 0 without one.
Vector floorsOf(const std::vector<SignalInfo>& outputs) {
  Vector floors(countOf(outputs));
  for (Eigen::Index i = 0; i < floors.size(); ++i) {
    const SignalInfo& output = outputs[static_cast<std::size_t>(i)];
    const double range = output.upper - output.lower;
    floors[i] = std::isfinite(range) ? std::pow(kFloor * range, 2.0) : 0.0;
  }
  return floors;
}

std::string authorityText(double share) { return shortText(100.0 * share) + " %"; }

}  // namespace

const char* nameOf(CandidateState state) {
  switch (state) {
    case CandidateState::kNone:
      return "none";
    case CandidateState::kWatched:
      return "watched";
    case CandidateState::kPassed:
      return "passed";
    case CandidateState::kRefused:
      return "refused";
    case CandidateState::kInCharge:
      return "in_charge";
    case CandidateState::kBack:
      break;
  }
  return "back";
}

WatchedLaw::WatchedLaw(std::unique_ptr<Controller> inside, TsModel present, InputLimits limits,
                       PlantInfo plant, bool optimizer)
    : ControllerAround(std::move(inside), "candidate"),
      present_(std::move(present)),
      limits_(std::move(limits)),
      plant_(std::move(plant)),
      optimizer_(optimizer),
      into_(countOf(plant_.inputs)),
      backward_(countOf(plant_.inputs), kDecayBack) {
  squares_ = deviation_ = Vector::Zero(countOf(plant_.outputs));
}

void WatchedLaw::watch(CandidateLaw candidate) {
  require(candidate.law != nullptr, "candidate.loop", "a loop with a law");
  require(candidate.law->followsSetpoint(), "candidate.loop", "a law that follows setpoints");
  require(!candidate.model.submodels.empty(), "candidate.loop",
          "a loop with model.file: a law is judged by what its model foresees");
  const bool was_in_charge = inCharge();
  candidate_ = std::move(candidate);
  begin();
  if (was_in_charge) backward_.reset(true);
  say(EventCode::kCandidateWatched, "candidate " + candidate_.name +
                                        " is watched: it is judged after " +
                                        std::to_string(candidate_.params.samples) + " samples");
}

void WatchedLaw::begin() {
  trial_.emplace(candidate_.model, present_.submodels.empty() ? nullptr : &present_,
                 candidate_.params, limits_, candidate_.moved);
  const Eigen::Index window = candidate_.params.step_samples;
  errors_ = ErrorPromise(window, floorsOf(plant_.outputs));
  outputs_ = errors_;
  swings_.assign(plant_.inputs.size(), OscillationDetector(kSwingMove));
  state_ = CandidateState::kWatched;
  fresh_ = true;
  seen_ = taking_ = false;
  level_ = 0;
}

void WatchedLaw::handOver() {
  require(state_ == CandidateState::kPassed, "candidate",
          "one that has passed its trial; it is " + std::string(nameOf(state_)));
  state_ = CandidateState::kInCharge;
  taking_ = true;
  level_ = 0;
  in_level_ = 0;
  for (OscillationDetector& swing : swings_) swing.reset();
  say(EventCode::kHandOver, "candidate " + candidate_.name + " is in charge with " +
                                authorityText(authority()) + " of the allowed moves; " +
                                textOf(trial_->figures()));
}

void WatchedLaw::back() {
  require(inCharge(), "candidate", "one that is in charge");
  goBack("an operator asked for it");
}

void WatchedLaw::goBack(const std::string& why) {
  const double had = authority();
  state_ = CandidateState::kBack;
  backward_.reset(true);
  say(EventCode::kHandBack, "the former law is back in charge, candidate " + candidate_.name +
                                " had " + authorityText(had) + " of the allowed moves: " + why);
}

double WatchedLaw::authority() const {
  return inCharge() ? candidate_.params.authority[level_] : 0.0;
}

void WatchedLaw::reset(const Measurement& start) {
  inside_->reset(start);
  fresh_ = true;
  if (inCharge()) {
    candidate_.law->reset(start);
    fresh_ = false;
  }
}

void WatchedLaw::forget() {
  inside_->forget();
  if (candidate_.law) candidate_.law->forget();
}

void WatchedLaw::lookOn(const Measurement& now) {
  inside_->lookOn(now);
  if (!onTrial() && !inCharge()) return;
  observe(now, nullptr);
  if (inCharge()) return candidate_.law->lookOn(now);
  try {
    candidate_.law->lookOn(now);
  } catch (const std::exception&) {
    fresh_ = true;
  }
}

bool WatchedLaw::foresee(const Measurement& now, Eigen::Ref<Vector> outputs) {
  return inCharge() ? candidate_.law->foresee(now, outputs) : inside_->foresee(now, outputs);
}

bool WatchedLaw::expect(std::uint32_t k, Eigen::Index disturbance, VectorRef ahead) {
  const bool candidate = candidate_.law && candidate_.law->expect(k, disturbance, ahead);
  return inside_->expect(k, disturbance, ahead) || candidate;
}

void WatchedLaw::setModel(const TsModel& model) {
  inside_->setModel(model);
  if (!inside_->needsModel()) return;
  present_ = matchToPlant(model, plant_);
  if (state_ == CandidateState::kWatched && trial_->samples() == 0) begin();
}

bool WatchedLaw::mayBeSent(VectorRef input) const { return acting().mayBeSent(input); }

void WatchedLaw::makeSendable(Eigen::Ref<Vector> input) const { acting().makeSendable(input); }

/// Largest move of a setpoint since the sample before, of its output's range; 0 if that is not
/// known.
double WatchedLaw::changeTo(const Vector& setpoint) const {
  double change = 0.0;
  for (Eigen::Index i = 0; i < setpoint_.size(); ++i) {
    const SignalInfo& output = plant_.outputs[static_cast<std::size_t>(i)];
    const double range = output.upper - output.lower, moved = std::abs(setpoint[i] - setpoint_[i]);
    if (std::isfinite(moved))
      change = std::max(change, std::isfinite(range) && range > 0.0 ? moved / range : moved);
  }
  return change;
}

/// What the sample says of the candidate's model and of the loop, whoever has the inputs.
void WatchedLaw::observe(const Measurement& now, const SetpointSource* setpoint) {
  if (seen_ && isSameSample(now.header, last_)) return;
  const bool next = seen_ && now.header.run_id == last_.run_id && now.header.step == last_.step + 1;
  if (!next) trial_->interrupt();
  last_ = now.header;
  seen_ = true;
  trial_->look(now);
  if (setpoint == nullptr) {  // somebody else has the inputs: no promise of this loop
    setpoint_.resize(0);
    return;
  }
  const bool promises = !inCharge();
  const Vector& asked = setpoint->present();
  const double change = changeTo(asked);
  deviation_ = (now.outputs - asked).cwiseAbs2();
  squares_.setZero();
  if (next) squares_ = trial_->parts().error().cwiseAbs2();
  errors_.add(squares_, change, promises);
  outputs_.add(deviation_, change, promises);
  setpoint_ = asked;
}

bool WatchedLaw::runCandidate(const Measurement& now, const SetpointSource& setpoint,
                              ControllerOutput& output) {
  output.begin();
  try {
    if (fresh_) candidate_.law->reset(now);
    fresh_ = false;
    candidate_.law->step(now, setpoint, output);
  } catch (const std::exception&) {
    fresh_ = true;
    return false;
  }
  return output.ok && output.input.size() == now.input_applied.size() && output.input.allFinite();
}

/// The input of the candidate is looked at, and not sent.
void WatchedLaw::shadow(const Measurement& now, const SetpointSource& setpoint, const Vector& law) {
  observe(now, &setpoint);
  if (!runCandidate(now, setpoint, beside_)) {
    state_ = CandidateState::kRefused;
    return say(EventCode::kCandidateRefused,
               "candidate " + candidate_.name + " is refused: it gave no input");
  }
  if (law.size() == beside_.input.size()) trial_->compare(law, beside_.input, now.input_applied);
  decide();
}

void WatchedLaw::decide() {
  if (!trial_->judgeIfDue()) return;
  const CandidateFigures& figures = trial_->figures();
  const bool passed = state_ == CandidateState::kPassed;  // it may still turn out to be wrong
  if (passed && figures.result != TrialResult::kWrong) return;
  if (figures.result == TrialResult::kRight) {
    state_ = CandidateState::kPassed;
    say(EventCode::kCandidatePassed,
        "candidate " + candidate_.name + " has passed: " + textOf(figures));
    if (candidate_.params.automatic) handOver();
  } else if (figures.result == TrialResult::kWrong) {
    state_ = CandidateState::kRefused;
    say(EventCode::kCandidateRefused,
        "candidate " + candidate_.name + " is refused: " + textOf(figures));
  } else if (trial_->windowEnded()) {
    say(EventCode::kCandidateOpen,
        "candidate " + candidate_.name + " is not known well enough: " + textOf(figures));
  }
}

std::string WatchedLaw::brokenPromise() const {
  const auto words = [&](const ErrorPromise& promise, Eigen::Index i, const char* what) {
    return what + plant_.outputs[static_cast<std::size_t>(i)].name + " are " +
           shortText(std::sqrt(promise.seen(i))) + ", at most " +
           shortText(std::sqrt(promise.promised(i))) + " were promised";
  };
  if (const Eigen::Index i = errors_.broken(); i >= 0)
    return words(errors_, i, "errors of its predictions of ");
  if (const Eigen::Index i = outputs_.broken(); i >= 0)
    return words(outputs_, i, "errors of output ");
  return "";
}

bool WatchedLaw::throws(const Measurement& now, VectorRef wish) {
  bool swings = false;
  for (Eigen::Index i = 0; i < wish.size(); ++i) {
    const double range = limits_.upper[i] - limits_.lower[i];
    if (!std::isfinite(range) || range <= 0.0) continue;
    OscillationDetector& swing = swings_[static_cast<std::size_t>(i)];
    swings = swing.add((wish[i] - now.input_applied[i]) / range) || swings;
  }
  return swings;
}

/// beside_ is the former law's.
void WatchedLaw::drive(const Measurement& now, const SetpointSource& setpoint,
                       ControllerOutput& output) {
  observe(now, &setpoint);
  beside_.begin();
  inside_->step(now, setpoint, beside_);
  std::string why = brokenPromise();
  if (!runCandidate(now, setpoint, output))
    why = "it gave no input";
  else if (why.empty() && throws(now, output.input))
    why = "it throws an input from end to end";
  if (!why.empty()) {
    goBack(why);
    output = beside_;
    return;
  }
  if (++in_level_ > candidate_.params.step_samples &&
      level_ + 1 < candidate_.params.authority.size()) {
    ++level_;
    in_level_ = 1;
    say(EventCode::kHandOver, "candidate " + candidate_.name + " has " +
                                  authorityText(authority()) + " of the allowed moves");
  }
  mix(now, output);
}

void WatchedLaw::mix(const Measurement& now, ControllerOutput& output) {
  const bool former =
      beside_.ok && beside_.input.size() == output.input.size() && beside_.input.allFinite();
  const Vector& origin = former ? beside_.input : now.input_applied;
  if (!optimizer_) {
    if (std::exchange(taking_, false)) {
      into_.begin(origin);
      into_.finish(output.input);
    } else if (into_.active()) {
      into_.apply(now.input_applied, output.input);
    }
    into_.fade();
  }
  const double share = authority();
  if (share >= 1.0) return;
  if (output.predictive && output.prediction.input_lower.size() != origin.size()) {
    output.prediction.input_lower = limits_.lower;
    output.prediction.input_upper = limits_.upper;
  }
  for (Eigen::Index i = 0; i < output.input.size(); ++i) {
    const double range = limits_.upper[i] - limits_.lower[i];
    const double most = share * std::min(limits_.move[i], range);
    const double lower = std::max(limits_.lower[i], origin[i] - most);
    const double upper = std::min(limits_.upper[i], origin[i] + most);
    const double allowed = std::max(lower, std::min(output.input[i], upper));
    if (allowed != output.input[i]) output.source = ActionSource::kGuarded;
    output.input[i] = allowed;
    if (!output.predictive) continue;
    double& low = output.prediction.input_lower[i];
    double& high = output.prediction.input_upper[i];
    low = std::min(std::max(low, lower), upper);
    high = std::max(std::min(high, upper), low);
  }
  if (!candidate_.law->mayBeSent(output.input)) output.input = origin;
}

void WatchedLaw::step(const Measurement& now, const SetpointSource& setpoint,
                      ControllerOutput& output) {
  if (inCharge()) {
    drive(now, setpoint, output);
  } else {
    inside_->step(now, setpoint, output);
    if (onTrial()) shadow(now, setpoint, output.input);
  }
  if (!inCharge() && !optimizer_ && output.ok && output.input.size() == now.input_applied.size())
    backward_.bridge(now.input_applied, output.input);
  speak(output);
  refreshSignals();
}

void WatchedLaw::say(EventCode code, const std::string& text) { due_.emplace_back(code, text); }

/// Texts live until others are said.
void WatchedLaw::speak(ControllerOutput& output) {
  if (due_.empty()) return;
  said_.swap(due_);
  due_.clear();
  for (const auto& [code, text] : said_) output.events.add({code, text.c_str()});
}

std::string WatchedLaw::report() const {
  OrderedJson json;
  json["candidate"] = candidate_.name;
  json["state"] = nameOf(state_);
  json["authority"] = authority();
  json["samples"] = trial_ ? static_cast<long>(trial_->samples()) : 0L;
  const bool judged = trial_ && trial_->figures().model.samples > 0;
  if (trial_)
    json["figures"] = OrderedJson::parse(jsonOf(judged ? trial_->figures() : trial_->judge()));
  return json.dump();
}

void WatchedLaw::refreshSignals() {
  const auto& inner = inside_->signals();
  const std::size_t n = inner.size(), n_u = plant_.inputs.size();
  if (signals_.size() != n + n_u + 1) {
    signals_ = inner;
    for (const SignalInfo& input : plant_.inputs)
      signals_.emplace_back("beside_" + input.name, kNaN);
    signals_.emplace_back("candidate_authority", 0.0);
  }
  for (std::size_t i = 0; i < n; ++i) signals_[i].second = inner[i].second;
  const bool fits =
      (onTrial() || inCharge()) && static_cast<std::size_t>(beside_.input.size()) == n_u;
  for (std::size_t i = 0; i < n_u; ++i)
    signals_[n + i].second = fits ? beside_.input[static_cast<Eigen::Index>(i)] : kNaN;
  signals_.back().second = authority();
}

}  // namespace fpc
